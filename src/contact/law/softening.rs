//! Bonds that soften: tensile strength and cohesion that fall with opening and slip, with the energy of fracture that
//! a law gives (theory §7).

use super::shear_on;

/// How the peak strength of a joint is lost. A mode without energy is lost at once.
#[doc(alias = "cohesive zone")]
#[doc(alias = "fracture energy")]
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Softening {
    /// Opening (m) of the crack at which no tensile strength is left: 2·G_I/σt.
    pub opening: f64,
    /// Energy of fracture in shear (J/m²), beyond the heat of residual friction.
    pub shear_energy: f64,
}

impl Softening {
    /// All strength is lost at once.
    pub const AT_ONCE: Self = Self { opening: 0.0, shear_energy: 0.0 };
}

/// The bond of a contact in a step: forces per metre of depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bond {
    /// Springs normal and shear (N/m per metre).
    pub stiffness: [f64; 2],
    /// Tensile force (N/m) of the sound bond.
    pub tension: f64,
    /// Opening (m) of the crack at which no tension is left.
    pub opening: f64,
    /// Energy of fracture in shear (J/m).
    pub shear_energy: f64,
    /// tan φ and cohesive force (N/m), peak and residual.
    pub shear: [[f64; 2]; 2],
    /// Share of the strength that is lost: 0 for a sound bond.
    pub damage: f64,
    /// Slip (m) so far.
    pub slip: f64,
}

/// Damage of a bond after a step, and the energy (J/m) that it took: of that in shear the spring of the contact knows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Damaged {
    /// Share of the strength that is lost.
    pub damage: f64,
    /// Energy of fracture (J/m).
    pub loss: f64,
    /// Part of it that slip gave.
    pub of_slip: f64,
}

impl Bond {
    /// Opening (m) at which the sound bond has its strength.
    fn elastic(&self) -> f64 {
        self.tension / self.stiffness[0]
    }

    /// Opening (m) up to which the bond follows its secant, at some damage.
    fn reached(&self, damage: f64) -> f64 {
        (1.0 - damage) * self.elastic() + damage * self.opening
    }

    /// Stiffness (N/m per metre) of the way back to the origin.
    fn secant(&self, damage: f64) -> f64 {
        self.tension * (1.0 - damage) / self.reached(damage)
    }

    /// Opening (m) from the peak of the force to its end; none where the spring alone gives back more than the bond
    /// takes, so that it breaks at its peak.
    pub fn range(&self) -> Option<f64> {
        let range = self.opening - self.elastic();
        (range > 0.0).then_some(range)
    }

    /// Damage at an opening (m) of the joint.
    pub fn damage_at(&self, opening: f64) -> f64 {
        if self.damage >= 1.0 || opening <= 0.0 || self.tension > 0.0 && opening <= self.reached(self.damage) {
            return self.damage;
        }
        self.range().map_or(1.0, |range| ((opening - self.elastic()) / range).clamp(self.damage, 1.0))
    }

    /// Normal force (N/m, compression positive) after a step that would close the joint by `b` (m; less than zero
    /// where it opens) without it, of which a unit of force takes `c` (m²/N).
    ///
    /// While the bond softens the force is the mean of those before and after the step, so that its work is the energy
    /// of fracture at any step (Eq. 22b).
    pub fn normal(&self, b: f64, c: f64) -> f64 {
        let pulled = |stiffness: f64| stiffness * b / (1.0 + c * stiffness);
        if b >= 0.0 {
            return pulled(self.stiffness[0]);
        }
        if self.tension <= 0.0 || self.damage >= 1.0 {
            return 0.0;
        }
        let reached = self.reached(self.damage);
        let force = pulled(self.secant(self.damage));
        if c * force - b <= reached {
            return force;
        }
        let Some(range) = self.range() else { return 0.0 };
        let slope = 0.5 * self.tension / range;
        if c * slope < 1.0 {
            let without = self.tension * (1.0 - 0.5 * self.damage) + slope * (b + self.elastic());
            let pull = without / (1.0 - c * slope);
            if c * -pull - b <= self.opening {
                return -pull;
            }
        }
        let left = 0.5 * self.tension * (1.0 - self.damage) * (self.opening - reached);
        -spent(left, -b - reached, c)
    }

    /// Shear force (N/m) at the peak and after failure, under a normal force (N/m).
    pub fn strengths(&self, normal: f64) -> [f64; 2] {
        strengths(self.shear, normal)
    }

    /// Slip (m) at which the shear strength under a normal force (N/m) is residual (Eq. 22c); 0 where it is lost at
    /// once.
    pub fn slip_at_end(&self, [peak, residual]: [f64; 2]) -> f64 {
        if peak > residual { 2.0 * self.shear_energy / (peak - residual) } else { 0.0 }
    }

    /// Greatest shear force (N/m) in a step that would have the force `asked` (N/m) without slip, of which a unit takes
    /// `1/ease` of slip (N/m²), and at whose end the opening has led to the damage `opened`: the mean of those before
    /// and after the step (Eq. 22b).
    pub fn shear(&self, normal: f64, asked: f64, ease: f64, opened: f64) -> f64 {
        let strengths = self.strengths(normal);
        let [peak, residual] = strengths;
        let drop = peak - residual;
        let limit = peak - drop * 0.5 * (self.damage + opened);
        let end = self.slip_at_end(strengths);
        if asked <= limit || end <= 0.0 {
            return limit;
        }
        let start = peak - drop * (0.5 * (self.damage + self.slip / end)).min(1.0);
        if asked <= start {
            return limit;
        }
        let slope = 0.5 * drop / end * ease;
        if slope < 1.0 {
            let softer = (start - slope * asked) / (1.0 - slope);
            if self.slip + ease * (asked - softer) <= end {
                return softer.min(limit);
            }
        }
        let left = 0.5 * drop * (1.0 - self.damage) * (end - self.slip).max(0.0);
        (residual + spent(left, ease * (asked - residual), ease)).min(limit)
    }

    /// Damage after a step at whose end the joint is open by `opening` (m), and in which it has slipped by `slipped`
    /// (m) under the forces (N/m) normal and shear.
    pub fn after(&self, opening: f64, slipped: f64, [normal, shear]: [f64; 2]) -> Damaged {
        let opened = self.damage_at(opening);
        let mut after =
            Damaged { damage: opened, loss: 0.5 * self.tension * self.opening * (opened - self.damage), of_slip: 0.0 };
        if slipped == 0.0 {
            return after;
        }
        let strengths = self.strengths(normal);
        after.of_slip = (shear.abs() - strengths[1]).max(0.0) * slipped.abs();
        let end = self.slip_at_end(strengths);
        let slid = if end > 0.0 { ((self.slip + slipped.abs()) / end).min(1.0) } else { 1.0 };
        if slid > opened {
            let opening = opening.max(0.0);
            after.loss += (self.energy(opening, opened) - self.energy(opening, slid)).max(0.0);
            after.damage = slid;
        }
        after.loss += after.of_slip;
        after
    }

    /// Energy (J/m) stored at an opening (m) and some damage.
    fn energy(&self, opening: f64, damage: f64) -> f64 {
        if self.tension <= 0.0 || damage >= 1.0 {
            return 0.0;
        }
        let opening = opening.min(self.reached(damage));
        0.5 * self.secant(damage) * opening * opening
    }

    /// Energy (J/m) stored in the normal spring at an opening (m); less than zero where it is closed.
    pub fn stored(&self, opening: f64) -> f64 {
        if opening > 0.0 { self.energy(opening, self.damage) } else { 0.5 * self.stiffness[0] * opening * opening }
    }
}

/// Shear force (N/m) at the peak and after failure, of tan φ and cohesive force (N/m) of both, under a normal force
/// (N/m).
pub(super) fn strengths(shear: [[f64; 2]; 2], normal: f64) -> [f64; 2] {
    let [peak, residual] = shear.map(|line| shear_on(line, normal));
    [peak, residual.min(peak)]
}

/// Force (N/m) that gives the energy `left` (J/m) over a way (m) of which a unit of force takes `c` (m²/N); the
/// greatest possible where the way is too short for that.
fn spent(left: f64, way: f64, c: f64) -> f64 {
    let square = way * way - 4.0 * c * left;
    if square < 0.0 { 0.5 * way / c } else { 2.0 * left / (way + square.sqrt()) }
}
