//! Joint laws: stiffness and strength of a joint, as pure functions of force, length and slip (theory §7).

mod barton_bandis;

pub use barton_bandis::{Closure, Roughness};

use crate::geometry::id;

id! {
    /// A joint law.
    LawId: plain
}

/// A joint: Mohr–Coulomb with tension cut-off, peak and residual strength and dilation (Eqs. 20, 21), or, with a
/// roughness, Barton–Bandis (Eq. 33).
#[doc(alias = "Mohr-Coulomb")]
#[doc(alias = "Coulomb friction")]
#[doc(alias = "interface law")]
#[doc(alias = "fracture")]
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
#[doc(alias = "friction cone")]
#[doc(alias = "yield criterion")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limits {
    /// Friction on a straight line.
    MohrCoulomb {
        /// tan φ.
        friction: f64,
        /// Cohesive shear force (N/m).
        cohesion: f64,
        /// Tensile force (N/m).
        tension: f64,
    },
    /// Friction on a curve, without cohesion and tension.
    BartonBandis {
        /// Roughness.
        roughness: Roughness,
        /// Factor on the shear strength.
        factor: f64,
    },
}

impl Default for Limits {
    fn default() -> Self {
        Self::MohrCoulomb { friction: 0.0, cohesion: 0.0, tension: 0.0 }
    }
}

impl Limits {
    /// Greatest shear force (N/m) of a contact of tributary `length` (m) under a normal force (N/m, compression
    /// positive).
    #[inline(always)]
    pub fn shear(self, normal: f64, length: f64) -> f64 {
        match self {
            Self::MohrCoulomb { friction, cohesion, .. } => (normal * friction + cohesion).max(0.0),
            Self::BartonBandis { .. } if normal <= 0.0 => 0.0,
            Self::BartonBandis { roughness, factor } => normal * roughness.friction(normal / length) * factor,
        }
    }

    /// Whether shear strength is nonlinear in the normal force, so that each sweep evaluates it.
    #[inline(always)]
    pub fn is_curved(&self) -> bool {
        match self {
            Self::MohrCoulomb { .. } => false,
            Self::BartonBandis { .. } => true,
        }
    }

    /// Greatest tensile force (N/m).
    #[inline(always)]
    pub fn tension(&self) -> f64 {
        match self {
            Self::MohrCoulomb { tension, .. } => *tension,
            Self::BartonBandis { .. } => 0.0,
        }
    }

    /// Limits of joints whose strength is multiplied by `by`.
    #[inline(always)]
    pub fn times(self, by: f64) -> Self {
        match self {
            Self::MohrCoulomb { friction, cohesion, tension } => {
                Self::MohrCoulomb { friction: friction * by, cohesion: cohesion * by, tension: tension * by }
            }
            Self::BartonBandis { roughness, factor } => Self::BartonBandis { roughness, factor: factor * by },
        }
    }
}

impl JointLaw {
    /// Limits of a contact whose faces lie along each other over a `length` (m), peak while `intact`.
    #[inline(always)]
    pub fn limits(&self, length: f64, intact: bool) -> Limits {
        if let Some(roughness) = self.roughness {
            return Limits::BartonBandis { roughness, factor: 1.0 };
        }
        let [friction, cohesion, tension] = if intact {
            [self.friction, self.cohesion, self.tension]
        } else {
            [self.residual_friction, self.residual_cohesion, self.residual_tension]
        };
        Limits::MohrCoulomb { friction, cohesion: cohesion * length, tension: tension * length }
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
