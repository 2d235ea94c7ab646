//! Water of a case that flows in its joints.

use crate::keys::shared::{HEIGHT, PLACE};
use crate::keys::unit::{METRE, VISCOSITY};
use crate::keys::{Range, Rule, keys};
use crate::{CUT_LAW, Case, JointLaw};

/// Hydraulic apertures of joints.
const APERTURE: Rule = Range::above(0.0).to(1.0).of(METRE).usual([1e-6, 2e-2], "joints have 1e-5 to 1e-3 m");
/// The same of a law, whose joints may be closed to water.
pub(crate) const LAW_APERTURE: Rule = APERTURE
    .in_range(Range::from(0.0).to(1.0))
    .hint("0 for joints that do not conduct; leave it out for flow.aperture");
/// Heads.
pub(crate) const HEAD: Rule = HEIGHT.hint("the height y to which the water would rise");

/// Least and greatest aperture over those of the laws, where a case names none.
const NARROWEST: f64 = 0.1;
const WIDEST: f64 = 20.0;

keys! {
    /// Water that flows in the joints, by the cubic law: static stages find the steady flow with its free surface at
    /// their start. Pieces of joint that no bond and no excavation closes are pipes between the crossings of joints,
    /// the rock between them is tight. Outcrops below the surface of `[water]` have its head, others are open to the
    /// air, and no water goes through edges of `[[fix]]`, `[[quiet]]` and `[[free_field]]`, unless a `[[head]]` lies
    /// there.
    pub default struct Flow {
        /// Hydraulic aperture (m) at the start of joints whose law names none; default: none, so that each law needs
        /// its own.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub aperture: Option<f64> => APERTURE.hint("leave it out where each law has its own").label("Aperture"),
        /// Least aperture (m) to which joints close between the start and a later stage; default: a tenth of the least
        /// one.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub aperture_min: Option<f64> => APERTURE.hint("leave it out for a tenth of the least aperture"),
        /// Greatest aperture (m) to which joints open between the start and a later stage; default: 20 times the
        /// greatest one.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub aperture_max: Option<f64> => APERTURE.hint("leave it out for 20 times the greatest aperture"),
        /// Dynamic viscosity (Pa s) of the water: flows go with its inverse, pressures do not depend on it.
        pub viscosity: f64 = 1e-3 =>
            Range::above(0.0).to(1e3).of(VISCOSITY).usual([1e-4, 1e-1], "water has 1e-3 Pa s").label("Viscosity"),
    }
}

keys! {
    /// A head that is held where joints lie on a segment: the water level behind a slope, or in a crack.
    pub struct Head {
        /// Name, for stages and results.
        pub name: String,
        /// Segment (m) of the outline or along joints: the ends and crossings of joints there have the head. Outcrops
        /// above it are open to the air, and on crossings above it within the rock it does not act.
        pub edge: [[f64; 2]; 2] => PLACE,
        /// Height y (m) to which the water would rise there at the start.
        pub level: f64 => HEAD.label("Head"),
    }
}

impl Case {
    /// Hydraulic aperture (m) at the start of the joints of a law, by its name; 0 for one that does not conduct, none
    /// where neither the law nor `[flow]` says so. Construction joints are closed.
    pub fn aperture(&self, name: &str, law: &JointLaw) -> Option<f64> {
        let shared = self.flow.as_ref().and_then(|flow| flow.aperture);
        law.aperture.or(if name == CUT_LAW { Some(0.0) } else { shared })
    }

    /// Least and greatest aperture (m) that openings may lead to; none where no joint conducts.
    pub fn aperture_range(&self) -> Option<[f64; 2]> {
        let flow = self.flow.as_ref()?;
        let of_laws = self.joint_laws.iter().filter_map(|(name, law)| self.aperture(name, law));
        let [low, high] =
            of_laws.filter(|aperture| *aperture > 0.0).fold(None, |range: Option<[f64; 2]>, aperture| {
                let [low, high] = range.unwrap_or([aperture; 2]);
                Some([low.min(aperture), high.max(aperture)])
            })?;
        Some([flow.aperture_min.unwrap_or(NARROWEST * low), flow.aperture_max.unwrap_or(WIDEST * high)])
    }
}
