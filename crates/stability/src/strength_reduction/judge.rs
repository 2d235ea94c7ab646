//! Whether a slope is stable at a reduced strength, from its motion alone.

use super::setting::Geometry;

/// Whether the slope is stable at the strength of a trial.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Verdict {
    /// Motion has died; where rock yields, elasticity explains how far it went.
    Stable,
    /// Motion has died or is dying, but rock flowed farther than that: it is caught, not held.
    Caught,
    /// It fails.
    #[default]
    Unstable,
}

impl Verdict {
    /// `stable`, `caught` or `unstable`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Caught => "caught",
            Self::Unstable => "unstable",
        }
    }
}

/// Reason of a verdict.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Reason {
    /// Speeds, energy and growth of displacements have died.
    #[default]
    Rest,
    /// A block is beyond the limit displacement, and the kinetic energy grows.
    Runaway,
    /// Speed grows in a straight line, beyond what the rock's elasticity can give way.
    Acceleration,
    /// Time was over: the growth of displacements decided.
    Trend,
    /// It rested, and a nudge made it fail.
    Nudge,
}

impl Reason {
    /// A word for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rest => "rest",
            Self::Runaway => "runaway",
            Self::Acceleration => "acceleration",
            Self::Trend => "trend",
            Self::Nudge => "nudge",
        }
    }
}

/// The motion at the end of a window of a trial.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sample {
    /// Time since the trial began (s).
    pub time: f64,
    /// Largest displacement since then (m).
    pub displacement: f64,
    /// Largest slip of a contact since then (m); where rock yields, the largest displacement.
    pub slip: f64,
    /// Speed of the fastest block in the mean of the window (m/s): what swings about its place goes nowhere.
    pub speed: f64,
    /// Kinetic energy (J/m).
    pub kinetic: f64,
    /// Energy set free since the trial began (J/m).
    pub released: f64,
}

/// Scales against which a motion is measured (Eqs. 61–64).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Window between samples (s).
    pub window: f64,
    /// Time over which the strength falls (s).
    pub ramp: f64,
    /// Most simulated time (s).
    pub time_max: f64,
    /// Speed below which nothing moves (m/s).
    pub still_speed: f64,
    /// Kinetic energy of all rock at that speed (J/m).
    pub still_kinetic: f64,
    /// Displacement that elasticity cannot explain (m).
    pub elastic: f64,
    /// Displacement of a failed block (m).
    pub limit: f64,
    /// Whether what went farther than elasticity explains is caught, as rock that yields is: it may have flowed for
    /// ever on a finer mesh.
    pub catches: bool,
    /// Windows in a row in which the kinetic energy of a failed block's motion must grow.
    pub runs: usize,
}

impl Scales {
    /// Those of a motion in a geometry under a course of a `time` (s). Small displacements catch nothing: there a block
    /// far gone has failed when its energy has grown as long as a speed in a straight line must.
    pub fn of(&self, time: f64, geometry: Geometry) -> Self {
        let runs = if geometry == Geometry::Drawn { WINDOWS } else { 1 };
        Self { time_max: self.time_max - self.ramp + time, ramp: time, runs, ..*self }
    }
}

/// Windows through which the speed must grow in a straight line.
const WINDOWS: usize = 8;
/// Least coefficient of determination of that line.
const STRAIGHT: f64 = 0.98;
/// Windows of rest.
const REST_WINDOWS: usize = 3;
/// Kinetic energy, relative to the energy set free, of a motion that has died.
const DEAD_SHARE: f64 = 1e-4;
/// Growth of displacements in the last quarter of a trial, relative to the quarter before, of one that does not end.
const ENDLESS: f64 = 0.7;

/// Judges a trial by its samples so far (Eqs. 62–65); none while it is open.
pub fn judge(samples: &[Sample], scales: &Scales) -> Option<(Verdict, Reason)> {
    let last = samples.last()?;
    let is_far = last.slip > scales.elastic || last.displacement > scales.limit;
    let held = if scales.catches && is_far { Verdict::Caught } else { Verdict::Stable };
    if last.displacement > scales.limit && grows(samples, scales.runs) {
        return Some((Verdict::Unstable, Reason::Runaway));
    }
    let first = samples.partition_point(|s| s.time <= scales.ramp);
    let after = &samples[first..];
    if after.len() > REST_WINDOWS && rests(&after[after.len() - REST_WINDOWS - 1..], scales) {
        return Some((held, Reason::Rest));
    }
    if after.len() >= WINDOWS && accelerates(&after[after.len() - WINDOWS..], scales) {
        return Some((Verdict::Unstable, Reason::Acceleration));
    }
    (last.time >= scales.time_max).then(|| {
        let holds = last.displacement <= scales.elastic || ends(after, scales);
        (if holds { held } else { Verdict::Unstable }, Reason::Trend)
    })
}

/// Whether the kinetic energy has grown through as many windows as there are `runs`.
fn grows(samples: &[Sample], runs: usize) -> bool {
    let last = &samples[samples.len().saturating_sub(runs + 1)..];
    last.len() > runs && last.windows(2).all(|pair| pair[1].kinetic > pair[0].kinetic)
}

/// Slow, poor in energy and going nowhere, in each of the windows (Eq. 62).
fn rests(windows: &[Sample], scales: &Scales) -> bool {
    windows.windows(2).all(|pair| {
        let [before, now] = [pair[0], pair[1]];
        let grown = (now.displacement - before.displacement).abs();
        now.speed <= scales.still_speed
            && grown <= scales.still_speed * scales.window
            && now.kinetic <= scales.still_kinetic.max(DEAD_SHARE * now.released)
    })
}

/// Speed grows in a straight line, and has left behind what elasticity can explain (Eq. 64).
fn accelerates(windows: &[Sample], scales: &Scales) -> bool {
    let (slope, determination) = line(windows.iter().map(|s| (s.time, s.speed)));
    let grows = windows.windows(2).all(|pair| pair[1].displacement > pair[0].displacement);
    let last = windows[windows.len() - 1];
    grows && slope > 0.0 && determination >= STRAIGHT && last.displacement > scales.elastic
}

/// Whether growth of displacements falls off over the last half (Eq. 65).
fn ends(samples: &[Sample], scales: &Scales) -> bool {
    let n = samples.len();
    let position = |quarters: usize| samples[(n - 1) * quarters / 4].displacement;
    let [earlier, later] = [position(3) - position(2), position(4) - position(3)];
    later <= (ENDLESS * earlier).max(scales.still_speed * scales.window)
}

/// Slope of the least-squares line, and its coefficient of determination.
pub fn line(points: impl Iterator<Item = (f64, f64)> + Clone) -> (f64, f64) {
    let n = points.clone().count().max(1) as f64;
    let [x0, y0] = points.clone().fold([0.0; 2], |[x, y], p| [x + p.0 / n, y + p.1 / n]);
    let [xx, xy, yy] = points.fold([0.0; 3], |[xx, xy, yy], p| {
        let (x, y) = (p.0 - x0, p.1 - y0);
        [xx + x * x, xy + x * y, yy + y * y]
    });
    if xx <= 0.0 || yy <= 0.0 { (0.0, 0.0) } else { (xy / xx, xy * xy / (xx * yy)) }
}

/// Acceleration (m/s²) of the fastest block by the last speeds.
pub fn acceleration(samples: &[Sample]) -> f64 {
    line(samples[samples.len().saturating_sub(WINDOWS)..].iter().map(|s| (s.time, s.speed))).0
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALES: Scales = Scales {
        window: 0.1,
        ramp: 0.2,
        time_max: 10.0,
        still_speed: 1e-4,
        still_kinetic: 1e-5,
        elastic: 2e-3,
        limit: 0.5,
        catches: true,
        runs: 1,
    };

    /// Samples of a motion given as displacement and speed over time, until it is judged.
    fn fate(motion: impl Fn(f64) -> (f64, f64)) -> (Verdict, Reason, f64) {
        let mut samples = Vec::new();
        loop {
            let time = 0.1 * (samples.len() + 1) as f64;
            let (displacement, speed) = motion(time);
            let (slip, kinetic, released) = (displacement, 500.0 * speed * speed, displacement);
            samples.push(Sample { time, displacement, slip, speed, kinetic, released });
            if let Some((verdict, reason)) = judge(&samples, &SCALES) {
                return (verdict, reason, time);
            }
        }
    }

    /// ½at² with a = 5e-3 passes 2 mm at 0.9 s, eight windows after the ramp.
    #[test]
    fn constant_acceleration_is_a_failure_however_small() {
        let (verdict, reason, time) = fate(|t| (2.5e-3 * t * t, 5e-3 * t));
        assert_eq!((verdict, reason), (Verdict::Unstable, Reason::Acceleration));
        assert!(time < 1.2, "{time}");
    }

    #[test]
    fn a_motion_that_dies_is_stable_within_elasticity_and_caught_beyond() {
        for (far, wanted) in [(1e-3, Verdict::Stable), (0.1, Verdict::Caught)] {
            let (verdict, reason, _) = fate(|t| (far * (1.0 - (-3.0 * t).exp()), 3.0 * far * (-3.0 * t).exp()));
            assert_eq!((verdict, reason), (wanted, Reason::Rest), "{far} m");
        }
    }

    #[test]
    fn a_swing_is_no_failure() {
        let (verdict, ..) =
            fate(|t| (1e-2 * (1.0 - (8.0 * t).cos()) * (-t).exp(), 0.08 * (8.0 * t).sin().abs() * (-t).exp()));
        assert_eq!(verdict, Verdict::Stable);
    }

    #[test]
    fn steady_creep_fails_by_its_trend() {
        assert_eq!(fate(|t| (3e-3 * t, 3e-3)).0, Verdict::Unstable);
        assert_eq!(fate(|t| (3e-3 * t, 3e-3)).1, Reason::Trend);
    }

    /// 1 mm in ten seconds is less than what elasticity may give way.
    #[test]
    fn creep_within_elasticity_is_no_failure() {
        assert_eq!(fate(|t| (1e-4 * t, 2e-4)), (Verdict::Stable, Reason::Trend, 10.0));
    }

    #[test]
    fn a_block_that_is_far_gone_and_gains_energy_has_failed() {
        assert_eq!(fate(|t| (4.0 * t * t, 8.0 * t)).1, Reason::Runaway);
    }
}
