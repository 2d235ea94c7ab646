//! Data of the implicit integrator: its options and masses (fixed), and its buffers.

use crate::contact::ContactState;
use crate::cover::CoverId;
use crate::geometry::Vector;
use crate::mechanics::CoverMatrix;

/// Newmark's rule: velocities and positions from the accelerations at both ends of a step (Eq. 67).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// β = ½, γ = 1: the acceleration of the end holds throughout; damps fast motion.
    Constant,
    /// β = ¼, γ = ½: the mean of both; keeps energy.
    Trapezoidal,
}

/// Choices and masses of the implicit integrator.
#[derive(Debug, Clone, PartialEq)]
pub struct Implicit {
    /// Newmark's rule.
    pub rule: Rule,
    /// Most open–close iterations before a sub-step is cut.
    pub iterations_max: u32,
    /// Largest displacement (m) in a sub-step.
    pub displacement_max: f64,
    /// ∫ρ w_a w_b (kg/m) of each element for the pairs of its covers (Eq. 68).
    pub element_mass: Vec<[f64; 6]>,
}

/// Buffers of the implicit integrator.
#[derive(Debug, Clone, Default)]
pub struct ImplicitWorkspace {
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
