//! Rocks of a case.

use crate::keys::shared::{ANGLE, DILATION, PLACE, ROCK_DENSITY, STRENGTH};
use crate::keys::unit::{NUMBER, PASCAL};
use crate::keys::{Range, keys, words};
use crate::{HoekBrown, PlaneOfWeakness, PointList, RockFracture};

words! {
    /// Plane strain or plane stress.
    #[derive(Default)]
    pub enum Plane {
        /// No strain out of the plane.
        #[default]
        Strain = "strain",
        /// No stress out of the plane.
        Stress = "stress",
    }
}

/// Remedy for rock that is meant to be elastic.
pub(crate) const FREE: &str = "leave out friction_deg and cohesion for rock that never yields";

keys! {
    /// An elastic rock; with `friction_deg` or `cohesion` it yields by Mohr–Coulomb, with `hoek_brown` by Hoek–Brown.
    pub struct Rock {
        /// Density (kg/m³).
        pub density: f64 => ROCK_DENSITY.example(2700.0).label("Density"),
        /// Young's modulus (Pa).
        pub young: f64 =>
            Range::from(1.0).to(1e15).of(PASCAL).usual([1e8, 5e11], "rock masses have 1e9 to 1e11 Pa")
                .example(10e9).label("Young's modulus"),
        /// Poisson's ratio.
        pub poisson: f64 =>
            Range::above(-1.0).to(0.5).of(NUMBER).hint("rock has 0.1 to 0.4").example(0.25).label("Poisson's ratio"),
        /// Plane strain or plane stress.
        #[serde(default)]
        pub plane: Plane,
        /// Friction angle (degrees); with neither this nor `cohesion` nor `hoek_brown` the rock never yields.
        pub friction_deg: Option<f64> =>
            ANGLE.hint(FREE).usual([8.0, 75.0], "soil and rock have 15 to 60°").label("Friction"),
        /// Cohesion (Pa).
        pub cohesion: Option<f64> =>
            STRENGTH.hint(FREE).usual([500.0, 1e8], "soil has 1e3 to 1e5 Pa, rock masses 1e4 to 1e7").label("Cohesion"),
        /// Generalized Hoek–Brown strength, in place of `friction_deg` and `cohesion`; needs plane strain.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub hoek_brown: Option<HoekBrown>,
        /// Planes along which rock that yields is weaker than elsewhere; default: it is as strong in all directions.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub plane_of_weakness: Option<PlaneOfWeakness>,
        /// Dilation angle (degrees), at most `friction_deg` (associated flow); default: 0, at which it keeps its
        /// volume.
        pub dilation_deg: Option<f64> => DILATION.hint("0 is usual").label("Dilation"),
        /// Tensile strength (Pa); default: the apex of the Mohr–Coulomb surface, or s·σci/mb of Hoek–Brown.
        pub tension: Option<f64> =>
            STRENGTH.hint("leave it out for the apex").usual([100.0, 5e7], "rock has 1e4 to 2e7 Pa").label("Tension"),
        /// Strength of its blocks, which break where a section through them has it; default: they never break.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub fracture: Option<RockFracture>,
        /// Polygon (m): elements whose centroid lies inside are of this rock.
        pub region: Option<PointList> => PLACE,
        /// Points (m): the blocks that hold them are of this rock.
        #[serde(default)]
        pub blocks: PointList => PLACE,
    }
}

impl Rock {
    /// Whether the rock has a strength that can be exceeded.
    pub fn yields(&self) -> bool {
        self.friction_deg.is_some() || self.cohesion.is_some() || self.hoek_brown.is_some()
    }

    /// Whether water has pressure in its pores: where its strength is that of effective stresses. A plate under plane
    /// stress drains to its sides, and strength without friction is that of total stresses.
    pub fn is_porous(&self) -> bool {
        let along = self.plane_of_weakness.is_some_and(|plane| plane.friction_deg > 0.0);
        let has_friction = self.friction_deg.is_some_and(|angle| angle > 0.0) || self.hoek_brown.is_some() || along;
        has_friction && self.plane == Plane::Strain
    }

    /// Whether the rock swells when it yields.
    pub fn dilates(&self) -> bool {
        self.dilation_deg.unwrap_or_default() > 0.0 || self.hoek_brown.is_some_and(|mass| mass.associated)
    }
}
