//! Buffers of the implicit integrator.

use enmm::geometry::Vector;
use enmm::internals::contact::ContactState;
use enmm::internals::cover::CoverId;
use enmm::internals::state::Buffers;

use super::cover_matrix::CoverMatrix;

/// Buffers of the implicit integrator.
#[derive(Debug, Clone, Default)]
pub struct ImplicitBuffers {
    /// System matrix of the step.
    pub matrix: CoverMatrix,
    /// Positions in the matrix.
    pub slots: Slots,
    /// Rows of the matrix that are held.
    pub held: Vec<bool>,
    /// Whether any row is held.
    pub any_held: bool,
    /// Displacements since the start of the sub-step (m).
    pub moved: Vec<Vector>,
    /// Mass times this, plus `c` times what has moved, is the inertial force (m/s²).
    pub offset: Vec<Vector>,
    /// Forces on covers of loads and gravity at the end of the sub-step (N/m).
    pub applied: Vec<Vector>,
    /// Internal forces on covers at the positions reached (N/m).
    pub internal: Vec<Vector>,
    /// Forces at the start of the sub-step.
    pub start: StartForces,
    /// Forces out of balance (N/m).
    pub residual: Vec<Vector>,
    /// Any cover field.
    pub field: Vec<Vector>,
    /// Right-hand side, then the solution.
    pub unknowns: Vec<f64>,
    /// Normal force (N/m) of each contact that friction is measured by along a solution.
    pub pressing: Vec<f64>,
    /// Whether contacts that slip keep the secant of their shear spring in the factor.
    pub cautious: bool,
    /// State of each contact that the factor holds.
    pub factored: Vec<ContactState>,
}

/// Positions in the matrix of the pairs of covers of elements and contacts.
#[derive(Debug, Clone, Default)]
pub struct Slots {
    /// Those of each element.
    pub elements: Vec<[u32; 6]>,
    /// Those of each contact.
    pub contacts: Vec<[u32; 36]>,
    /// Pairs of covers of the pattern, while it is built.
    pub pairs: Vec<[CoverId; 2]>,
}

/// Forces (N/m) at the start of a sub-step.
#[derive(Debug, Clone, Default)]
pub struct StartForces {
    /// Loads and gravity on covers; filled for the trapezoidal rule.
    pub applied: Vec<Vector>,
    /// Internal forces on covers.
    pub internal: Vec<Vector>,
    /// Normal and shear force of each contact.
    pub contacts: Vec<[f64; 2]>,
    /// Force of each support.
    pub supports: Vec<f64>,
}

impl Buffers for ImplicitBuffers {
    fn copy(&self) -> Box<dyn Buffers> {
        Box::new(self.clone())
    }

    fn bytes(&self) -> usize {
        let Self { moved, offset, applied, internal, start, residual, field, .. } = self;
        let fields = [moved, offset, applied, &start.applied, internal, &start.internal, residual, field];
        fields.map(|field| size_of_val(&**field)).iter().sum::<usize>()
            + size_of_val(&*self.unknowns)
            + size_of_val(&*self.held)
    }
}
