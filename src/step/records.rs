//! Records in a step: the motion of the base, and waves through quiet boundaries.

use crate::geometry::Vector;
use crate::state::{BaseMotion, Model, MotionKind, State, TimedRecord};

use super::{Regime, Window};

impl TimedRecord {
    /// Mean of the record over a window by `mean`, times amplitude; zero before its stage and in static stages.
    fn over(&self, regime: Regime, state: &State, window: Window, mean: impl Fn(f64, f64) -> f64) -> Vector {
        match (regime, state.stage_starts.get(self.stage as usize)) {
            (Regime::Dynamic { .. }, Some(start)) => self.amplitude * mean(window.from - start, window.to - start),
            _ => Vector::zeros(),
        }
    }
}

/// Acceleration (m/s²) of the base by its records, its mean over a window (Eq. 45).
pub fn base_motion(model: &Model, regime: Regime, state: &State, window: Window) -> Vector {
    let of = |base: &BaseMotion| {
        let TimedRecord { record, .. } = &base.motion;
        base.motion.over(regime, state, window, |from, to| match base.kind {
            MotionKind::Acceleration => record.mean(from, to),
            MotionKind::Velocity => record.mean_rate(from, to),
        })
    };
    model.base_motions.iter().map(of).sum()
}

/// Particle velocity (m/s) of the wave that comes in through a quiet boundary, its mean over a window: that of its
/// record and that of a host.
pub fn wave(model: &Model, regime: Regime, state: &State, window: Window, quiet: u32) -> Vector {
    let quiet = &model.quiets[quiet as usize];
    let of_case = quiet.wave.as_ref().map(|w| w.over(regime, state, window, |a, b| w.record.mean(a, b)));
    let is_dynamic = matches!(regime, Regime::Dynamic { .. });
    let of_host = quiet.port.filter(|_| is_dynamic);
    let of_host = of_host.map(|port| state.drive.mean_velocity(port as usize, window.from, window.to));
    of_case.unwrap_or_default() + of_host.unwrap_or_default()
}

/// Velocity (m/s) with which the supports of a fixity move in a sub-step of `dt` (s) from `time` (s) on.
pub fn fixity_velocity(model: &Model, regime: Regime, state: &State, [time, dt]: [f64; 2], fix: u32) -> Vector {
    let fixity = &model.fixities[fix as usize];
    if matches!(regime, Regime::Static { .. }) {
        return Vector::zeros();
    }
    let of_host = |port: u32| state.drive.velocity(port as usize, state.drive.share(time + 0.5 * dt));
    fixity.velocity + fixity.port.map_or_else(Vector::zeros, of_host)
}
