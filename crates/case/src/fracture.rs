//! Rock of a case that breaks.

use crate::keys::shared::{ANGLE, LENGTH, STRENGTH};
use crate::keys::unit::{ENERGY, NUMBER, SQUARE_METRE};
use crate::keys::{Range, Rule, keys};

/// Counts of cuts and parts.
const COUNT: Rule = Range::from(1.0).to(100_000.0).of(NUMBER);

keys! {
    /// Strength of intact rock: its blocks break where a section through them has it.
    pub struct RockFracture {
        /// Tensile strength (Pa).
        pub tension: f64 =>
            Range::above(0.0).to(1e12).of(crate::keys::unit::PASCAL)
                .hint("the tensile strength is written positive")
                .usual([1e3, 5e7], "intact rock has 1e6 to 2e7 Pa").example(5e6).label("Tensile strength"),
        /// Cohesion (Pa); the tensile strength is at most this over tan(`friction_deg`).
        pub cohesion: f64 =>
            STRENGTH.hint("intact rock has 5e6 to 5e7")
                .usual([1e3, 1e9], "intact rock has 5e6 to 5e7 Pa").example(15e6).label("Cohesion of intact rock"),
        /// Friction angle (degrees).
        pub friction_deg: f64 =>
            ANGLE.hint("intact rock has 30 to 60").usual([8.0, 75.0], "intact rock has 30 to 60°")
                .example(45.0).label("Friction of intact rock"),
        /// Friction angle (degrees) of the faces of a crack; default: `friction_deg`.
        pub residual_friction_deg: Option<f64> =>
            ANGLE.hint("leave it out for friction_deg").usual([8.0, 75.0], "cracks have 25 to 45°")
                .label("Friction of cracks"),
        /// Energy of fracture in tension (J/m²): thin sections of tough rock are stronger in bending than in tension;
        /// default: brittle rock, which is not.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub tension_energy: Option<f64> =>
            Range::above(0.0).to(1e9).of(ENERGY).hint("leave it out for brittle rock")
                .usual([1.0, 1e5], "rock takes 20 to 500 J/m²").label("Energy of fracture of rock"),
        /// Whether blocks also split from within, as discs do under point loads: where the mean tension over 1.5 mesh
        /// sizes has the tensile strength, farther than that from their faces. For blocks of at least 12 mesh sizes.
        #[serde(default)]
        pub cores: bool,
    }
}

keys! {
    /// How rock with a table `fracture` breaks.
    pub default struct Fracture {
        /// Internal steps of a dynamic stage from one search for sections at their strength to the next; blocks at half
        /// of it are looked at in each step.
        pub every: u32 = 5 => COUNT.hint("5 is usual"),
        /// Longest section (m) that breaks; default: no limit.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub longest: Option<f64> => LENGTH.hint("leave it out for no limit"),
        /// Least area (m²) of a part; default: that of four triangles of the mesh, or `mesh.least_block` if that is
        /// more.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub least_part: Option<f64> => Range::above(0.0).to(1e12).of(SQUARE_METRE).hint("leave it out for the default"),
        /// Most parts that breaking may add; the run ends with one more.
        pub parts_max: u32 = 64 => COUNT.hint("64 is the default"),
        /// Most cuts that breaking may make; the run ends with one more.
        pub cuts_max: u32 = 1000 => COUNT.hint("1000 is the default"),
    }
}
