//! A sub-step, and how inertia enters it.

use enmm::internals::state::{Model, State, Workspace};
use enmm::internals::step::{Regime, StepInterval, Substep, Wanted};

use super::buffers::ImplicitBuffers;

/// Factor on a sub-step that has not settled.
pub const CUT: f64 = 0.3;

/// A sub-step in progress.
pub struct ImplicitStep<'a> {
    /// The model.
    pub model: &'a Model,
    /// The state, which the step changes.
    pub state: &'a mut State,
    /// The buffers of the engine.
    pub workspace: &'a mut Workspace,
    /// The buffers of this integrator.
    pub buffers: &'a mut ImplicitBuffers,
    /// How the stage treats velocities and gravity.
    pub regime: Regime,
    /// Simulated time (s).
    pub time: f64,
    /// Whether a report of the start is wanted.
    pub report: bool,
    /// Whether the matrix was not positive definite however short the sub-step.
    pub singular: bool,
}

impl ImplicitStep<'_> {
    /// The sub-step of `dt` (s) that begins now, as the stages of the engine know it.
    pub fn substep(&self, dt: f64) -> Substep {
        let Self { regime, time, report, .. } = *self;
        let wanted = if report { Wanted::Report } else { Wanted::Nothing };
        Substep::new(StepInterval { regime, time, dt, wanted }, self.state.dt_last, self.workspace.serial)
    }
}

/// How inertia enters a sub-step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia<'a> {
    /// Consistent mass of each element.
    pub element_mass: &'a [[f64; 6]],
    /// Length (s).
    pub dt: f64,
    /// Acceleration over displacement (1/s²): 1/(β·dt²).
    pub factor: f64,
    /// Share of the forces at the end in the mean that works.
    pub end: f64,
    /// Whether the sub-step starts from rest.
    pub rests: bool,
}
