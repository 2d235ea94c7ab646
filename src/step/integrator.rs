//! Interface between a step and its integrator.

use crate::contact::VertexEdge;
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;
use crate::state::{Model, State, Workspace};

use super::{Step, StepReport};

/// Parts of a step that the explicit and the implicit integrator do each in its own way.
pub(super) trait Integrator: Sync {
    /// Sizes buffers that the other has no use for, under the fixities that hold.
    fn prepare(&self, _model: &Model, _workspace: &mut Workspace) {}

    /// Leaves the stage before `stage` at rest where its velocities are no motion.
    fn stop(&self, _model: &Model, _state: &mut State, _stage: u32) {}

    /// How many times lighter blocks are in static stages as rigid bodies.
    fn lightness(&self, model: &Model) -> f64;

    /// Advances by `dt` (s), by sub-steps where it must; returns the report of the start when one is wanted.
    fn cover(&self, step: &mut Step, dt: f64) -> StepReport;

    /// Goes as far into a step of `dt` (s) as the report of its start needs; the state is then of no further use.
    fn begin(&self, step: &mut Step, dt: f64) -> StepReport;

    /// Goes as far into a step of `dt` (s) as its contacts need.
    fn find_contacts(&self, step: &mut Step, dt: f64);

    /// Shows the contacts of a step of `dt` (s); the near pairs are then of no further use.
    fn each_contact(&self, step: &mut Step, dt: f64, see: &mut dyn FnMut(&VertexEdge));

    /// Kinetic energy (J/m) of all blocks that can move, by its own masses.
    fn kinetic(&self, model: &Model, mass_matrix: &MassMatrix, displacement: &[Vector], velocity: &[Vector]) -> f64;
}
