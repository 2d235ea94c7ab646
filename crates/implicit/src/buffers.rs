//! Buffers of the implicit integrator.

use enmm::contact::ContactState;
use enmm::cover::CoverId;
use enmm::geometry::Vector;
use enmm::state::Buffers;

use super::cover_matrix::CoverMatrix;

/// Buffers of the implicit integrator.
#[derive(Debug, Clone, Default)]
pub struct ImplicitBuffers {
    /// System matrix of the step.
    pub matrix: CoverMatrix,
    /// Positions in the matrix of each element's pairs of covers.
    pub element_slots: Vec<[u32; 6]>,
    /// Positions in the matrix of each contact's pairs of covers.
    pub contact_slots: Vec<[u32; 36]>,
    /// Rows of the matrix that are held.
    pub held: Vec<bool>,
    /// Whether any row is held.
    pub any_held: bool,
    /// Pairs of covers of the pattern, while it is built.
    pub pairs: Vec<[CoverId; 2]>,
    /// Displacements since the start of the sub-step (m).
    pub moved: Vec<Vector>,
    /// Mass times this, plus `c` times what has moved, is the inertial force (m/s²).
    pub offset: Vec<Vector>,
    /// Forces on covers of loads and gravity at the end of the sub-step (N/m).
    pub applied: Vec<Vector>,
    /// The same at its start; filled for the trapezoidal rule.
    pub applied_before: Vec<Vector>,
    /// Internal forces on covers at the positions reached (N/m).
    pub internal: Vec<Vector>,
    /// Internal forces at the start of the sub-step (N/m).
    pub internal_before: Vec<Vector>,
    /// Forces out of balance (N/m).
    pub residual: Vec<Vector>,
    /// Any cover field.
    pub field: Vec<Vector>,
    /// Right-hand side, then the solution.
    pub unknowns: Vec<f64>,
    /// Forces (N/m) of contacts, normal and shear, at the start of the sub-step.
    pub forces_before: Vec<[f64; 2]>,
    /// Forces (N/m) of supports at the start of the sub-step.
    pub bearing_before: Vec<f64>,
    /// Normal force (N/m) of each contact that friction is measured by along a solution.
    pub pressing: Vec<f64>,
    /// Whether contacts that slip keep the secant of their shear spring in the factor.
    pub cautious: bool,
    /// State of each contact that the factor holds.
    pub factored: Vec<ContactState>,
}

impl Buffers for ImplicitBuffers {
    fn copy(&self) -> Box<dyn Buffers> {
        Box::new(self.clone())
    }

    fn bytes(&self) -> usize {
        let Self { moved, offset, applied, applied_before, internal, internal_before, residual, field, .. } = self;
        let fields = [moved, offset, applied, applied_before, internal, internal_before, residual, field];
        fields.map(|field| size_of_val(&**field)).iter().sum::<usize>()
            + size_of_val(&*self.unknowns)
            + size_of_val(&*self.held)
    }
}
