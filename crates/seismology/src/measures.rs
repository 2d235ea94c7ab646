//! Peaks, Arias intensity and significant duration.

use std::f64::consts::PI;

use crate::accelerogram::{Accelerogram, Motion, Piece};

/// Shares of the Arias intensity between which the significant duration lies.
const SIGNIFICANT: [f64; 2] = [0.05, 0.95];
/// Halvings by which a time in a piece is found.
const HALVINGS: usize = 60;

/// Measures of a ground motion.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Measures {
    /// Peak ground acceleration, PGA (m/s²).
    pub acceleration: f64,
    /// Peak ground velocity, PGV (m/s), from rest at the first point.
    pub velocity: f64,
    /// Peak ground displacement, PGD (m), from the place at the first point.
    pub displacement: f64,
    /// Arias intensity π/(2g) ∫ a² dt (m/s).
    pub arias: f64,
    /// Significant duration D5–95 (s): from 5 to 95 % of the Arias intensity.
    pub duration: f64,
}

impl Accelerogram {
    /// Its measures where gravity is `gravity` (m/s²).
    pub fn measures(&self, gravity: f64) -> Measures {
        let mut peaks = Measures::default();
        let mut motion = Motion::default();
        peaks.acceleration = self.points().iter().map(|point| point[1].abs()).fold(0.0, f64::max);
        for piece in self.pieces() {
            let end = piece.moved(motion, piece.length);
            let turn = piece.turn().map(|since| piece.moved(motion, since).velocity);
            peaks.velocity = turn.into_iter().chain([end.velocity]).fold(peaks.velocity, larger);
            let stops = piece.stops(motion).map(|since| piece.moved(motion, since).displacement);
            peaks.displacement = stops.chain([end.displacement]).fold(peaks.displacement, larger);
            motion = end;
        }
        let sum: f64 = self.pieces().map(|piece| squares(&piece, piece.length)).sum();
        let [from, to] = SIGNIFICANT.map(|share| self.time_of(share * sum));
        Measures { arias: 0.5 * PI / gravity * sum, duration: to - from, ..peaks }
    }

    /// Time (s) at which the integral of the squares reaches a sum (m²/s³).
    fn time_of(&self, sum: f64) -> f64 {
        let mut before = 0.0;
        for piece in self.pieces() {
            let own = squares(&piece, piece.length);
            if own > 0.0 && before + own >= sum {
                return piece.start + since(&piece, sum - before);
            }
            before += own;
        }
        self.points().last().map_or(0.0, |point| point[0])
    }
}

fn larger(most: f64, value: f64) -> f64 {
    most.max(value.abs())
}

/// Integral of the squares (m²/s³) over the first `since` (s) of a piece.
fn squares(piece: &Piece, since: f64) -> f64 {
    let Piece { first, rate, .. } = *piece;
    since * (first * first + since * rate * (first + rate * since / 3.0))
}

/// Time (s) in a piece after which its squares have a sum.
fn since(piece: &Piece, sum: f64) -> f64 {
    let [mut low, mut high] = [0.0, piece.length];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if squares(piece, middle) < sum { low = middle } else { high = middle }
    }
    high
}
