//! A sub-step, found once for all its stages: how long covers move, and how long and when forces act.

use crate::state::State;

use super::Regime;

/// Results that are wanted of the start of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Wanted {
    /// Nothing.
    #[default]
    Nothing,
    /// Results of the forces of the step alone: the unbalanced ratio, and the energy stored in contacts,
    /// supports and bolts.
    Forces,
    /// The whole report.
    Report,
}

/// Simulated time that an integrator is asked to cover.
#[derive(Debug, Clone, Copy)]
pub struct StepInterval {
    /// How the stage treats velocities and gravity.
    pub regime: Regime,
    /// Start (s).
    pub time: f64,
    /// Length (s).
    pub dt: f64,
    /// Results that are wanted of the start.
    pub wanted: Wanted,
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
    /// Results that are wanted of the start.
    pub wanted: Wanted,
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
    pub fn new(StepInterval { regime, time, dt, wanted }: StepInterval, before: f64, serial: bool) -> Self {
        let window = Window { from: time - 0.5 * before, to: time + 0.5 * dt };
        Self { regime, time, dt, kick: 0.5 * (before + dt), window, wanted, serial }
    }

    /// Share of gravity and of inputs that acts at its start.
    pub fn ramp(&self, state: &State) -> f64 {
        super::ramp(self.regime, self.time - state.stage_start)
    }
}
