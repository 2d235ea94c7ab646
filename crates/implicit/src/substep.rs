//! A sub-step, and how inertia enters it.

use enmm::step::Step;

use super::buffers::ImplicitBuffers;

/// Factor on a sub-step that has not settled.
pub const CUT: f64 = 0.3;

/// A sub-step in progress: the step of the engine, and the buffers of this integrator.
pub struct Substep<'a, 's> {
    /// The step.
    pub step: &'a mut Step<'s>,
    /// The buffers.
    pub buffers: &'a mut ImplicitBuffers,
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
