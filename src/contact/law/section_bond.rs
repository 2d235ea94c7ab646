//! Bonds of a section: springs that have no strength of their own until the section breaks (theory §7).

use super::softening::{Damaged, strengths};

/// The bond of a contact on a section in a step: forces per metre of depth.
///
/// It is elastic up to a plateau, which falls after the section has broken; what it then no longer stores is energy of
/// fracture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionBond {
    /// Springs normal and shear (N/m per metre).
    pub stiffness: [f64; 2],
    /// Tensile force (N/m) of the law over its length.
    pub tension: f64,
    /// tan φ and cohesive force (N/m), peak and residual.
    pub shear: [[f64; 2]; 2],
    /// Shares of tension and of shear beyond the residual one that it may carry; infinite while the section holds.
    pub share: [f64; 2],
}

impl SectionBond {
    /// Tensile force (N/m) that no opening exceeds.
    fn plateau(&self) -> f64 {
        self.share[0] * self.tension
    }

    /// Normal force (N/m, compression positive) after a step that would close the joint by `b` (m) without it, of which
    /// a unit of force takes `c` (m²/N).
    pub fn normal(&self, b: f64, c: f64) -> f64 {
        let force = self.stiffness[0] * b / (1.0 + c * self.stiffness[0]);
        force.max(-self.plateau())
    }

    /// Greatest shear force (N/m) under a normal force (N/m).
    pub fn shear_limit(&self, normal: f64) -> f64 {
        let [peak, residual] = strengths(self.shear, normal);
        if self.share[1].is_infinite() { f64::INFINITY } else { residual + self.share[1] * (peak - residual) }
    }

    /// Energy (J/m) stored in the normal spring at an opening (m); less than zero where it is closed.
    pub fn stored(&self, opening: f64) -> f64 {
        let elastic = self.plateau() / self.stiffness[0];
        if opening <= elastic {
            return 0.5 * self.stiffness[0] * opening * opening;
        }
        self.plateau() * (opening - 0.5 * elastic)
    }

    /// Width (m) of the crack at an opening (m): what the spring does not explain.
    pub fn crack(&self, opening: f64) -> f64 {
        (opening - self.plateau() / self.stiffness[0]).max(0.0)
    }

    /// Energy (J/m) that a slip (m) takes beyond the heat of residual friction, under forces (N/m) normal and shear.
    pub fn slip_loss(&self, slipped: f64, [normal, shear]: [f64; 2]) -> Damaged {
        let residual = strengths(self.shear, normal)[1];
        let of_slip = (shear.abs() - residual).max(0.0) * slipped.abs();
        Damaged { damage: 0.0, loss: of_slip, of_slip }
    }

    /// Shares of its tension and of its shear beyond the residual one that forces (N/m) normal and shear are.
    pub fn used(&self, [normal, shear]: [f64; 2]) -> [f64; 2] {
        let [peak, residual] = strengths(self.shear, normal);
        let of = |force: f64, strength: f64| if force > 0.0 && strength > 0.0 { force / strength } else { 0.0 };
        [of(-normal, self.tension), of(shear.abs() - residual, peak - residual)]
    }
}
