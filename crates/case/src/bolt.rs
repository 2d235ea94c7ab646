//! Rock bolts of a case.

use crate::keys::shared::{DIRECTION, LENGTH, PLACE};
use crate::keys::unit::{NEWTON, NEWTON_PER_METRE, NUMBER, PASCAL, SQUARE_METRE};
use crate::keys::{Range, Rule, keys, words};

words! {
    /// How a bolt is tied to the rock.
    #[derive(Default)]
    pub enum Anchorage {
        /// At its two ends; the bar between them is free.
        #[default]
        Ends = "ends",
        /// Along its whole length: at each joint that it crosses a short free length bridges the joint.
        Grouted = "grouted",
    }

    /// Force of a bolt in the factor of safety and in limit analysis.
    pub enum Support {
        /// Its pretension, whatever the rock does.
        Active = "active",
        /// Its yield force, whatever the rock does.
        Passive = "passive",
    }
}

/// Most bolts of a pattern.
pub(crate) const BOLTS_MAX: u32 = 10_000;

/// Young's modulus of bars.
const YOUNG: Rule = Range::above(0.0).to(1e15).of(PASCAL).usual([2e10, 4e11], "steel has 2e11 Pa").example(200e9);
/// Cross-sections of bars.
const AREA: Rule = Range::above(0.0)
    .to(1e3)
    .of(SQUARE_METRE)
    .usual([4e-5, 2e-2], "a bar of 25 mm has 4.9e-4 m²")
    .example(4.9e-4)
    .label("Section of a bar");
/// Distances of bars out of the plane.
const SPACING: Rule = LENGTH
    .hint("1 for one bar per metre")
    .usual([0.2, 50.0], "bars stand 1 to 5 m apart")
    .label("Spacing out of plane");
/// Forces at which bars yield.
const YIELD_FORCE: Rule = Range::above(0.0)
    .to(1e12)
    .of(NEWTON)
    .hint("leave it out for a bar that never yields")
    .usual([5e3, 2e7], "bars carry 1e5 to 5e5 N, anchors up to 3e6")
    .label("Yield force");
/// Elongations at which bars break.
const RUPTURE_STRAIN: Rule = Range::above(0.0).to(1e6).of(NUMBER).hint("0.05 to 0.2 is usual");
/// Forces of bars when they are installed.
const PRETENSION: Rule = YIELD_FORCE
    .in_range(Range::from(0.0).to(1e12))
    .hint("0 for a bar without tension")
    .label("Pretension")
    .none_at_zero();
/// Free lengths of bars at joints.
const FREE_LENGTH: Rule =
    LENGTH.hint("leave it out for a tenth of the mesh size").usual([0.01, 100.0], "0.05 to 0.5 m are usual at a joint");

/// Forces per metre of a bar at which it slips in its grout.
const BOND: Rule = Range::above(0.0)
    .to(1e12)
    .of(NEWTON_PER_METRE)
    .hint("1e5 to 5e5 in rock")
    .usual([5e3, 5e6], "grout holds 1e5 to 5e5 N per metre of a bar")
    .example(250e3)
    .label("Bond");
/// The same over the slip.
const BOND_STIFFNESS: Rule = Range::above(0.0)
    .to(1e15)
    .of(PASCAL)
    .hint("1e8 to 1e10 is usual")
    .usual([1e6, 1e12], "grout has 1e8 to 1e10 N/m per metre of a bar")
    .example(1e9)
    .label("Stiffness of bond");

keys! {
    /// A row of equal elastic–plastic bars that carry tension across joints.
    #[derive(Default)]
    pub struct Bolt {
        /// Name, for stages that install it.
        pub name: Option<String>,
        /// Head and far end (m), both in rock; required, unless a layer of a drawing names the bolt.
        #[serde(default, skip_serializing_if = "is_nowhere")]
        pub points: [[f64; 2]; 2] => PLACE,
        /// Ends or grouted.
        #[serde(default)]
        pub anchorage: Anchorage,
        /// Young's modulus of the bar (Pa).
        pub young: f64 => YOUNG,
        /// Cross-section of one bar (m²).
        pub area: f64 => AREA,
        /// Distance between bars out of the plane (m).
        #[serde(default = "crate::keys::one")]
        pub spacing: f64 => SPACING,
        /// Force (N) at which one bar yields; default: never.
        pub yield_force: Option<f64> => YIELD_FORCE,
        /// Elongation of the free length, relative to it, at which the bar breaks; default: 0.1, as of
        /// bars of steel, if it has a yield force, else never. Strands break at 0.035.
        pub rupture_strain: Option<f64> => RUPTURE_STRAIN,
        /// Force (N) of one bar when it is installed.
        #[serde(default)]
        pub pretension: f64 => PRETENSION,
        /// Free length (m) at a joint that a grouted bar crosses; default: a tenth of the mesh size.
        pub free_length: Option<f64> => FREE_LENGTH,
        /// Force (N) per metre at which one grouted bar slips along the rock; default: it is fixed to the rock but for
        /// a free length at each joint.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub bond: Option<f64> => BOND,
        /// Force per metre over the slip (N/m per metre) of one bar with a `bond`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub bond_stiffness: Option<f64> => BOND_STIFFNESS,
        /// Whether a plate holds the head of a bar with a bond to the face.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        pub plate: bool,
        /// Force in `enmm fos` and `enmm bound`: that of an active or of a passive support. Default: `fos` lets the bar
        /// stretch with the rock, and `bound` takes the most that it can carry.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub support: Option<Support>,
        /// Whether it is there from the start; else a stage installs it by name.
        #[serde(default = "crate::keys::yes")]
        pub active: bool,
        /// Whether it is a member of a skin.
        #[serde(skip)]
        pub of_skin: bool,
    }
}

impl Bolt {
    /// Whether the bolt leaves its points to a layer of a drawing.
    pub fn has_no_points(&self) -> bool {
        is_nowhere(&self.points)
    }
}

/// Whether points are those of a bolt that gives none.
fn is_nowhere(points: &[[f64; 2]; 2]) -> bool {
    *points == [[0.0; 2]; 2]
}

keys! {
    /// A row of equal bolts whose heads lie on the face. Bolts of a pattern `rock` are named `rock_1`, `rock_2`, …; a
    /// stage installs all of them by `rock`.
    #[derive(Default)]
    pub struct BoltPattern {
        /// Name, for stages that install it.
        pub name: Option<String>,
        /// Head line (m), near the face: each bolt, prolonged both ways from its point on this line, enters the rock at
        /// its head, the nearest such point of outline or holes.
        pub line: [[f64; 2]; 2] => PLACE,
        /// Number of bolts in the section, the first and last at the ends of the line, a single one in its middle; this
        /// or `distance`.
        pub count: Option<u32> => Range::from(1.0).to(BOLTS_MAX as f64).of(NUMBER).hint("the bolts in the section"),
        /// Distance between bolts in the section, along the line from its first point (m); this or `count`.
        pub distance: Option<f64> =>
            LENGTH.hint("between bolts along the line").usual([0.2, 100.0], "1 to 5 m is usual"),
        /// Length of a bolt from its head (m).
        pub length: f64 =>
            LENGTH.hint("from the head to the far end")
                .usual([0.5, 200.0], "bars have 2 to 12 m, anchors up to 60").example(6.0),
        /// Direction from the head into the rock, counter-clockwise from the x axis (degrees): -15 dips to the right by
        /// 15°.
        pub angle_deg: f64 => DIRECTION.hint("from the head into the rock").example(-15.0),
        /// Ends or grouted.
        #[serde(default)]
        pub anchorage: Anchorage,
        /// Young's modulus of the bar (Pa).
        pub young: f64 => YOUNG,
        /// Cross-section of one bar (m²).
        pub area: f64 => AREA,
        /// Distance between bars out of the plane (m).
        #[serde(default = "crate::keys::one")]
        pub spacing: f64 => SPACING,
        /// Force (N) at which one bar yields; default: never.
        pub yield_force: Option<f64> => YIELD_FORCE,
        /// Elongation of the free length, relative to it, at which the bar breaks; default: 0.1, as of
        /// bars of steel, if it has a yield force, else never. Strands break at 0.035.
        pub rupture_strain: Option<f64> => RUPTURE_STRAIN,
        /// Force (N) of one bar when it is installed.
        #[serde(default)]
        pub pretension: f64 => PRETENSION,
        /// Free length (m) at a joint that a grouted bar crosses; default: a tenth of the mesh size.
        pub free_length: Option<f64> => FREE_LENGTH,
        /// Force (N) per metre at which one grouted bar slips along the rock; default: it is fixed to the rock but for
        /// a free length at each joint.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub bond: Option<f64> => BOND,
        /// Force per metre over the slip (N/m per metre) of one bar with a `bond`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub bond_stiffness: Option<f64> => BOND_STIFFNESS,
        /// Whether a plate holds the head of a bar with a bond to the face.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        pub plate: bool,
        /// Force in `enmm fos` and `enmm bound`: that of an active or of a passive support. Default: `fos` lets the bar
        /// stretch with the rock, and `bound` takes the most that it can carry.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub support: Option<Support>,
        /// Whether the bolts are there from the start; else a stage installs them by name.
        #[serde(default = "crate::keys::yes")]
        pub active: bool,
    }
}
