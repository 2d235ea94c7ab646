//! Joint laws of a case.

use crate::keys::shared::{ANGLE, DILATION, STRENGTH};
use crate::keys::unit::{ENERGY, METRE, NUMBER, PASCAL, PASCAL_PER_METRE};
use crate::keys::{Range, Rule, keys, words};

words! {
    /// Kind of a joint law.
    #[derive(Default)]
    pub enum JointLawKind {
        /// |T| ≤ N·tan φ + c·l with tension cut-off, peak and residual values, dilation.
        #[default]
        MohrCoulomb = "mohr_coulomb",
        /// |τ| ≤ σ·tan(φr + JRC·log10(JCS/σ)) with φr = `friction_deg`, and hyperbolic closure.
        BartonBandis = "barton_bandis",
    }
}

/// Stiffness of joints.
const SPRING: Rule = Range::above(0.0)
    .to(1e18)
    .of(PASCAL_PER_METRE)
    .hint("leave it out for the solver's")
    .usual([1e6, 1e14], "joints have 1e8 to 1e12 Pa/m");
/// Friction angles of joints.
pub(crate) const FRICTION: Rule = ANGLE.hint("rock joints have 15 to 50").usual([8.0, 75.0], "joints have 15 to 60°");
/// Cohesion of joints.
pub(crate) const COHESION: Rule =
    STRENGTH.hint("0 for a clean joint").usual([100.0, 1e8], "joints have 0 to 1e6 Pa, rock bridges up to 3e7");
/// Tensile strength of joints.
pub(crate) const TENSION: Rule = STRENGTH
    .hint("the tensile strength is written positive")
    .usual([100.0, 5e7], "joints have 0 to 1e5 Pa, rock bridges up to 2e7");
/// Strength of the walls of joints.
const WALL: Rule = Range::above(0.0).to(1e12).of(PASCAL).usual([5e5, 1e9], "walls of joints have 5e6 to 3e8 Pa");
/// Energies of fracture: glass has some 1 J/m², rock 10 to 1000 in tension and some 1e5 in shear.
const FRACTURE: Rule = Range::above(0.0).to(1e9).of(ENERGY).hint("leave it out for a brittle joint");

keys! {
    /// Strength and stiffness of a joint.
    #[derive(Default)]
    pub struct JointLaw {
        /// Kind of law.
        #[serde(default)]
        pub kind: JointLawKind,
        /// Normal stiffness (Pa/m); default: the solver's contact stiffness.
        pub normal_stiffness: Option<f64> => SPRING.label("Normal stiffness"),
        /// Shear stiffness (Pa/m); default: the solver's contact stiffness.
        pub shear_stiffness: Option<f64> => SPRING.label("Shear stiffness"),
        /// Friction angle (degrees); of Barton–Bandis joints the residual angle φr.
        pub friction_deg: f64 => FRICTION.example(30.0).label("Friction"),
        /// Cohesion (Pa).
        #[serde(default)]
        pub cohesion: f64 => COHESION.label("Cohesion"),
        /// Tensile strength (Pa).
        #[serde(default)]
        pub tension: f64 => TENSION.label("Tension"),
        /// Friction angle after failure (degrees); default: `friction_deg`.
        pub residual_friction_deg: Option<f64> => FRICTION.hint("leave it out for the peak").label("Residual friction"),
        /// Cohesion after failure (Pa); default: `cohesion`.
        pub residual_cohesion: Option<f64> => COHESION.hint("leave it out for the peak").label("Residual cohesion"),
        /// Tensile strength after failure (Pa).
        #[serde(default)]
        pub residual_tension: f64 => TENSION.hint("0 for a broken joint"),
        /// Dilation angle while slipping (degrees).
        #[serde(default)]
        pub dilation_deg: f64 => DILATION.hint("0 for a smooth joint").label("Dilation").none_at_zero(),
        /// Slip (m) to either side at which dilation ends; default: 0.05, ten times the slip at which a joint of 1 m
        /// has its peak strength (Barton 1982). The faces come down again on the way back.
        pub dilation_slip: Option<f64> =>
            Range::above(0.0).to(1e6).of(METRE).hint("leave it out for 0.05 m")
                .usual([1e-4, 10.0], "joints dilate over 1e-3 to 0.2 m"),
        /// Joint roughness coefficient (Barton–Bandis).
        pub jrc: Option<f64> =>
            Range::from(0.0).to(30.0).of(NUMBER).hint("0 for smooth to 20 for very rough joints").label("JRC"),
        /// Joint wall compressive strength (Pa; Barton–Bandis).
        pub jcs: Option<f64> => WALL.hint("up to the strength of the rock, 1e6 to 3e8").label("JCS"),
        /// Greatest closure (m; Barton–Bandis): the normal stress is kn·v/(1 − v/this) at closure v; default: linear.
        pub closure_max: Option<f64> =>
            Range::above(0.0).to(1e3).of(METRE).hint("leave it out for linear closure")
                .usual([1e-6, 2e-2], "joints close by 1e-5 to 1e-3 m"),
        /// Pressure (Pa) over its length that a contact carries before the rock crushes; default: `jcs`, and without
        /// one the rock does not crush.
        pub crush: Option<f64> => WALL.in_range(Range::from(1e3).to(1e12)).hint("the strength of the rock, 1e6 to 3e8"),
        /// Energy of fracture in tension (J/m²): the tensile strength falls with the opening until this much is spent;
        /// default: it is lost at once. Not with `residual_tension`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub tension_energy: Option<f64> =>
            FRACTURE.usual([1.0, 1e5], "rock takes 20 to 500 J/m²").label("Energy of fracture, opening"),
        /// Energy of fracture in shear (J/m²), beyond the heat of residual friction: friction and cohesion fall from
        /// their peak values to the residual ones with the slip until this much is spent; default: they fall at once.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub shear_energy: Option<f64> =>
            FRACTURE.usual([1.0, 1e7], "rock takes 100 to 1e5 J/m²").label("Energy of fracture, slip"),
        /// How rock bridges of this law break: `by section`, as a whole under the tension, shear and bending of their
        /// section, or `by node`, contact by contact; default: by section where the rock is brittle, or its
        /// characteristic length E'·`tension_energy`/`tension`² at most four times the bridge, and rock beside it half
        /// as deep as it is long.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub breaks: Option<Breaks>,
        /// Hydraulic aperture (m) at the start, for `[flow]`; 0 for joints that do not conduct; default:
        /// `flow.aperture`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub aperture: Option<f64> => crate::flow::LAW_APERTURE.label("Aperture"),
        /// Mechanical aperture E (m) at the start of a Barton–Bandis joint, for `[flow]`: the hydraulic one is
        /// E²/JRC^2.5 (µm; Barton, Bandis and Bakhtar 1985) and at most E, and openings add to E; in place of
        /// `aperture`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub mechanical_aperture: Option<f64> =>
            crate::flow::APERTURE.hint("1e-4 to 1e-3 m is usual; leave it out for `aperture`")
                .label("Mechanical aperture"),
        /// Uniaxial compressive strength σc (Pa) of the rock beside a Barton–Bandis joint, for `[flow]`: its mechanical
        /// aperture at the start is JRC/5·(0.2σc/JCS - 0.1) mm; in place of `mechanical_aperture`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub intact_strength: Option<f64> => WALL.hint("JCS of fresh walls, more of weathered ones"),
    }
}

words! {
    /// How the rock bridges of a joint law break.
    pub enum Breaks {
        /// As a whole, under the tension, shear and bending of their section.
        BySection = "by section",
        /// Contact by contact.
        ByNode = "by node",
    }
}

impl JointLaw {
    /// Whether it loses its peak strength step by step, with an energy of fracture.
    pub fn softens(&self) -> bool {
        self.tension_energy.is_some() || self.shear_energy.is_some()
    }

    /// Whether its strength is a curve over the normal stress, and not the line of Mohr and Coulomb.
    pub fn is_curved(&self) -> bool {
        self.kind != JointLawKind::MohrCoulomb
    }

    /// Mechanical aperture E (m) at the start, of a law that has one.
    pub fn mechanical(&self) -> Option<f64> {
        let (jrc, jcs) = (self.jrc.unwrap_or_default(), self.jcs.unwrap_or(f64::INFINITY));
        let by_strength = |strength: f64| 1e-3 * jrc / 5.0 * (0.2 * strength / jcs - 0.1);
        self.mechanical_aperture.or(self.intact_strength.map(by_strength))
    }

    /// Hydraulic aperture over the square of the mechanical one (1/m), by JRC.
    pub fn smoothness(&self) -> f64 {
        let jrc = self.jrc.unwrap_or_default();
        1e6 / (jrc * jrc * jrc.sqrt())
    }

    /// A Mohr–Coulomb joint with friction (degrees) alone.
    pub fn frictional(friction_deg: f64) -> Self {
        Self { friction_deg, ..Self::default() }
    }
}

/// Slip (m) at which dilation ends where a law does not say.
pub const DILATION_SLIP: f64 = 0.05;
