//! Rock bolts of a case.

use serde::{Deserialize, Serialize};

/// How a bolt is tied to the rock.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Anchorage {
    /// At its two ends; the bar between them is free.
    #[default]
    Ends,
    /// Along its whole length: at each joint that it crosses a short free length bridges the joint.
    Grouted,
}

/// Force of a bolt in the factor of safety and in limit analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Support {
    /// Its pretension, whatever the rock does.
    Active,
    /// Its yield force, whatever the rock does.
    Passive,
}

impl Support {
    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Active => "active",
            Self::Passive => "passive",
        }
    }
}

/// A row of equal elastic–plastic bars that carry tension across joints.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Bolt {
    /// Name, for stages that install it.
    #[serde(default)]
    pub name: Option<String>,
    /// Head and far end (m), both in rock; required, unless a layer of a drawing names the bolt.
    #[serde(default, skip_serializing_if = "is_nowhere")]
    pub points: [[f64; 2]; 2],
    /// Ends or grouted.
    #[serde(default)]
    pub anchorage: Anchorage,
    /// Young's modulus of the bar (Pa).
    #[cfg_attr(feature = "schema", schemars(example = 200e9))]
    pub young: f64,
    /// Cross-section of one bar (m²).
    #[cfg_attr(feature = "schema", schemars(example = 4.9e-4))]
    pub area: f64,
    /// Distance between bars out of the plane (m).
    #[serde(default = "one")]
    pub spacing: f64,
    /// Force (N) at which one bar yields; default: never.
    #[serde(default)]
    pub yield_force: Option<f64>,
    /// Elongation of the free length, relative to it, at which the bar breaks; default: 0.1, as of
    /// bars of steel, if it has a yield force, else never. Strands break at 0.035.
    #[serde(default)]
    pub rupture_strain: Option<f64>,
    /// Force (N) of one bar when it is installed.
    #[serde(default)]
    pub pretension: f64,
    /// Free length (m) at a joint that a grouted bar crosses; default: a tenth of the mesh size.
    #[serde(default)]
    pub free_length: Option<f64>,
    /// Force in `enmm fos` and `enmm bound`: that of an active or of a passive support. Default: `fos` lets the bar
    /// stretch with the rock, and `bound` takes the most that it can carry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub support: Option<Support>,
    /// Whether it is there from the start; else a stage installs it by name.
    #[serde(default = "yes")]
    pub active: bool,
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

/// A row of equal bolts whose heads lie on the face. Bolts of a pattern `rock` are named `rock_1`, `rock_2`, …; a stage
/// installs all of them by `rock`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BoltPattern {
    /// Name, for stages that install it.
    #[serde(default)]
    pub name: Option<String>,
    /// Head line (m), near the face: each bolt, prolonged both ways from its point on this line, enters the rock at its
    /// head, the nearest such point of outline or holes.
    pub line: [[f64; 2]; 2],
    /// Number of bolts in the section, 1 to 10000, the first and last at the ends of the line, a single one in its
    /// middle; this or `distance`.
    #[serde(default)]
    pub count: Option<u32>,
    /// Distance between bolts in the section, along the line from its first point (m); this or `count`.
    #[serde(default)]
    pub distance: Option<f64>,
    /// Length of a bolt from its head (m).
    #[cfg_attr(feature = "schema", schemars(example = 6.0))]
    pub length: f64,
    /// Direction from the head into the rock, counter-clockwise from the x axis (degrees), at least -360 and at most
    /// 360: -15 dips to the right by 15°.
    #[cfg_attr(feature = "schema", schemars(example = -15.0))]
    pub angle_deg: f64,
    /// Ends or grouted.
    #[serde(default)]
    pub anchorage: Anchorage,
    /// Young's modulus of the bar (Pa).
    #[cfg_attr(feature = "schema", schemars(example = 200e9))]
    pub young: f64,
    /// Cross-section of one bar (m²).
    #[cfg_attr(feature = "schema", schemars(example = 4.9e-4))]
    pub area: f64,
    /// Distance between bars out of the plane (m).
    #[serde(default = "one")]
    pub spacing: f64,
    /// Force (N) at which one bar yields; default: never.
    #[serde(default)]
    pub yield_force: Option<f64>,
    /// Elongation of the free length, relative to it, at which the bar breaks; default: 0.1, as of
    /// bars of steel, if it has a yield force, else never. Strands break at 0.035.
    #[serde(default)]
    pub rupture_strain: Option<f64>,
    /// Force (N) of one bar when it is installed.
    #[serde(default)]
    pub pretension: f64,
    /// Free length (m) at a joint that a grouted bar crosses; default: a tenth of the mesh size.
    #[serde(default)]
    pub free_length: Option<f64>,
    /// Force in `enmm fos` and `enmm bound`: that of an active or of a passive support. Default: `fos` lets the bar
    /// stretch with the rock, and `bound` takes the most that it can carry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub support: Option<Support>,
    /// Whether the bolts are there from the start; else a stage installs them by name.
    #[serde(default = "yes")]
    pub active: bool,
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}
