//! The implicit integrator: Newmark's rule, a global stiffness matrix and open–close iteration with refactorisation,
//! on the same covers, contacts and histories as the explicit one of the engine.
//!
//! A crate of its own, so that hosts of the engine that only step explicitly do not compile its linear algebra. It
//! works on the rooms of the engine that are hidden from its documentation.
#![forbid(unsafe_code)]

mod assembly;
mod balance;
mod buffers;
mod choices;
mod commit;
mod consistent;
mod cover_matrix;
mod interval;
mod motion;
mod open_close;
mod step;

use std::any::Any;

use enmm::internals::cover::Covers;
use enmm::internals::mechanics::Elasticity;
use enmm::internals::state::Workspace;
use enmm::internals::step::Integrator;
use enmm::model::case::{self, Case, Invalid};
use enmm::model::{BuildStage, Integrators, Simulation};

pub use buffers::ImplicitBuffers;
pub use choices::{Implicit, Rule};
pub use cover_matrix::CoverMatrix;

/// The explicit integrator and the implicit one, as a case names them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Both;

impl Integrators for Both {
    fn refusal(&self, case: &Case) -> Option<Invalid> {
        (case.solver.integrator == case::Integrator::Implicit).then(|| choices::refusal(case)).flatten()
    }

    fn other(
        &self,
        case: &Case,
        covers: &Covers,
        rocks: &[Elasticity],
        element_rock: &[u16],
    ) -> Option<Box<dyn Integrator>> {
        let asked = case.solver.integrator == case::Integrator::Implicit;
        asked.then(|| Box::new(Implicit::new(case, covers, rocks, element_rock)) as _)
    }
}

/// The buffers of the implicit integrator that a workspace keeps; none where another integrates.
pub fn buffers(workspace: &Workspace) -> Option<&ImplicitBuffers> {
    let kept: &dyn Any = workspace.of_integrator.as_deref()?;
    kept.downcast_ref()
}

/// As [`Simulation::new`], by either integrator.
///
/// # Errors
/// As [`Simulation::new`].
pub fn simulation(case: Case) -> Result<Simulation, Invalid> {
    build(case, &mut |_| ())
}

/// As [`Simulation::build`], by either integrator.
///
/// # Errors
/// As [`Simulation::new`].
pub fn build(case: Case, tell: &mut dyn FnMut(BuildStage)) -> Result<Simulation, Invalid> {
    Simulation::with_integrators(case, &Both, tell)
}
