//! Numerical choices of a case.

use crate::keys::shared::{LENGTH, SHARE, STEP};
use crate::keys::unit::{BYTE, NUMBER, SECOND};
use crate::keys::{Range, Rule, keys, words};

words! {
    /// Time integration.
    #[derive(Default)]
    pub enum Integrator {
        /// Lumped mass, leapfrog, open–close iteration.
        #[default]
        Explicit = "explicit",
        /// Global stiffness, Newmark's rule, open–close iteration with refactorisation: the classical method.
        Implicit = "implicit",
    }

    /// What becomes of corner contacts: corners of blocks that meet, in a point or over a short length, a side which
    /// rises in front of them.
    pub enum CornerContacts {
        /// They carry force.
        Hold = "hold",
        /// They carry none where it would be more than the rock over their length bears.
        Break = "break",
    }

    /// Newmark's rule of the implicit integrator.
    #[derive(Default)]
    pub enum Newmark {
        /// β = ½, γ = 1: constant acceleration as in discontinuous deformation analysis; damps fast motion.
        #[default]
        Constant = "constant",
        /// β = ¼, γ = ½: trapezoidal rule; keeps energy. For vibrations of whole rock: sliding blocks come out short by
        /// some percent (0.7 % and 5.3 % were measured).
        Trapezoidal = "trapezoidal",
    }
}

/// Counts of sweeps.
const COUNT: Rule = Range::from(1.0).to(1000.0).of(NUMBER);

keys! {
    /// Numerical choices; the defaults are those of `docs/theory.md`.
    pub default struct Solver {
        /// Time integration.
        pub integrator: Integrator,
        /// Communication step (s); the internal step is an integer fraction of its tenth. Default: ten internal steps
        /// of the stability limit rounded down to two digits.
        pub communication_step: Option<f64> => STEP.hint("leave it out for the default"),
        /// Largest internal step (s); default: the stability limit.
        pub dt_max: Option<f64> => STEP.hint("leave it out for the stability limit"),
        /// Share of the stability limit that is used.
        pub dt_safety: f64 = 0.9 => SHARE,
        /// Default stiffness of joints: normal_stiffness = this·(λ+2μ) over 1 m.
        pub contact_stiffness: f64 = 0.6 => Range::above(0.0).to(1e6).of(NUMBER),
        /// Shear over normal contact stiffness.
        pub shear_ratio: f64 = 0.5 => Range::above(0.0).to(10.0).of(NUMBER),
        /// θ of the contact spring at the default step: 1 is backward Euler, more adds a dashpot, which a shorter
        /// step keeps.
        pub contact_theta: f64 = 4.0 => Range::from(1.0).to(1e6).of(NUMBER),
        /// Change of a contact force, relative to the largest, below which the open–close iteration has settled.
        pub contact_tolerance: f64 = 0.01 => SHARE,
        /// Dynamic stages: time (s) by which friction follows the normal force of faces that stay in touch, so that
        /// blocks slide as far on any mesh; 0 is Coulomb friction at once. Default: a shear wave's way through the
        /// blocks that hang together, or 0.02 s if that is less.
        pub friction_delay: Option<f64> =>
            Range::from(0.0).to(1.0).of(SECOND)
                .hint("leave it out for the default, a shear wave's way through the blocks"),
        /// Factor of safety: whether corner contacts hold or break; default: both are tried where they carry the slope,
        /// and the lower factor is the result.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub corner_contacts: Option<CornerContacts>,
        /// Most sweeps of the open–close iteration in a step.
        pub sweeps_max: u32 = 100 => COUNT,
        /// Penetration, relative to the mesh size, at which the run stops as failed.
        pub penetration_limit: f64 = 0.2 => SHARE,
        /// Static stages: how many times lighter than their rock free blocks are as rigid bodies, so that they settle
        /// in fewer steps; weights, and so the state of rest, stay those of the rock, but joints may slip by another
        /// path.
        pub mass_scaling: f64 = 1.0 => Range::from(1.0).to(100.0).of(NUMBER),
        /// Implicit: Newmark's rule.
        pub newmark: Newmark,
        /// Implicit: internal step (s); default: 20 times the explicit one. It is an integer fraction of the
        /// communication step's tenth as well.
        pub implicit_step: Option<f64> => STEP.hint("leave it out for 20 explicit steps"),
        /// Implicit: most open–close iterations in a step before it is cut to 0.3.
        pub iterations_max: u32 = 8 => COUNT,
        /// Implicit: largest displacement in a step, relative to half the height of the model, before it is cut.
        pub displacement_ratio: f64 = 0.01 => SHARE,
        /// Displacement (m) beyond which a block counts as failed; default: the mesh size.
        pub failure_displacement: Option<f64> => LENGTH.hint("leave it out for the mesh size"),
        /// Memory (bytes) that a model may need.
        pub memory_limit: u64 = 8 << 30 =>
            Range::from(1.0).to(u64::MAX as f64).of(BYTE).hint("8589934592 (8 GiB) is the default"),
    }
}
