//! Joint laws: stiffness and strength of a joint.

mod barton_bandis;

pub use barton_bandis::{Closure, Roughness};

/// A joint: Mohr–Coulomb with tension cut-off, peak and residual strength and dilation (Eqs. 20, 21), or, with a
/// roughness, Barton–Bandis (Eq. 33).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct JointLaw {
    /// Normal stiffness (Pa/m).
    pub normal_stiffness: f64,
    /// Shear stiffness (Pa/m).
    pub shear_stiffness: f64,
    /// Whether normal and shear stiffness are the solver's own and no property of the joint.
    pub penalty: [bool; 2],
    /// tan φ, peak.
    pub friction: f64,
    /// Cohesion (Pa), peak.
    pub cohesion: f64,
    /// Tensile strength (Pa), peak.
    pub tension: f64,
    /// tan φ after failure.
    pub residual_friction: f64,
    /// Cohesion after failure (Pa).
    pub residual_cohesion: f64,
    /// Tensile strength after failure (Pa).
    pub residual_tension: f64,
    /// tan ψ.
    pub dilation: f64,
    /// Slip (m) at which dilation ends.
    pub dilation_slip: f64,
    /// Greatest closure (m); infinite for a linear normal stiffness.
    pub closure_max: f64,
    /// Roughness of a Barton–Bandis joint; its `friction` is tan φr, and it has neither cohesion nor tension.
    pub roughness: Option<Roughness>,
}

/// Forces (N/m) that a contact of some length can carry.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Limits {
    /// tan φ.
    pub friction: f64,
    /// Cohesive shear force (N/m).
    pub cohesion: f64,
    /// Tensile force (N/m).
    pub tension: f64,
    /// What a Barton–Bandis joint has instead of friction and cohesion.
    pub rough: Option<RoughLimit>,
}

/// Shear strength of a Barton–Bandis joint of some length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoughLimit {
    /// Roughness.
    pub roughness: Roughness,
    /// Tributary length (m), which turns the normal force into a stress.
    pub length: f64,
    /// Factor on the shear strength.
    pub factor: f64,
}

impl RoughLimit {
    /// Greatest shear force (N/m) under a normal force (N/m).
    fn shear(&self, normal: f64) -> f64 {
        if normal <= 0.0 { 0.0 } else { normal * self.roughness.friction(normal / self.length) * self.factor }
    }
}

impl Limits {
    /// Greatest shear force (N/m) under a normal force (N/m, compression positive).
    #[inline(always)]
    pub fn shear(&self, normal: f64) -> f64 {
        match &self.rough {
            None => (normal * self.friction + self.cohesion).max(0.0),
            Some(rough) => rough.shear(normal),
        }
    }

    /// Limits of joints whose strength is multiplied by `factor`.
    #[inline(always)]
    pub fn times(self, factor: f64) -> Self {
        Self {
            friction: self.friction * factor,
            cohesion: self.cohesion * factor,
            tension: self.tension * factor,
            rough: self.rough.map(|rough| RoughLimit { factor: rough.factor * factor, ..rough }),
        }
    }
}

impl JointLaw {
    /// Limits of a contact of tributary length `length` (m), peak while `intact`.
    #[inline(always)]
    pub fn limits(&self, length: f64, intact: bool) -> Limits {
        let [friction, cohesion, tension] = if intact {
            [self.friction, self.cohesion, self.tension]
        } else {
            [self.residual_friction, self.residual_cohesion, self.residual_tension]
        };
        let rough = self.roughness.map(|roughness| RoughLimit { roughness, length, factor: 1.0 });
        Limits { friction, cohesion: cohesion * length, tension: tension * length, rough }
    }

    /// Normal and shear spring (N/m per metre) of a contact of tributary `length` (m); the solver's own stiffness
    /// acts over `penalty_length` (m).
    #[inline(always)]
    pub fn stiffness(&self, length: f64, penalty_length: f64) -> [f64; 2] {
        let over = |penalty: bool| if penalty { penalty_length } else { length };
        [self.normal_stiffness * over(self.penalty[0]), self.shear_stiffness * over(self.penalty[1])]
    }

    /// Opening (m) by dilation between two values of accumulated slip (m).
    #[inline(always)]
    pub fn dilate(&self, from: f64, to: f64) -> f64 {
        (to.min(self.dilation_slip) - from.min(self.dilation_slip)) * self.dilation
    }
}
