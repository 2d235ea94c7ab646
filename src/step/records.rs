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

/// Particle velocity (m/s) of the wave that comes in through a quiet boundary, its mean over a window.
pub fn wave(model: &Model, regime: Regime, state: &State, window: Window, quiet: u32) -> Vector {
    let wave = &model.quiets[quiet as usize].wave;
    wave.as_ref().map_or_else(Vector::zeros, |w| w.over(regime, state, window, |a, b| w.record.mean(a, b)))
}
