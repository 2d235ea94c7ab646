//! Joint laws: stiffness and strength of a joint, as pure functions of force, length and slip (theory §7).

mod barton_bandis;
mod dilation;
mod section_bond;
mod softening;

pub use barton_bandis::{Closure, Roughness};
pub use dilation::{LiftLoad, Lifted};
pub use section_bond::SectionBond;
pub use softening::{Bond, Damaged, Softening};

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
    /// Slip (m) from the middle to either side at which dilation ends.
    pub dilation_slip: f64,
    /// Greatest closure (m); infinite for a linear normal stiffness.
    pub closure_max: f64,
    /// Strength (Pa) of the rock that contacts crush beyond; infinite for rock that does not crush.
    pub crush: f64,
    /// Roughness of a Barton–Bandis joint; its `friction` is tan φr, and it has neither cohesion nor tension.
    pub roughness: Option<Roughness>,
    /// How the peak strength is lost, if not at once.
    pub softening: Option<Softening>,
}

impl JointLaw {
    /// Gives it another friction angle (rad), peak and residual.
    pub fn set_friction(&mut self, angle: f64) {
        self.friction = libm::tan(angle);
        self.residual_friction = self.friction;
        if let Some(roughness) = &mut self.roughness {
            roughness.angle = angle;
        }
    }

    /// Gives it another cohesion (Pa), peak and residual.
    pub fn set_cohesion(&mut self, cohesion: f64) {
        (self.cohesion, self.residual_cohesion) = (cohesion, cohesion);
    }
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
        /// Cohesive shear force (N/m), with what friction still feels of the pressure before this step (Eq. 84).
        cohesion: f64,
        /// Tensile force (N/m).
        tension: f64,
        /// Shear force (N/m) that friction still feels where the contact is open now.
        felt: f64,
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
        Self::MohrCoulomb { friction: 0.0, cohesion: 0.0, tension: 0.0, felt: 0.0 }
    }
}

/// Greatest shear force (N/m) on a line of friction and cohesion (N/m), under a normal force (N/m, compression
/// positive).
#[inline(always)]
pub(super) fn shear_on([friction, cohesion]: [f64; 2], normal: f64) -> f64 {
    (normal * friction + cohesion).max(0.0)
}

impl Limits {
    /// Those of bonds whose section decides what they carry.
    pub const UNLIMITED: Self =
        Self::MohrCoulomb { friction: 0.0, cohesion: f64::INFINITY, tension: f64::INFINITY, felt: 0.0 };

    /// Greatest shear force (N/m) of a contact of tributary `length` (m) under a normal force (N/m, compression
    /// positive).
    #[inline(always)]
    pub fn shear(self, normal: f64, length: f64) -> f64 {
        shear_on(self.line(normal, length), normal)
    }

    /// Friction, and the shear force (N/m) beside it, under a normal force (N/m) over a length (m).
    #[inline(always)]
    pub fn line(self, normal: f64, length: f64) -> [f64; 2] {
        match self {
            Self::MohrCoulomb { friction, cohesion, .. } => [friction, cohesion],
            Self::BartonBandis { .. } if normal <= 0.0 => [0.0; 2],
            Self::BartonBandis { roughness, factor } => [roughness.friction(normal / length) * factor, 0.0],
        }
    }

    /// Greatest shear force (N/m) of a contact that is open, where its spring would pull with `normal` (N/m, negative):
    /// cohesion fades with that pull, so that it does not jump, and friction still feels a hop.
    #[inline(always)]
    pub fn shear_open(&self, normal: f64) -> f64 {
        if let Self::MohrCoulomb { felt, cohesion, .. } = self { felt.max(cohesion + normal) } else { 0.0 }
    }

    /// Limits where the mean normal stress (Pa) of its faces rules the friction of a rough joint.
    pub fn under(self, mean_stress: f64) -> Self {
        let Self::BartonBandis { roughness, factor } = self else { return self };
        let friction = roughness.friction(mean_stress) * factor;
        Self::MohrCoulomb { friction, cohesion: 0.0, tension: 0.0, felt: 0.0 }
    }

    /// Limits of friction that feels a `share` of the normal force of this step, and the rest from the normal force
    /// `felt` (N/m) before it (Eq. 84).
    pub fn delayed(self, share: f64, felt: f64) -> Self {
        let Self::MohrCoulomb { friction, cohesion, tension, .. } = self else { return self };
        let felt = (1.0 - share) * felt * friction;
        let (friction, cohesion) = (share * friction, cohesion + felt);
        Self::MohrCoulomb { friction, cohesion, tension, felt: felt.max(0.0) }
    }

    /// Whether shear strength is nonlinear in the normal force, so that each sweep evaluates it.
    #[inline(always)]
    pub fn is_curved(&self) -> bool {
        matches!(self, Self::BartonBandis { .. })
    }

    /// Greatest tensile force (N/m).
    #[inline(always)]
    pub fn tension(&self) -> f64 {
        if let Self::MohrCoulomb { tension, .. } = self { *tension } else { 0.0 }
    }

    /// Limits of joints whose strength is multiplied by `by`.
    #[inline(always)]
    pub fn times(self, by: f64) -> Self {
        match self {
            Self::MohrCoulomb { friction, cohesion, tension, felt } => {
                let [friction, cohesion, tension, felt] = [friction, cohesion, tension, felt].map(|part| part * by);
                Self::MohrCoulomb { friction, cohesion, tension, felt }
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
        Limits::MohrCoulomb { friction, cohesion: cohesion * length, tension: tension * length, felt: 0.0 }
    }

    /// Whether no cohesion is lost when it fails.
    pub fn keeps_cohesion(&self) -> bool {
        self.residual_cohesion >= self.cohesion
    }

    /// Whether it has a strength that it loses for good when it breaks, and gains none by that.
    pub fn breaks(&self) -> bool {
        let loses = self.tension > 0.0 || !self.keeps_cohesion() || self.friction > self.residual_friction;
        let gains = self.residual_cohesion > self.cohesion || self.residual_friction > self.friction;
        self.roughness.is_none() && self.residual_tension == 0.0 && loses && !gains
    }

    /// This law on a `share` of the length of a contact, and the friction of another one on the rest.
    pub fn beside(self, other: &Self, share: f64) -> Self {
        let mean = |own: f64, other: f64| share * own + (1.0 - share) * other;
        Self {
            friction: mean(self.friction, other.friction),
            residual_friction: mean(self.residual_friction, other.residual_friction),
            ..self
        }
    }

    /// The bond of a contact whose faces lie along each other over a `length` (m), with springs (N/m per metre), damage
    /// and slip (m) so far, where the strength of all joints is multiplied by a factor; none of joints that do not
    /// soften.
    pub fn bond(&self, stiffness: [f64; 2], length: f64, strength: f64, [damage, slip]: [f64; 2]) -> Option<Bond> {
        let softening = self.softening?;
        let scale = length * strength;
        Some(Bond {
            stiffness,
            tension: self.tension * scale,
            opening: softening.opening,
            shear_energy: softening.shear_energy * scale,
            shear: self.shear_lines(length, strength),
            damage,
            slip,
        })
    }

    /// As [`Self::bond`], of a contact on a section that lets its bonds carry some shares.
    pub fn section_bond(&self, stiffness: [f64; 2], length: f64, strength: f64, share: [f64; 2]) -> SectionBond {
        let tension = self.tension * (length * strength);
        SectionBond { stiffness, tension, shear: self.shear_lines(length, strength), share }
    }

    /// tan φ and cohesive force (N/m) over a length (m), peak and residual, times a factor on the strength.
    fn shear_lines(&self, length: f64, strength: f64) -> [[f64; 2]; 2] {
        let scale = length * strength;
        [
            [self.friction * strength, self.cohesion * scale],
            [self.residual_friction * strength, self.residual_cohesion * scale],
        ]
    }

    /// Normal and shear spring (N/m per metre) of a contact of tributary `length` (m); the solver's own stiffness
    /// acts over `penalty_length` (m).
    #[inline(always)]
    pub fn stiffness(&self, length: f64, penalty_length: f64) -> [f64; 2] {
        let over = |penalty: bool| if penalty { penalty_length } else { length };
        [self.normal_stiffness * over(self.penalty[0]), self.shear_stiffness * over(self.penalty[1])]
    }
}
