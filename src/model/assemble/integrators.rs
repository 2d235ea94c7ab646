//! The integrators that a build may choose from.

use std::fmt::Debug;

use crate::cover::Covers;
use crate::mechanics::Elasticity;
use crate::model::case::{Case, Integrator as Name, Invalid};
use crate::step::Integrator;

/// The integrators that are there, from which a case names one.
pub trait Integrators: Debug + Sync {
    /// Why the case cannot be integrated as it asks; none where it can.
    fn refusal(&self, case: &Case) -> Option<Invalid>;

    /// The integrator that the case names, over these elements; none for the explicit one.
    fn other(
        &self,
        case: &Case,
        covers: &Covers,
        rocks: &[Elasticity],
        element_rock: &[u16],
    ) -> Option<Box<dyn Integrator>>;
}

/// The explicit integrator, the only one that the engine itself has.
#[derive(Debug, Clone, Copy, Default)]
pub struct ExplicitAlone;

impl Integrators for ExplicitAlone {
    fn refusal(&self, case: &Case) -> Option<Invalid> {
        (case.solver.integrator != Name::Explicit).then(|| Invalid {
            key: "solver.integrator".into(),
            message: "is \"implicit\", which this library does not have: use \"explicit\", or run the case by the \
                      program enmm"
                .into(),
        })
    }

    fn other(&self, _: &Case, _: &Covers, _: &[Elasticity], _: &[u16]) -> Option<Box<dyn Integrator>> {
        None
    }
}
