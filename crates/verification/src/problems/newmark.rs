//! A rigid block on a plane whose base moves, after Newmark: its slip by fine integration.

/// Block, plane and base.
pub struct Sliding<F: Fn(f64) -> f64> {
    /// Acceleration of gravity (m/s²).
    pub gravity: f64,
    /// Dip of the plane (rad).
    pub dip: f64,
    /// Friction coefficient.
    pub friction: f64,
    /// Acceleration of the block (m/s²) relative to the base at time t (s), horizontal, that the base's own causes:
    /// minus that of the base; positive drives down the plane.
    pub push: F,
}

/// Slip (m) and its rate (m/s) at a time (s).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Slip {
    pub time: f64,
    pub way: f64,
    pub speed: f64,
}

impl<F: Fn(f64) -> f64> Sliding<F> {
    /// Driving acceleration down the plane and resistance (m/s²) at time `t` (s).
    fn both(&self, t: f64) -> (f64, f64) {
        let (sin, cos) = self.dip.sin_cos();
        let push = (self.push)(t);
        (self.gravity * sin + push * cos, self.friction * (self.gravity * cos - push * sin).max(0.0))
    }

    /// Acceleration (m/s²) while it slides downwards (+1) or upwards (−1).
    fn acceleration(&self, t: f64, sense: f64) -> f64 {
        let (drive, resistance) = self.both(t);
        drive - sense * resistance
    }

    /// Slip from rest at time 0, in steps of `dt` (s) to `end` (s).
    ///
    /// While the block slides in one sense its acceleration depends on time alone: Simpson's rule for speed and way. It
    /// stops where the speed passes zero, and starts where drive passes resistance, both found by bisection.
    pub fn slip(&self, dt: f64, end: f64) -> Vec<Slip> {
        let (mut at, mut sense) = (Slip::default(), 0.0f64);
        let mut path = vec![at];
        for k in 0..(end / dt).round() as u64 {
            let next = (k + 1) as f64 * dt;
            for _ in 0..8 {
                if at.time >= next {
                    break;
                }
                (at, sense) = if sense == 0.0 { self.stick(at, next) } else { self.slide(at, sense, next) };
            }
            path.push(Slip { time: next, ..at });
            at.time = next;
        }
        path
    }

    /// Waits until drive passes resistance, at most to `next` (s); returns the sense in which it slides then.
    fn stick(&self, at: Slip, next: f64) -> (Slip, f64) {
        let excess = |t: f64| {
            let (drive, resistance) = self.both(t);
            drive.abs() - resistance
        };
        if excess(next) <= 0.0 {
            return (Slip { time: next, speed: 0.0, ..at }, 0.0);
        }
        let start = if excess(at.time) > 0.0 { at.time } else { bisect(at.time, next, |t| excess(t) > 0.0) };
        let sense = self.both(next).0.signum();
        (Slip { time: start, speed: 0.0, ..at }, sense)
    }

    /// Slides to `next` (s) or to where it stops.
    fn slide(&self, at: Slip, sense: f64, next: f64) -> (Slip, f64) {
        let there = self.moved(at, sense, next);
        if there.speed * sense >= 0.0 {
            return (there, sense);
        }
        let stop = bisect(at.time, next, |t| self.moved(at, sense, t).speed * sense < 0.0);
        (Slip { speed: 0.0, ..self.moved(at, sense, stop) }, 0.0)
    }

    /// Speed and way after sliding in one sense to time `t` (s).
    fn moved(&self, at: Slip, sense: f64, t: f64) -> Slip {
        let h = t - at.time;
        let [a, b, c] = [0.0, 0.5, 1.0].map(|share| self.acceleration(at.time + share * h, sense));
        let speed = at.speed + h * (a + 4.0 * b + c) / 6.0;
        Slip { time: t, way: at.way + h * at.speed + h * h * (a + 2.0 * b) / 6.0, speed }
    }
}

/// The time between `low`, where `passed` is false, and `high`, where it is true, at which it changes.
fn bisect(mut low: f64, mut high: f64, passed: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if passed(middle) { high = middle } else { low = middle }
    }
    high
}

/// The way at a time of a path that was found with steps of `dt` (s).
pub fn way_at(path: &[Slip], dt: f64, t: f64) -> f64 {
    path[((t / dt).round() as usize).min(path.len() - 1)].way
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    const G: f64 = 9.81;
    const DT: f64 = 1e-4;

    fn sine(dip: f64, friction: f64, peak: f64, frequency: f64) -> Sliding<impl Fn(f64) -> f64> {
        let push = move |t: f64| peak * G * (2.0 * PI * frequency * t).sin();
        Sliding { gravity: G, dip: dip.to_radians(), friction, push }
    }

    /// a = 20°, φ = 30°, a0 = 0.5 g, f = 2 Hz: starts at 0.028680 s, 0.0784049 m per cycle, 0.392025 m in five.
    #[test]
    fn the_first_published_sine() {
        let path = sine(20.0, 30f64.to_radians().tan(), 0.5, 2.0).slip(DT, 2.5);
        let start = path.iter().find(|s| s.way > 0.0).unwrap().time;
        assert!((start - 0.028680).abs() < 2.0 * DT, "{start}");
        assert!((way_at(&path, DT, 0.5) - 0.0784049).abs() < 1e-7, "{}", way_at(&path, DT, 0.5));
        assert!((way_at(&path, DT, 2.5) - 0.392025).abs() < 1e-6);
    }

    /// a = 22.6°, φ = 30°, a0 = 0.28 g, f = 2.66 Hz: 0.0165603 m per cycle, 0.082801 m in five.
    #[test]
    fn the_second_published_sine() {
        let path = sine(22.6, 30f64.to_radians().tan(), 0.28, 2.66).slip(DT, 5.0 / 2.66);
        assert!((way_at(&path, DT, 5.0 / 2.66) - 0.082801).abs() < 1e-6, "{:?}", path.last());
    }

    /// Flat, μ = 0.3, a0 = 0.5 g, f = 1 Hz: first slip 0.0979514 m, net 0.007708 m after 1 s and 2 s.
    #[test]
    fn the_flat_sine_that_slips_both_ways() {
        let path = sine(0.0, 0.3, 0.5, 1.0).slip(DT, 2.0);
        let first = path.iter().map(|s| s.way).fold(0.0, f64::max);
        assert!((first - 0.0979514).abs() < 1e-6, "{first}");
        for t in [1.0, 2.0] {
            assert!((way_at(&path, DT, t) - 0.007708).abs() < 2e-6, "{}", way_at(&path, DT, t));
        }
    }
}
