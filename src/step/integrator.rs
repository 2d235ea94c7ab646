//! The interface between a step and its integrator.

use crate::contact::VertexEdge;
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;
use crate::state::{Model, State, Workspace};

use super::{StepInterval, StepReport};

/// The part of a step that each integrator does in its own way.
pub trait Integrator: Send + Sync {
    /// Sizes buffers that the other has no use for, under the fixities that hold.
    fn prepare(&self, _model: &Model, _workspace: &mut Workspace) {}

    /// Leaves the stage before `stage` at rest where its velocities are no motion.
    fn stop(&self, _model: &Model, _state: &mut State, _stage: u32) {}

    /// How many times lighter blocks are in static stages as rigid bodies.
    fn lightness(&self, model: &Model) -> f64;

    /// Covers an interval, by sub-steps where it must.
    fn cover(&self, model: &Model, state: &mut State, workspace: &mut Workspace, interval: StepInterval)
    -> StepOutcome;

    /// Goes as far into an interval as the report of its start needs; the state is then of no further use.
    fn begin(&self, model: &Model, state: &mut State, workspace: &mut Workspace, interval: StepInterval) -> StepReport {
        self.cover(model, state, workspace, interval).report
    }

    /// Goes as far into an interval as its contacts need.
    fn find_contacts(&self, model: &Model, state: &mut State, workspace: &mut Workspace, interval: StepInterval);

    /// Shows the contacts of an interval; the near pairs are then of no further use.
    fn each_contact(
        &self,
        model: &Model,
        state: &mut State,
        workspace: &mut Workspace,
        interval: StepInterval,
        see: &mut dyn FnMut(&VertexEdge),
    );

    /// Kinetic energy (J/m) of all blocks that can move, by its own masses.
    fn kinetic(&self, model: &Model, mass_matrix: &MassMatrix, displacement: &[Vector], velocity: &[Vector]) -> f64;
}

/// How an integrator has covered an interval.
#[derive(Debug, Clone, Copy)]
pub struct StepOutcome {
    /// The start of the interval, when a report is wanted.
    pub report: StepReport,
    /// Simulated time (s) at its end.
    pub end: f64,
    /// Whether all speeds were found finite and below the limit; if not, they are looked at one by one.
    pub is_sound: bool,
    /// Whether the matrix of an implicit step was not positive definite however short the sub-step.
    pub is_singular: bool,
}
