//! Joint sets of a case, construction joints, and regions whose joints have another law.

use super::{Case, PointList};
use crate::keys::shared::{DEVIATION, DIRECTION, LENGTH, PLACE, SEED, SHARE};
use crate::keys::unit::{DEGREE, NUMBER};
use crate::keys::{Range, Rule, keys, words};

/// Remedy for a dip.
pub(crate) const DIP: &str = "a dip is measured down from the horizontal; `dips` or `dip_direction_deg` gives the side";
/// Standard deviations of directions: three of the greatest one are a right angle.
const SCATTER: Rule = Range::from(0.0)
    .to(30.0)
    .of(DEGREE)
    .hint("0 for parallel joints; directions that scatter more are more than one set")
    .label("Scatter of angle")
    .none_at_zero();
/// Distances of joints.
const SPACING: Rule = LENGTH.usual([0.02, 500.0], "joints stand 0.1 to 20 m apart");

keys! {
    /// Where the section lies.
    #[derive(Copy)]
    pub struct Section {
        /// Azimuth of the x axis, clockwise from north (degrees).
        pub azimuth_deg: f64 => DIRECTION.hint("clockwise from north").example(90.0).label("Azimuth of the x axis"),
    }
}

words! {
    /// A side of the section.
    pub enum Side {
        /// Towards smaller x.
        Left = "left",
        /// Towards greater x.
        Right = "right",
    }

    /// How spacings or trace lengths scatter about their mean.
    #[derive(Default)]
    pub enum Distribution {
        /// Normal by mean and standard deviation, cut off at 0.1 and 1.9 of the mean.
        #[default]
        Normal = "normal",
        /// Lognormal by its own mean and standard deviation, not those of the logarithm.
        Lognormal = "lognormal",
        /// Negative exponential by the mean, which is its standard deviation too.
        Exponential = "exponential",
        /// Uniform by mean and standard deviation: between mean − √3·sd and mean + √3·sd.
        Uniform = "uniform",
    }
}

impl Distribution {
    /// Whether it is the default.
    pub fn is_normal(&self) -> bool {
        *self == Self::Normal
    }
}

words! {
    /// How directions scatter about their mean.
    #[derive(Default)]
    pub enum AngleDistribution {
        /// Normal by the standard deviation `angle_sd_deg`, cut off at three of them.
        #[default]
        Normal = "normal",
        /// Uniform by the standard deviation: up to √3·sd to both sides.
        Uniform = "uniform",
        /// Poles by Fisher's distribution in space with the concentration `fisher_k`; the traces are where the joints
        /// meet the section, at most 60° from the mean.
        Fisher = "fisher",
    }
}

impl AngleDistribution {
    /// Whether it is the default.
    pub fn is_normal(&self) -> bool {
        *self == Self::Normal
    }
}

keys! {
    /// Straight parallel joints generated from statistics; the same seed gives the same joints.
    pub struct JointSet {
        /// Direction of the traces, counter-clockwise from the x axis (degrees); this, or `dip_deg` with `dips` or
        /// `dip_direction_deg`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub angle_deg: Option<f64> => DIRECTION.hint("counter-clockwise from the x axis").label("Angle from x axis"),
        /// Dip below the horizontal (degrees), with `dips` or `dip_direction_deg`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub dip_deg: Option<f64> => DIRECTION.in_range(Range::from(0.0).to(90.0)).hint(DIP).label("Dip"),
        /// Side towards which traces with `dip_deg` descend.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub dips: Option<Side>,
        /// Azimuth (degrees, clockwise from north) towards which joints with `dip_deg` descend: the section, by
        /// `section.azimuth_deg`, cuts them at their apparent dip. `spacing` is then the distance normal to the joints
        /// in space, and greater in the section.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub dip_direction_deg: Option<f64> => DIRECTION.hint("clockwise from north").label("Dip direction"),
        /// Standard deviation of the direction (degrees), the same as `angle_sd_deg`.
        #[serde(default)]
        pub dip_sd_deg: f64 => SCATTER,
        /// Mean distance between neighbouring lines, normal to them (m).
        pub spacing: f64 => SPACING.hint("the mean distance between joints").label("Spacing"),
        /// Standard deviation of the spacing (m).
        #[serde(default)]
        pub spacing_sd: f64 => DEVIATION.hint("0 for equal distances").label("Scatter of spacing").none_at_zero(),
        /// Length of a trace (m); default: through the whole region.
        pub trace_length: Option<f64> =>
            LENGTH.hint("leave it out for joints through the whole region")
                .usual([0.05, 5e3], "traces have 0.5 to 200 m").label("Trace length"),
        /// Standard deviation of the trace length (m).
        #[serde(default)]
        pub trace_length_sd: f64 => DEVIATION.hint("0 for equal lengths"),
        /// Rock bridge between traces on one line (m).
        #[serde(default)]
        pub gap: f64 => DEVIATION.hint("0 for no rock bridges").usual([5e-3, 500.0], "rock bridges have 0.1 to 10 m"),
        /// Seed of the generator.
        #[serde(default)]
        pub seed: u64 => SEED.label("Seed"),
        /// Polygon (m) to which the traces are clipped; default: the bounding box of the outline.
        pub region: Option<PointList> => PLACE,
        /// Joint law by name; default `domain.joint_law`.
        pub law: Option<String>,
        /// Name, for sets that end on this one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub name: Option<String>,
        /// Standard deviation of the direction of each trace (degrees); default 0.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub angle_sd_deg: Option<f64> => SCATTER,
        /// How directions scatter; default: normal.
        #[serde(default, skip_serializing_if = "AngleDistribution::is_normal")]
        pub angle_distribution: AngleDistribution,
        /// Fisher: concentration of the poles; 20 scatters widely, 200 little.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub fisher_k: Option<f64> => Range::from(5.0).to(1e6).of(NUMBER).hint("20 scatters widely, 200 little"),
        /// How spacings scatter; default: normal.
        #[serde(default, skip_serializing_if = "Distribution::is_normal")]
        pub spacing_distribution: Distribution,
        /// How trace lengths scatter; default: normal.
        #[serde(default, skip_serializing_if = "Distribution::is_normal")]
        pub trace_length_distribution: Distribution,
        /// Share of each line that is joint. With `trace_length` it gives `gap`, with `gap` it gives `trace_length`;
        /// not all three.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub persistence: Option<f64> => SHARE.hint("the share of each line that is joint").label("Persistence"),
        /// A point (m) of the region's box through which one of the lines passes; default: chance.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub origin: Option<[f64; 2]> => PLACE,
        /// Name of a set before this one, or of a joint law: traces end where they meet one of that set or of that law.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub ends_on: Option<String>,
        /// Joint law, by name, of the rock bridges between traces on one line; default: the rock there is elastic and
        /// never breaks.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub bridge_law: Option<String>,
        /// Angle (degrees) of the mean pole out of the section, which follows from `dip_direction_deg`.
        #[serde(default, skip_serializing_if = "is_zero")]
        #[cfg_attr(feature = "schema", schemars(skip))]
        pub out_of_section_deg: f64,
    }
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

keys! {
    /// A construction joint: a line that blasting or a saw will part, glued until then.
    ///
    /// Its joints are of the law `cut`, which the case gets with the first cut: friction 35°, cohesion and tensile
    /// strength 1 GPa, none of both once it has broken. A case that has a law of this name keeps its own.
    pub struct Cut {
        /// At least two points (m).
        pub points: PointList => PLACE,
    }
}

keys! {
    /// A rock bridge that can break: a line of rock that a joint law with the strength of the rock holds together.
    pub struct Bridge {
        /// At least two points (m).
        pub points: PointList => PLACE,
        /// Joint law by name, with the strength of the rock.
        pub law: String,
    }
}

words! {
    /// Shape of the cells of a tessellation.
    pub enum CellShape {
        /// Polygons of Voronoi: they interlock, so that rock of them is stronger than its joints.
        Voronoi = "voronoi",
        /// Triangles between the centres of such polygons: they shear easily along their sides.
        Trigon = "trigon",
    }
}

keys! {
    /// A region that joints divide into cells of one size without a direction: rock as bonded blocks. The same seed
    /// gives the same cells, wherever region and outline end.
    pub struct Tessellation {
        /// Shape of the cells.
        pub shape: CellShape,
        /// Mean distance (m) between the centres of neighbouring polygons, mean side of the triangles.
        pub size: f64 => SPACING.hint("the mean distance between centres of cells"),
        /// Polygon (m) that the cells fill; its border in the rock is joint as well.
        pub region: PointList => PLACE,
        /// Seed of the generator.
        #[serde(default)]
        pub seed: u64 => SEED,
        /// Joint law by name, with the strength of the rock; default `domain.joint_law`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub law: Option<String>,
    }
}

keys! {
    /// A region in which joints take another law, such as that of weathered rock; joints are divided at its border.
    pub struct LawRegion {
        /// Polygon (m).
        pub region: PointList => PLACE,
        /// Law of the joints that change, by name; default: all laws but `cut`.
        pub from: Option<String>,
        /// Law that they take in the region, by name.
        pub to: String,
    }
}

/// Joints that have a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NamedJoint {
    /// A joint of the case, by its place.
    One(usize),
    /// All joints of a set, by its place.
    Set(usize),
}

impl Case {
    /// Word for a joint set in messages, tables and pictures: its name, or its key.
    pub fn joint_set_name(&self, set: usize) -> String {
        let name = self.joint_sets.get(set).and_then(|set| set.name.clone());
        name.unwrap_or_else(|| format!("joint_set[{set}]"))
    }

    /// The joints that a name means: that of a set, or the place of one, as `joint[2]`.
    pub fn joint_by_name(&self, name: &str) -> Option<NamedJoint> {
        let set = (0..self.joint_sets.len()).find(|&set| self.joint_set_name(set) == name);
        let number = || name.strip_prefix("joint[")?.strip_suffix(']')?.parse::<usize>().ok();
        let joint = || number().filter(|&joint| joint < self.joints.len());
        set.map(NamedJoint::Set).or_else(|| joint().map(NamedJoint::One))
    }

    /// Word for a bolt in messages, tables and pictures: its name, or its key.
    pub fn bolt_name(&self, bolt: usize) -> String {
        let name = self.bolts.get(bolt).and_then(|bolt| bolt.name.clone());
        name.unwrap_or_else(|| format!("bolt[{bolt}]"))
    }
}
