//! A sub-step, found once for all its stages: how long covers move, and how long and when forces act.

use crate::state::State;

use super::Regime;

/// Simulated time that an integrator is asked to cover.
#[derive(Debug, Clone, Copy)]
pub struct StepInterval {
    /// How the stage treats velocities and gravity.
    pub regime: Regime,
    /// Start (s).
    pub time: f64,
    /// Length (s).
    pub dt: f64,
    /// Whether a report of the start is wanted.
    pub report: bool,
}

/// A sub-step: what its stages know of it.
#[derive(Debug, Clone, Copy)]
pub struct Substep {
    /// How the stage treats velocities and gravity.
    pub regime: Regime,
    /// Start (s).
    pub time: f64,
    /// Length (s), for which covers move.
    pub dt: f64,
    /// Time (s) for which its forces act: the mean of this sub-step and the one before (Eq. 10).
    pub kick: f64,
    /// When they act.
    pub window: Window,
    /// Whether a report of the start is wanted.
    pub report: bool,
    /// Whether it keeps to the calling thread; the bits are the same.
    pub serial: bool,
}

/// Simulated times (s) between which forces act.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    /// Start.
    pub from: f64,
    /// End.
    pub to: f64,
}

impl Substep {
    /// The sub-step over a whole interval, after one of `before` (s).
    pub fn new(StepInterval { regime, time, dt, report }: StepInterval, before: f64, serial: bool) -> Self {
        let window = Window { from: time - 0.5 * before, to: time + 0.5 * dt };
        Self { regime, time, dt, kick: 0.5 * (before + dt), window, report, serial }
    }

    /// Share of gravity and of inputs that acts at its start.
    pub fn ramp(&self, state: &State) -> f64 {
        super::ramp(self.regime, self.time - state.stage_start)
    }
}
