//! Bonds that soften: tensile strength and cohesion that fall with opening and slip, with the energy of fracture that
//! a law gives (theory §7).

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
    fn range(&self) -> Option<f64> {
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
    fn strengths(&self, normal: f64) -> [f64; 2] {
        let [peak, residual] = self.shear.map(|[friction, cohesion]| (normal * friction + cohesion).max(0.0));
        [peak, residual.min(peak)]
    }

    /// Slip (m) at which the shear strength under a normal force (N/m) is residual (Eq. 22c); 0 where it is lost at
    /// once.
    fn slip_at_end(&self, [peak, residual]: [f64; 2]) -> f64 {
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

/// Force (N/m) that gives the energy `left` (J/m) over a way (m) of which a unit of force takes `c` (m²/N); the
/// greatest possible where the way is too short for that.
fn spent(left: f64, way: f64, c: f64) -> f64 {
    let square = way * way - 4.0 * c * left;
    if square < 0.0 { 0.5 * way / c } else { 2.0 * left / (way + square.sqrt()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A metre of bond of A1: σt 5 MPa, G_I 50 J/m², so that it is broken at 20 µm.
    fn bond() -> Bond {
        Bond {
            stiffness: [1e13, 1e12],
            tension: 5e6,
            opening: 20e-6,
            shear_energy: 500.0,
            shear: [[0.7, 0.5e6], [0.5, 0.0]],
            damage: 0.0,
            slip: 0.0,
        }
    }

    /// Opens a bond by equal steps to `end` (m); returns work and energy of fracture (J/m).
    fn open(bond: &mut Bond, steps: u32, end: f64) -> [f64; 2] {
        let (mut work, mut loss, mut last) = (0.0, 0.0, 0.0);
        for k in 1..=steps {
            let opening = end * f64::from(k) / f64::from(steps);
            let force = bond.normal(-opening, 0.0);
            work -= force * (opening - last);
            let after = bond.after(opening, 0.0, [force, 0.0]);
            (bond.damage, loss, last) = (after.damage, loss + after.loss, opening);
        }
        [work, loss]
    }

    /// A1: 50 J/m², whether the bond softens in many steps or in two.
    #[test]
    fn opening_takes_the_energy_of_fracture_at_any_step() {
        for steps in [1000, 50, 3] {
            let mut bond = bond();
            // From the peak on, so that no step cuts the elastic branch.
            let peak = 0.5e-6;
            let elastic = 0.5 * 5e6 * peak;
            let (mut work, mut last, mut loss) = (elastic, peak, 0.0);
            for k in 1..=steps {
                let opening = peak + 30e-6 * f64::from(k) / f64::from(steps);
                let force = bond.normal(-opening, 0.0);
                work -= force * (opening - last);
                let after = bond.after(opening, 0.0, [force, 0.0]);
                (bond.damage, loss, last) = (after.damage, loss + after.loss, opening);
            }
            assert!((loss - 50.0).abs() < 1e-9, "{loss}");
            assert!((work - 50.0).abs() < 1e-7, "{steps} steps: {work} J/m²");
        }
    }

    #[test]
    fn it_unloads_to_the_origin_and_remembers() {
        let mut bond = bond();
        let [work, loss] = open(&mut bond, 2000, 10e-6);
        assert!(bond.damage > 0.48 && bond.damage < 0.49, "{}", bond.damage);
        assert!((loss - 50.0 * bond.damage).abs() < 1e-9);
        assert!((work - loss - bond.stored(10e-6)).abs() < 0.05, "{work} {loss}");
        let half = bond.normal(-5e-6, 0.0);
        assert!((half / bond.normal(-10e-6, 0.0) - 0.5).abs() < 1e-12);
        assert_eq!(bond.damage_at(5e-6), bond.damage);
        assert_eq!(bond.normal(1e-9, 0.0), 1e4);
    }

    /// A2: τp = 0.5 + tan 35° MPa, τr = tan 30° MPa under 1 MPa, residual at 1.605504 mm.
    #[test]
    fn slip_takes_the_energy_of_fracture_beyond_residual_friction() {
        let tan = |degrees: f64| degrees.to_radians().tan();
        let mut bond = Bond { shear: [[tan(35.0), 0.5e6], [tan(30.0), 0.0]], ..bond() };
        let strengths = bond.strengths(1e6);
        assert!((strengths[0] - 1.200208e6).abs() < 1.0 && (strengths[1] - 0.577350e6).abs() < 1.0);
        assert!((bond.slip_at_end(strengths) - 1.605504e-3).abs() < 1e-9);
        for steps in [7, 1000] {
            (bond.damage, bond.slip) = (0.0, 0.0);
            let (mut stored, mut loss) = (strengths[0], 0.0);
            for _ in 0..steps {
                let asked = stored + bond.stiffness[1] * 2e-3 / f64::from(steps);
                let limit = bond.shear(1e6, asked, 1.0 / bond.stiffness[1], bond.damage);
                let slipped = (asked - limit) / bond.stiffness[1];
                let after = bond.after(0.0, slipped, [1e6, limit]);
                (bond.damage, bond.slip, stored) = (after.damage, bond.slip + slipped, limit);
                loss += after.loss;
            }
            assert_eq!(bond.damage, 1.0);
            assert!((loss - 500.0).abs() < 1e-6, "{loss} J/m² in {steps} steps");
        }
    }

    #[test]
    fn a_bond_whose_spring_gives_back_more_than_it_takes_breaks_at_its_peak() {
        let brittle = Bond { stiffness: [1e11, 1e11], ..bond() };
        assert!(brittle.range().is_none());
        assert_eq!(brittle.normal(-49e-6, 0.0), -4.9e6);
        assert_eq!(brittle.normal(-51e-6, 0.0), 0.0);
        assert_eq!([brittle.damage_at(49e-6), brittle.damage_at(51e-6)], [0.0, 1.0]);
        let none = Bond { tension: 0.0, opening: 0.0, ..bond() };
        assert_eq!([none.normal(-1e-9, 0.0), none.damage_at(1e-9)], [0.0, 1.0]);
    }

    /// The force meets its own equation: it is that of the opening which it leaves.
    #[test]
    fn the_force_is_that_of_the_opening_which_it_leaves() {
        for c in [1e-14, 1e-12, 3e-12] {
            for b in [-0.2e-6, -0.6e-6, -5e-6, -15e-6] {
                let bond = bond();
                let force = bond.normal(b, c);
                let opening = c * force - b;
                assert!((bond.normal(-opening, 0.0) / force - 1.0).abs() < 1e-9, "{b} {c}: {force}");
            }
        }
    }
}
