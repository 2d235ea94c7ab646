//! Joint sets of a case, construction joints, and regions whose joints have another law.

use serde::{Deserialize, Serialize};

use super::{Case, PointList};

/// Where the section lies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Azimuth of the x axis, clockwise from north (degrees), at least -360 and at most 360.
    #[cfg_attr(feature = "schema", schemars(example = 90.0))]
    pub azimuth_deg: f64,
}

/// A side of the section.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Towards smaller x.
    Left,
    /// Towards greater x.
    Right,
}

/// How spacings or trace lengths scatter about their mean.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// Normal by mean and standard deviation, cut off at 0.1 and 1.9 of the mean.
    #[default]
    Normal,
    /// Lognormal by its own mean and standard deviation, not those of the logarithm.
    Lognormal,
    /// Negative exponential by the mean, which is its standard deviation too.
    Exponential,
    /// Uniform by mean and standard deviation: between mean − √3·sd and mean + √3·sd.
    Uniform,
}

impl Distribution {
    /// Whether it is the default.
    pub fn is_normal(&self) -> bool {
        *self == Self::Normal
    }
}

/// How directions scatter about their mean.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum AngleDistribution {
    /// Normal by the standard deviation `angle_sd_deg`, cut off at three of them.
    #[default]
    Normal,
    /// Uniform by the standard deviation: up to √3·sd to both sides.
    Uniform,
    /// Poles by Fisher's distribution in space with the concentration `fisher_k`; the traces are where the joints meet
    /// the section, at most 60° from the mean.
    Fisher,
}

impl AngleDistribution {
    /// Whether it is the default.
    pub fn is_normal(&self) -> bool {
        *self == Self::Normal
    }
}

/// Straight parallel joints generated from statistics; the same seed gives the same joints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct JointSet {
    /// Direction of the traces, counter-clockwise from the x axis (degrees), at least -360 and at most 360; this, or
    /// `dip_deg` with `dips` or `dip_direction_deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<f64>,
    /// Dip below the horizontal (degrees), 0 to 90, with `dips` or `dip_direction_deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dip_deg: Option<f64>,
    /// Side towards which traces with `dip_deg` descend.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dips: Option<Side>,
    /// Azimuth (degrees, clockwise from north) towards which joints with `dip_deg` descend: the section, by
    /// `section.azimuth_deg`, cuts them at their apparent dip. `spacing` is then the distance normal to the joints in
    /// space, and greater in the section.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dip_direction_deg: Option<f64>,
    /// Standard deviation of the direction (degrees), the same as `angle_sd_deg`.
    #[serde(default)]
    pub dip_sd_deg: f64,
    /// Mean distance between neighbouring lines, normal to them (m).
    pub spacing: f64,
    /// Standard deviation of the spacing (m).
    #[serde(default)]
    pub spacing_sd: f64,
    /// Length of a trace (m); default: through the whole region.
    #[serde(default)]
    pub trace_length: Option<f64>,
    /// Standard deviation of the trace length (m).
    #[serde(default)]
    pub trace_length_sd: f64,
    /// Rock bridge between traces on one line (m).
    #[serde(default)]
    pub gap: f64,
    /// Seed of the generator.
    #[serde(default)]
    pub seed: u64,
    /// Polygon (m) to which the traces are clipped; default: the bounding box of the outline.
    #[serde(default)]
    pub region: Option<PointList>,
    /// Joint law by name; default `domain.joint_law`.
    #[serde(default)]
    pub law: Option<String>,
    /// Name, for sets that end on this one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Standard deviation of the direction of each trace (degrees), at least 0 and at most 30; default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_sd_deg: Option<f64>,
    /// How directions scatter; default: normal.
    #[serde(default, skip_serializing_if = "AngleDistribution::is_normal")]
    pub angle_distribution: AngleDistribution,
    /// Fisher: concentration of the poles, at least 5 and at most 1e6; 20 scatters widely, 200 little.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fisher_k: Option<f64>,
    /// How spacings scatter; default: normal.
    #[serde(default, skip_serializing_if = "Distribution::is_normal")]
    pub spacing_distribution: Distribution,
    /// How trace lengths scatter; default: normal.
    #[serde(default, skip_serializing_if = "Distribution::is_normal")]
    pub trace_length_distribution: Distribution,
    /// Share of each line that is joint, above 0 and at most 1. With `trace_length` it gives `gap`, with `gap` it gives
    /// `trace_length`; not all three.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub persistence: Option<f64>,
    /// A point (m) of the region's box through which one of the lines passes; default: chance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub origin: Option<[f64; 2]>,
    /// Name of a set before this one, or of a joint law: traces end where they meet one of that set or of that law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ends_on: Option<String>,
    /// Joint law, by name, of the rock bridges between traces on one line; default: the rock there is elastic and never
    /// breaks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bridge_law: Option<String>,
    /// Angle (degrees) of the mean pole out of the section, which follows from `dip_direction_deg`.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[cfg_attr(feature = "schema", schemars(skip))]
    pub out_of_section_deg: f64,
}

impl JointSet {
    /// Direction of the traces, counter-clockwise from the x axis (rad), once the case is expanded.
    pub fn angle(&self) -> f64 {
        self.angle_deg.unwrap_or_default().to_radians()
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// A construction joint: a line that blasting or a saw will part, glued until then.
///
/// Its joints are of the law `cut`, which the case gets with the first cut: friction 35°, cohesion and tensile strength
/// 1 GPa, none of both once it has broken. A case that has a law of this name keeps its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Cut {
    /// At least two points (m).
    pub points: PointList,
}

/// A rock bridge that can break: a line of rock that a joint law with the strength of the rock holds together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Bridge {
    /// At least two points (m).
    pub points: PointList,
    /// Joint law by name, with the strength of the rock.
    pub law: String,
}

/// Shape of the cells of a tessellation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum CellShape {
    /// Polygons of Voronoi: they interlock, so that rock of them is stronger than its joints.
    Voronoi,
    /// Triangles between the centres of such polygons: they shear easily along their sides.
    Trigon,
}

/// A region that joints divide into cells of one size without a direction: rock as bonded blocks. The same seed gives
/// the same cells, wherever region and outline end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Tessellation {
    /// Shape of the cells.
    pub shape: CellShape,
    /// Mean distance (m) between the centres of neighbouring polygons, mean side of the triangles.
    pub size: f64,
    /// Polygon (m) that the cells fill; its border in the rock is joint as well.
    pub region: PointList,
    /// Seed of the generator.
    #[serde(default)]
    pub seed: u64,
    /// Joint law by name, with the strength of the rock; default `domain.joint_law`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<String>,
}

/// A region in which joints take another law, such as that of weathered rock; joints are divided at its border.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LawRegion {
    /// Polygon (m).
    pub region: PointList,
    /// Law of the joints that change, by name; default: all laws but `cut`.
    #[serde(default)]
    pub from: Option<String>,
    /// Law that they take in the region, by name.
    pub to: String,
}

impl Case {
    /// Word for a joint set in messages, tables and pictures: its name, or its key.
    pub fn joint_set_name(&self, set: usize) -> String {
        let name = self.joint_sets.get(set).and_then(|set| set.name.clone());
        name.unwrap_or_else(|| format!("joint_set[{set}]"))
    }

    /// Word for a bolt in messages, tables and pictures: its name, or its key.
    pub fn bolt_name(&self, bolt: usize) -> String {
        let name = self.bolts.get(bolt).and_then(|bolt| bolt.name.clone());
        name.unwrap_or_else(|| format!("bolt[{bolt}]"))
    }
}
