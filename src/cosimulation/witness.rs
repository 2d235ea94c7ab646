//! Those who see how a model moves, as a recorder of its results does.

use std::any::Any;
use std::fmt::Debug;

use crate::model::Simulation;
use crate::step::{StepError, StepReport};

/// Sees the steps of a model that a host drives, and can change nothing of them.
pub trait Witness: Any + Debug + Send + Sync {
    /// A communication step begins where the model stands.
    fn communication_step_begins(&mut self, simulation: &Simulation);

    /// An internal step begins at a point of the grid; returns whether its report is wanted.
    fn step_begins(&mut self, simulation: &Simulation) -> bool;

    /// An internal step with a report is over.
    fn step_ends(&mut self, simulation: &Simulation, report: &StepReport);

    /// A stage is over that another follows, with the report of its last step where that had one.
    fn stage_ends(&mut self, simulation: &Simulation, last: Option<&StepReport>);

    /// A stage begins.
    fn stage_begins(&mut self, simulation: &Simulation);

    /// The model has gone back, or forth, to a saved state.
    fn returns(&mut self, simulation: &Simulation);

    /// A communication step has failed; the model has gone back to its start before.
    fn fails(&mut self, error: &StepError);
}

/// The witness of a model. A copy of the model has none.
#[derive(Debug, Default)]
pub(super) struct Attendance(pub(super) Option<Box<dyn Witness>>);

impl Clone for Attendance {
    fn clone(&self) -> Self {
        Self(None)
    }
}
