//! The response spectrum: largest displacement of damped oscillators on the ground.

use std::f64::consts::PI;

use crate::accelerogram::{Accelerogram, Motion, Piece};

/// Damping ratio of the usual spectrum.
pub const DAMPING: f64 = 0.05;
/// Shortest and longest period (s) of a spectrum.
const PERIODS: [f64; 2] = [0.02, 10.0];
/// Periods of a decade.
const OF_DECADE: f64 = 40.0;
/// Least number of steps of a response in a period, so that its velocity passes through 0 once in a step at most.
const STEPS: f64 = 20.0;
/// Halvings by which a peak between two steps is found.
const HALVINGS: usize = 30;

/// Periods (s) of a spectrum: 40 in each decade from 0.02 to 10 s, but for those below `least`.
pub fn periods(least: f64) -> Vec<f64> {
    let [first, last] = PERIODS;
    let count = (OF_DECADE * libm::log10(last / first)).round();
    let all = (0..=count as u32).map(|k| first * libm::pow(last / first, f64::from(k) / count));
    all.filter(|period| *period >= least).collect()
}

impl Accelerogram {
    /// Pseudo-acceleration ω² max |u| (m/s²) of an oscillator of each period (s), above 0, with a damping ratio from 0
    /// to below 1, at rest before the motion and followed for a period beyond it.
    ///
    /// The response is exact (Nigam and Jennings, 1969), in steps of a twentieth of the period or less, and so are
    /// peaks between their ends.
    pub fn spectrum(&self, periods: &[f64], damping: f64) -> Vec<f64> {
        periods.iter().map(|period| self.response(2.0 * PI / period, damping)).collect()
    }

    fn response(&self, omega: f64, damping: f64) -> f64 {
        let period = 2.0 * PI / omega;
        let [last, _] = self.points()[self.points().len() - 1];
        let rest = Piece { start: last, length: period, first: 0.0, rate: 0.0 };
        let mut oscillator = Oscillator { omega, damping, ..Oscillator::default() };
        for piece in self.pieces().chain([rest]) {
            let steps = (STEPS * piece.length / period).ceil().max(1.0);
            let length = piece.length / steps;
            for k in 0..steps as u64 {
                oscillator.advance(piece.at(k as f64 * length), piece.rate, length);
            }
        }
        omega * omega * oscillator.most
    }
}

/// An oscillator on the ground: u″ + 2ξω u′ + ω² u = −a.
#[derive(Debug, Clone, Copy, Default)]
struct Oscillator {
    omega: f64,
    damping: f64,
    motion: Motion,
    /// Largest displacement (m) so far.
    most: f64,
    /// Its free motion over the last step.
    free: Free,
}

/// Decay, cosine and sine of the free motion of an oscillator over a step (s).
#[derive(Debug, Clone, Copy, Default)]
struct Free {
    step: f64,
    decay: f64,
    cos: f64,
    sin: f64,
}

impl Oscillator {
    /// Goes a step (s) under an acceleration that begins with `first` (m/s²) and changes at a rate (m/s³).
    fn advance(&mut self, first: f64, rate: f64, step: f64) {
        if step != self.free.step {
            self.free = self.free_motion(step);
        }
        let before = self.motion;
        let end = self.moved(first, rate, &self.free);
        self.most = self.most.max(end.displacement.abs());
        let fastest = before.velocity.abs().max(end.velocity.abs());
        let farthest = before.displacement.abs().max(end.displacement.abs()) + step * fastest;
        if before.velocity * end.velocity < 0.0 && farthest > self.most {
            let [mut low, mut high] = [0.0, step];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                let there = self.moved(first, rate, &self.free_motion(middle));
                self.most = self.most.max(there.displacement.abs());
                if there.velocity * before.velocity > 0.0 { low = middle } else { high = middle }
            }
        }
        self.motion = end;
    }

    fn free_motion(&self, step: f64) -> Free {
        let own = self.own();
        let decay = libm::exp(-self.damping * self.omega * step);
        Free { step, decay, cos: libm::cos(own * step), sin: libm::sin(own * step) }
    }

    /// Angular frequency (rad/s) of its free motion.
    fn own(&self) -> f64 {
        self.omega * (1.0 - self.damping * self.damping).sqrt()
    }

    /// Motion after a step, of which the free part is known: that which follows the acceleration, and the free one.
    fn moved(&self, first: f64, rate: f64, free: &Free) -> Motion {
        let Self { omega, damping, motion, .. } = *self;
        let Free { step, decay, cos, sin } = *free;
        let (own, stiffness) = (self.own(), omega * omega);
        let follows = |since: f64| (2.0 * damping * rate / omega - first - rate * since) / stiffness;
        let drift = -rate / stiffness;
        let a = motion.displacement - follows(0.0);
        let b = (motion.velocity - drift + damping * omega * a) / own;
        let swing = decay * (a * cos + b * sin);
        Motion {
            displacement: follows(step) + swing,
            velocity: drift - damping * omega * swing + decay * own * (b * cos - a * sin),
        }
    }
}
