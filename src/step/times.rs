//! The times of a sub-step, found once: how long covers move, and how long and when forces act.

use super::Step;

/// Times of a sub-step.
#[derive(Debug, Clone, Copy)]
pub struct StepTimes {
    /// Length of the sub-step (s), for which covers move.
    pub dt: f64,
    /// Time (s) for which its forces act: the mean of this sub-step and the one before (Eq. 10).
    pub kick: f64,
    /// When they act.
    pub window: Window,
}

/// Simulated times (s) between which forces act.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    /// Start.
    pub from: f64,
    /// End.
    pub to: f64,
}

impl Step<'_> {
    /// Times of the sub-step of `dt` (s) that begins now.
    pub fn times(&self, dt: f64) -> StepTimes {
        let (time, before) = (self.time, self.state.dt_last);
        let window = Window { from: time - 0.5 * before, to: time + 0.5 * dt };
        StepTimes { dt, kick: 0.5 * (before + dt), window }
    }
}
