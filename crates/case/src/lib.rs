//! The case: all that a user writes about one model. Plain data with SI units; angles in degrees only under keys that
//! end in `_deg`. Reading it from a file is the work of `io`; building a model from it that of `assemble`.

mod bolt;
mod drawing;
mod expand;
mod fingerprint;
mod ground;
mod ground_motion;
mod hoek_brown;
mod in_situ;
mod joint_set;
pub mod key;
pub mod limits;
mod orientation;
pub mod philox;
mod pictures;
pub mod plausible;
mod ponding;
mod random;
pub mod record;
mod validate;

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

pub use bolt::{Anchorage, Bolt, BoltPattern, Support};
pub use drawing::{CURVE_TOLERANCE, Flip, Layer, LayerUse, Transform};
pub use expand::{CUT_LAW, Expanded};
pub use ground::{Axis, BaseMotion, FreeField, Quiet, RecordKeys};
pub use ground_motion::GroundMotion;
pub use hoek_brown::{Envelope, Equivalent, HoekBrown, Tangent};
pub use in_situ::InSitu;
pub use joint_set::{
    AngleDistribution, Bridge, CellShape, Cut, Distribution, JointSet, LawRegion, Section, Side, Tessellation,
};
pub use orientation::{AZIMUTH, Orientation, Orientations, dip_in_section, trace_angle};
pub use pictures::{PictureKind, Pictures};
pub use ponding::{Pond, PondPart};
pub use random::{Ensemble, EnsembleOutput, RandomCorrelation, RandomDistribution, RandomOf, RandomVariable, Sampling};
pub use record::BaseMotionKind;
pub use validate::Invalid;

/// A closed or open list of points (m).
pub type PointList = Vec<[f64; 2]>;
/// Pairs of time (s) and factor; linear between, constant beyond both ends.
pub type TimeTable = Vec<[f64; 2]>;

/// One model, its loads, stages and outputs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Description of the model.
    pub title: String,
    /// Conversions and omissions of the reader of a geometry file; notes of the built model begin with it.
    #[serde(skip)]
    pub reader_notes: Vec<String>,
    /// Geometry file with the unit of its coordinates and what was made of it.
    #[serde(skip)]
    pub drawing_unit: Option<String>,
    /// Rock outline and joint traces from files.
    pub domain: Domain,
    /// Layers of the DXF drawing by name, in any letter case; `"*"` is every other layer.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub layers: BTreeMap<String, Layer>,
    /// How the coordinates of `domain.geometry_file` become metres of the section.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transform: Option<Transform>,
    /// The regular triangular mesh of mathematical covers.
    pub mesh: Mesh,
    /// Joint traces.
    #[serde(default, rename = "joint")]
    pub joints: Vec<JointTrace>,
    /// Generated joint sets.
    #[serde(default, rename = "joint_set")]
    pub joint_sets: Vec<JointSet>,
    /// Regions of cells that joints part.
    #[serde(default, rename = "tessellation", skip_serializing_if = "Vec::is_empty")]
    pub tessellations: Vec<Tessellation>,
    /// Construction joints, along which later stages part the rock.
    #[serde(default, rename = "cut", skip_serializing_if = "Vec::is_empty")]
    pub cuts: Vec<Cut>,
    /// Where the section lies: for joint sets by dip direction, pictures and the report.
    // Not written: once joint sets have their angles, the model does not depend on it.
    #[serde(default, skip_serializing)]
    pub section: Option<Section>,
    /// Rocks by name.
    #[serde(rename = "rock")]
    pub rocks: BTreeMap<String, Rock>,
    /// Joint laws by name.
    #[serde(default, rename = "joint_law")]
    pub joint_laws: BTreeMap<String, JointLaw>,
    /// Regions whose joints have another law, in order.
    #[serde(default, rename = "law_region", skip_serializing_if = "Vec::is_empty")]
    pub law_regions: Vec<LawRegion>,
    /// Rock bridges that can break, drawn by hand.
    #[serde(default, rename = "bridge", skip_serializing_if = "Vec::is_empty")]
    pub bridges: Vec<Bridge>,
    /// Acceleration of gravity.
    #[serde(default)]
    pub gravity: Gravity,
    /// Fixities.
    #[serde(default, rename = "fix")]
    pub fixes: Vec<Fix>,
    /// Loads.
    #[serde(default, rename = "load")]
    pub loads: Vec<Load>,
    /// Motion of the base.
    #[serde(default, rename = "base_motion")]
    pub base_motions: Vec<BaseMotion>,
    /// Boundaries that let waves leave.
    #[serde(default, rename = "quiet")]
    pub quiets: Vec<Quiet>,
    /// Free-field columns beside the model.
    #[serde(default, rename = "free_field")]
    pub free_fields: Vec<FreeField>,
    /// Rock bolts.
    #[serde(default, rename = "bolt")]
    pub bolts: Vec<Bolt>,
    /// Rows of equal rock bolts with their heads on the face.
    #[serde(default, rename = "bolt_pattern", skip_serializing_if = "Vec::is_empty")]
    pub bolt_patterns: Vec<BoltPattern>,
    /// Velocities at the start.
    #[serde(default, rename = "initial_velocity")]
    pub initial_velocities: Vec<InitialVelocity>,
    /// Stress before the first stage.
    #[serde(default)]
    pub in_situ: Option<InSitu>,
    /// Water with a level surface.
    #[serde(default)]
    pub water: Option<Water>,
    /// Named places where hosts exchange values with the model.
    #[serde(default, rename = "port")]
    pub ports: Vec<Port>,
    /// Notes for an FMU of the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fmu: Option<FmuNotes>,
    /// Stages in order.
    #[serde(rename = "stage")]
    pub stages: Vec<Stage>,
    /// Points whose motion goes into the history.
    #[serde(default, rename = "monitor")]
    pub monitors: Vec<Monitor>,
    /// Files to write and their intervals.
    #[serde(default)]
    pub output: Output,
    /// Numerical choices.
    #[serde(default)]
    pub solver: Solver,
    // Not written, so that they are not part of the fingerprint.
    /// Random values of `enmm sample`.
    #[serde(default, skip_serializing)]
    pub random: Vec<RandomVariable>,
    /// Correlations of random values.
    #[serde(default, skip_serializing, rename = "random_correlation")]
    pub random_correlations: Vec<RandomCorrelation>,
    /// The samples of `enmm sample`.
    #[serde(default, skip_serializing)]
    pub ensemble: Ensemble,
    /// Cover of the report of `enmm report`.
    #[serde(default, skip_serializing)]
    pub report: ReportNotes,
}

/// Project that the report of `enmm report` names; nothing of this acts on the model, or on what is stored of it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ReportNotes {
    /// Name of the project.
    #[serde(default)]
    pub project: Option<String>,
    /// Who made the analysis: name and organisation.
    #[serde(default)]
    pub author: Option<String>,
    /// Who ordered it.
    #[serde(default)]
    pub client: Option<String>,
    /// Date of the report, as it is to be printed.
    #[serde(default)]
    pub date: Option<String>,
    /// Number of the report or of its revision.
    #[serde(default)]
    pub number: Option<String>,
    /// Text below these lines.
    #[serde(default)]
    pub remarks: Option<String>,
}

impl ReportNotes {
    /// The keys and their values.
    pub fn entries(&self) -> [(&'static str, Option<&str>); 6] {
        let Self { project, author, client, date, number, remarks } = self;
        [
            ("project", project.as_deref()),
            ("author", author.as_deref()),
            ("client", client.as_deref()),
            ("date", date.as_deref()),
            ("number", number.as_deref()),
            ("remarks", remarks.as_deref()),
        ]
    }
}

/// Whose the case is, as the description of an FMU says it; nothing of this acts on the model.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FmuNotes {
    /// Who wrote the case: name and organisation.
    #[serde(default)]
    pub author: Option<String>,
    /// Notice of copyright of the case.
    #[serde(default)]
    pub copyright: Option<String>,
    /// Terms of use of the case.
    #[serde(default)]
    pub license: Option<String>,
}

/// Rock outline, holes, islands, and a file that may hold them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Outer loop of the rock (m), either sense; this or `geometry_file` with an outline.
    #[serde(default)]
    pub outline: PointList,
    /// Loops cut out of the outline (m).
    #[serde(default)]
    pub holes: Vec<PointList>,
    /// Loops of rock inside holes or beside the outline (m).
    #[serde(default)]
    pub islands: Vec<PointList>,
    /// JSON (`outline`, `joints`), GeoJSON, DXF, WKT or CSV, relative to the case file.
    #[serde(default)]
    pub geometry_file: Option<PathBuf>,
    /// Greatest distance (m) of arcs and splines of a DXF drawing from the polylines that they become; default 0.02
    /// mesh sizes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve_tolerance: Option<f64>,
    /// Law of traces that name none.
    #[serde(default)]
    pub joint_law: Option<String>,
    /// Distance (m) within which points and edges become one; default 1e-6 of the bounding-box diagonal.
    #[serde(default)]
    pub snap_tolerance: Option<f64>,
    /// Distance (m) within which an end of a trace that almost meets the outline or another trace is extended or
    /// trimmed to it; default 0.0023 of the bounding-box diagonal, 0 keeps what is drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extend_ends: Option<f64>,
    /// Distance (m) within which an end that stops in the rock before the outline or another trace is named in a note,
    /// tried joined beside the bounds of `fos` and `bound`, and bridged by `bridge_law`; default 0.02 of the
    /// bounding-box diagonal, at least `extend_ends`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near_ends: Option<f64>,
    /// Joint law of rock bridges between ends that stop in the rock, nearer than `near_ends` to the outline or
    /// another trace, and that line; default: the rock there is elastic and never breaks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bridge_law: Option<String>,
}

/// Equilateral lattice: node(i, j) = origin + i·a1 + j·a2, a1 = size·(cos, sin)(angle), a2 = a1 turned by +60°.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Side of a triangle (m).
    pub size: f64,
    /// Direction of a1 from the x axis (degrees).
    #[serde(default)]
    pub angle_deg: f64,
    /// Node (0, 0) (m).
    #[serde(default)]
    pub origin: [f64; 2],
    /// Area (m²) below which a block joins the neighbour across its shortest joint; default (size/20)², 0
    /// keeps all blocks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub least_block: Option<f64>,
}

/// Side over the mesh size of the square that has the default least area of a block.
const LEAST_RATIO: f64 = 0.05;

impl Mesh {
    /// Area (m²) below which a block joins a neighbour.
    pub fn least_block(&self) -> f64 {
        self.least_block.unwrap_or((LEAST_RATIO * self.size).powi(2))
    }
}

/// One joint: a polyline in the reference configuration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct JointTrace {
    /// At least two points (m).
    pub points: PointList,
    /// Joint law by name; default `domain.joint_law`.
    #[serde(default)]
    pub law: Option<String>,
}

/// Plane strain or plane stress.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Plane {
    /// No strain out of the plane.
    #[default]
    Strain,
    /// No stress out of the plane.
    Stress,
}

/// An elastic rock; with `friction_deg` or `cohesion` it yields by Mohr–Coulomb, with `hoek_brown` by Hoek–Brown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Rock {
    /// Density (kg/m³).
    #[cfg_attr(feature = "schema", schemars(example = 2700.0))]
    pub density: f64,
    /// Young's modulus (Pa).
    #[cfg_attr(feature = "schema", schemars(example = 10e9))]
    pub young: f64,
    /// Poisson's ratio.
    #[cfg_attr(feature = "schema", schemars(example = 0.25))]
    pub poisson: f64,
    /// Plane strain or plane stress.
    #[serde(default)]
    pub plane: Plane,
    /// Friction angle (degrees); with neither this nor `cohesion` nor `hoek_brown` the rock never yields.
    #[serde(default)]
    pub friction_deg: Option<f64>,
    /// Cohesion (Pa).
    #[serde(default)]
    pub cohesion: Option<f64>,
    /// Generalized Hoek–Brown strength, in place of `friction_deg` and `cohesion`; needs plane strain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hoek_brown: Option<HoekBrown>,
    /// Dilation angle (degrees), at most `friction_deg` (associated flow); default: 0, at which it keeps its volume.
    #[serde(default)]
    pub dilation_deg: Option<f64>,
    /// Tensile strength (Pa); default: the apex of the Mohr–Coulomb surface, or s·σci/mb of Hoek–Brown.
    #[serde(default)]
    pub tension: Option<f64>,
    /// Polygon (m): elements whose centroid lies inside are of this rock.
    #[serde(default)]
    pub region: Option<PointList>,
    /// Points (m): the blocks that hold them are of this rock.
    #[serde(default)]
    pub blocks: PointList,
}

impl Case {
    /// Whether any rock has a strength that can be exceeded.
    pub fn yields(&self) -> bool {
        self.rocks.values().any(Rock::yields)
    }

    /// Young's modulus over the weight γH of the model (γ of the rock, H the height of the outline) of the rock that
    /// has least of it and yields; none without such rock or without gravity.
    pub fn least_stiffness(&self) -> Option<f64> {
        let [bottom, top] = self.heights();
        let weight = libm::hypot(self.gravity.x, self.gravity.y) * (top - bottom);
        let yielding = self.rocks.values().filter(|rock| rock.yields());
        let least = yielding.map(|rock| rock.young / (rock.density * weight)).fold(f64::INFINITY, f64::min);
        least.is_finite().then_some(least)
    }

    /// The lowest and the highest y of the outline (m).
    fn heights(&self) -> [f64; 2] {
        let heights = || self.domain.outline.iter().map(|point| point[1]);
        [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Whether the rock is whole: no joint cuts it, and no bolt holds it.
    pub fn is_whole(&self) -> bool {
        self.joints.is_empty() && self.joint_sets.is_empty() && self.bridges.is_empty() && self.bolts.is_empty()
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
        let has_friction = self.friction_deg.is_some_and(|angle| angle > 0.0) || self.hoek_brown.is_some();
        has_friction && self.plane == Plane::Strain
    }

    /// Whether the rock swells when it yields.
    pub fn dilates(&self) -> bool {
        self.dilation_deg.unwrap_or_default() > 0.0 || self.hoek_brown.is_some_and(|mass| mass.associated)
    }
}

/// Kind of a joint law.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum JointLawKind {
    /// |T| ≤ N·tan φ + c·l with tension cut-off, peak and residual values, dilation.
    #[default]
    MohrCoulomb,
    /// |τ| ≤ σ·tan(φr + JRC·log10(JCS/σ)) with φr = `friction_deg`, and hyperbolic closure.
    BartonBandis,
}

/// Strength and stiffness of a joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct JointLaw {
    /// Kind of law.
    #[serde(default)]
    pub kind: JointLawKind,
    /// Normal stiffness (Pa/m); default: the solver's contact stiffness.
    #[serde(default)]
    pub normal_stiffness: Option<f64>,
    /// Shear stiffness (Pa/m); default: the solver's contact stiffness.
    #[serde(default)]
    pub shear_stiffness: Option<f64>,
    /// Friction angle (degrees); of Barton–Bandis joints the residual angle φr.
    #[cfg_attr(feature = "schema", schemars(example = 30.0))]
    pub friction_deg: f64,
    /// Cohesion (Pa).
    #[serde(default)]
    pub cohesion: f64,
    /// Tensile strength (Pa).
    #[serde(default)]
    pub tension: f64,
    /// Friction angle after failure (degrees); default: `friction_deg`.
    #[serde(default)]
    pub residual_friction_deg: Option<f64>,
    /// Cohesion after failure (Pa); default: `cohesion`.
    #[serde(default)]
    pub residual_cohesion: Option<f64>,
    /// Tensile strength after failure (Pa).
    #[serde(default)]
    pub residual_tension: f64,
    /// Dilation angle while slipping (degrees).
    #[serde(default)]
    pub dilation_deg: f64,
    /// Slip (m) to either side at which dilation ends; default: 0.05, ten times the slip at which a joint of 1 m has
    /// its peak strength (Barton 1982). The faces come down again on the way back.
    #[serde(default)]
    pub dilation_slip: Option<f64>,
    /// Joint roughness coefficient (Barton–Bandis).
    #[serde(default)]
    pub jrc: Option<f64>,
    /// Joint wall compressive strength (Pa; Barton–Bandis).
    #[serde(default)]
    pub jcs: Option<f64>,
    /// Greatest closure (m; Barton–Bandis): the normal stress is kn·v/(1 − v/this) at closure v; default: linear.
    #[serde(default)]
    pub closure_max: Option<f64>,
    /// Pressure (Pa) over its length that a contact carries before the rock crushes; default: `jcs`, and without one
    /// the rock does not crush.
    #[serde(default)]
    pub crush: Option<f64>,
    /// Energy of fracture in tension (J/m²): the tensile strength falls with the opening until this much is spent;
    /// default: it is lost at once. Not with `residual_tension`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tension_energy: Option<f64>,
    /// Energy of fracture in shear (J/m²), beyond the heat of residual friction: friction and cohesion fall from their
    /// peak values to the residual ones with the slip until this much is spent; default: they fall at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_energy: Option<f64>,
    /// How rock bridges of this law break: `by section`, as a whole under the tension, shear and bending of their
    /// section, or `by node`, contact by contact; default: by section where the rock is brittle, or its characteristic
    /// length E'·`tension_energy`/`tension`² at most four times the bridge, and rock beside it half as deep as it is
    /// long.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub breaks: Option<Breaks>,
}

/// How the rock bridges of a joint law break.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Breaks {
    /// As a whole, under the tension, shear and bending of their section.
    #[serde(rename = "by section")]
    BySection,
    /// Contact by contact.
    #[serde(rename = "by node")]
    ByNode,
}

impl JointLaw {
    /// Whether it loses its peak strength step by step, with an energy of fracture.
    pub fn softens(&self) -> bool {
        self.tension_energy.is_some() || self.shear_energy.is_some()
    }

    /// A Mohr–Coulomb joint with friction (degrees) alone.
    pub fn frictional(friction_deg: f64) -> Self {
        Self {
            kind: JointLawKind::MohrCoulomb,
            normal_stiffness: None,
            shear_stiffness: None,
            friction_deg,
            cohesion: 0.0,
            tension: 0.0,
            residual_friction_deg: None,
            residual_cohesion: None,
            residual_tension: 0.0,
            dilation_deg: 0.0,
            dilation_slip: None,
            jrc: None,
            jcs: None,
            closure_max: None,
            crush: None,
            tension_energy: None,
            shear_energy: None,
            breaks: None,
        }
    }
}

/// Slip (m) at which dilation ends where a law does not say.
pub const DILATION_SLIP: f64 = 0.05;

/// Acceleration of gravity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Gravity {
    /// Horizontal part (m/s²).
    #[serde(default)]
    pub x: f64,
    /// Vertical part (m/s²), up positive.
    #[serde(default = "standard_gravity")]
    pub y: f64,
}

fn standard_gravity() -> f64 {
    -9.81
}

impl Default for Gravity {
    fn default() -> Self {
        Self { x: 0.0, y: standard_gravity() }
    }
}

/// Axes that a fixity holds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Axes {
    /// Horizontal.
    X,
    /// Vertical.
    Y,
    /// Both.
    #[default]
    Xy,
}

/// Holds a part of the rock; exactly one of `point`, `edge`, `box`, `block`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Fix {
    /// Name, for stages that free or fix.
    #[serde(default)]
    pub name: Option<String>,
    /// A material point (m).
    #[serde(default)]
    pub point: Option<[f64; 2]>,
    /// The parts of the rock boundary on this segment (m).
    #[serde(default)]
    pub edge: Option<[[f64; 2]; 2]>,
    /// `[xmin, ymin, xmax, ymax]` (m): the physical covers whose area centroid lies inside.
    #[serde(default, rename = "box")]
    pub region: Option<[f64; 4]>,
    /// The whole block that holds this point (m).
    #[serde(default)]
    pub block: Option<[f64; 2]>,
    /// Directions that are held.
    #[serde(default)]
    pub axes: Axes,
    /// Support stiffness of points (N/m per metre) and edges (Pa/m); default: 1000 and 100 times the contact's.
    #[serde(default)]
    pub stiffness: Option<f64>,
    /// Whether it holds from the start.
    #[serde(default = "yes")]
    pub active: bool,
}

fn yes() -> bool {
    true
}

/// Target of a load.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum LoadKind {
    /// `force` (N/m) at the material point `point`.
    Point,
    /// `traction` (Pa, global axes) on the boundary parts along `edge`.
    Traction,
    /// `pressure` (Pa, pushing into the rock) on the boundary parts along `edge`; follows the surface.
    Pressure,
    /// `acceleration` (m/s²) of all rock, added to gravity.
    Body,
    /// `force` (N/m) and `moment` (N·m/m, counter-clockwise) about the centroid of the block that holds `point`.
    Block,
    /// Fluid `pressure` (Pa) on both faces of the joints along `edge`, linear to `pressure_end` at its second point.
    Joint,
}

/// A load with an optional time table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Name.
    #[serde(default)]
    pub name: Option<String>,
    /// Target of the load.
    pub kind: LoadKind,
    /// Material point (m), for `point` and `block`.
    #[serde(default)]
    pub point: Option<[f64; 2]>,
    /// Segment (m), for `traction`, `pressure` and `joint`.
    #[serde(default)]
    pub edge: Option<[[f64; 2]; 2]>,
    /// Force (N per metre of depth).
    #[serde(default)]
    pub force: Option<[f64; 2]>,
    /// Moment (N·m per metre of depth), counter-clockwise.
    #[serde(default)]
    pub moment: Option<f64>,
    /// Traction (Pa) in global axes.
    #[serde(default)]
    pub traction: Option<[f64; 2]>,
    /// Pressure (Pa), pushing into the rock.
    #[serde(default)]
    pub pressure: Option<f64>,
    /// Pressure (Pa) at the second point of `edge`, for `joint`; default: `pressure`.
    #[serde(default)]
    pub pressure_end: Option<f64>,
    /// Acceleration (m/s²).
    #[serde(default)]
    pub acceleration: Option<[f64; 2]>,
    /// Factor over time; default 1 always.
    #[serde(default)]
    pub table: Option<TimeTable>,
}

/// Velocity at the start of the first stage.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct InitialVelocity {
    /// The block that holds this point (m); default: all blocks.
    #[serde(default)]
    pub block: Option<[f64; 2]>,
    /// Velocity of the centroid (m/s).
    #[serde(default)]
    pub velocity: [f64; 2],
    /// Angular velocity about the centroid (rad/s), counter-clockwise.
    #[serde(default)]
    pub angular_velocity: f64,
}

/// Water with a level or a sloping surface: hydrostatic pressure on the faces that it reaches, at their current places.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Height y of the surface at the start (m); hosts may move it. This or `table`.
    #[serde(default)]
    pub level: Option<f64>,
    /// Surface as points (m) from left to right, level beyond both ends; hosts shift it by what they move the level,
    /// which starts as the height of its highest point.
    #[serde(default)]
    pub table: Option<PointList>,
    /// Density (kg/m³).
    #[serde(default = "water_density")]
    pub density: f64,
    /// Whether joints below the level are full: pressure on both of their faces.
    #[serde(default = "yes")]
    pub joints: bool,
    /// Whether rock below the level that yields with friction has pore pressure, so that its effective stress decides.
    #[serde(default = "yes")]
    pub rock: bool,
    /// Segments (m) of the outer boundary that the water reaches; default: all that no `[[fix]]` edge holds.
    #[serde(default)]
    pub faces: Option<Vec<[[f64; 2]; 2]>>,
}

/// A surface of the water that a stage brings.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct WaterSurface {
    /// Height y of the surface (m). This or `table`.
    #[serde(default)]
    pub level: Option<f64>,
    /// Surface as points (m) from left to right, level beyond both ends.
    #[serde(default)]
    pub table: Option<PointList>,
}

impl WaterSurface {
    /// Height of its highest point (m).
    pub fn highest(&self) -> f64 {
        let highest = || self.table.iter().flatten().map(|point| point[1]).fold(f64::NEG_INFINITY, f64::max);
        self.level.unwrap_or_else(highest)
    }
}

impl Water {
    /// Water without a surface yet, all else as a case has it that names nothing.
    pub fn still() -> Self {
        Self { level: None, table: None, density: water_density(), joints: true, rock: true, faces: None }
    }

    /// The surface at the start.
    pub fn surface(&self) -> WaterSurface {
        WaterSurface { level: self.level, table: self.table.clone() }
    }

    /// Height of the surface at the start (m): `level`, or the highest point of `table`.
    pub fn start_level(&self) -> f64 {
        self.surface().highest()
    }
}

fn water_density() -> f64 {
    1000.0
}

/// A named place where hosts exchange values with the model; exactly one of `block`, `boundary`, `joint`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Port {
    /// Name: letters, digits and underscores.
    pub name: String,
    /// The block that holds this point (m): force and moment in, motion and contact force out.
    #[serde(default)]
    pub block: Option<[f64; 2]>,
    /// The parts of the outer boundary on this segment (m): traction and pressure in, motion and stress out.
    #[serde(default)]
    pub boundary: Option<[[f64; 2]; 2]>,
    /// The joint faces on this segment (m): fluid pressure in, contact forces and slip out.
    #[serde(default)]
    pub joint: Option<[[f64; 2]; 2]>,
    /// Force (N per metre of depth) on the block from the start until a host sets another.
    #[serde(default)]
    pub force: [f64; 2],
    /// Moment (N·m per metre of depth, counter-clockwise) on the block from the start.
    #[serde(default)]
    pub moment: f64,
    /// Traction (Pa, global axes) on the boundary from the start.
    #[serde(default)]
    pub traction: [f64; 2],
    /// Pressure (Pa) on the boundary, or in the joints, from the start.
    #[serde(default)]
    pub pressure: f64,
}

/// How a stage treats time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum StageKind {
    /// Damped to equilibrium; time is a path, not physics.
    Static,
    /// True motion.
    Dynamic,
}

/// One stage: changes at its start, then motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Name.
    pub name: String,
    /// Static or dynamic.
    pub kind: StageKind,
    /// Simulated time (s); for a static stage the most that it may take. Must be there, above 0, at most 1e9; a static
    /// stage may give `duration_max` instead.
    #[serde(default)]
    pub duration: f64,
    /// Static: the most simulated time (s) that the stage may take; it ends as soon as the rock is at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration_max: Option<f64>,
    /// Static: unbalanced ratio at which the stage ends.
    #[serde(default)]
    pub convergence: Option<f64>,
    /// Static: time (s) over which gravity and body loads grow from nothing; default: from the model's height and wave
    /// speed in the first stage, 0 in later stages.
    #[serde(default)]
    pub ramp: Option<f64>,
    /// Dynamic: damping ratio ξ of the deformation of each block and of bouncing on joints; default 0.1. Waves that
    /// are to keep their height want 0.
    #[serde(default)]
    pub damping: Option<f64>,
    /// Points (m): the blocks that hold them are removed.
    #[serde(default)]
    pub excavate: PointList,
    /// Polygon (m): the blocks whose reference centroid lies inside are removed.
    #[serde(default)]
    pub excavate_region: Option<PointList>,
    /// Values of joint laws that change.
    #[serde(default, rename = "law")]
    pub law_changes: Vec<LawChange>,
    /// Joints of one law that take another.
    #[serde(default, rename = "switch_law")]
    pub law_switches: Vec<LawSwitch>,
    /// Bolts and bolt patterns by name that are installed.
    #[serde(default)]
    pub install: Vec<String>,
    /// Fixities by name that begin to hold.
    #[serde(default)]
    pub fix: Vec<String>,
    /// Fixities by name that let go.
    #[serde(default)]
    pub free: Vec<String>,
    /// Surface of the water from the start of this stage on, as after a drawdown; not in the first stage, which has
    /// that of `[water]`. What hosts have moved the level by ends with it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub water: Option<WaterSurface>,
}

impl Stage {
    /// A stage that changes nothing, to be put after `others`: its name is `name`, with a prime for each that has it.
    pub fn plain(others: &[Self], name: &str, kind: StageKind, duration: f64) -> Self {
        let mut name = name.to_owned();
        while others.iter().any(|stage| stage.name == name) {
            name.push('\'');
        }
        Self {
            name,
            kind,
            duration,
            duration_max: None,
            convergence: None,
            ramp: None,
            damping: None,
            excavate: Vec::new(),
            excavate_region: None,
            law_changes: Vec::new(),
            law_switches: Vec::new(),
            install: Vec::new(),
            fix: Vec::new(),
            free: Vec::new(),
            water: None,
        }
    }
}

impl Stage {
    /// Damping ratio of a dynamic stage: 0.1 when it names none.
    pub fn damping_ratio(&self) -> f64 {
        self.damping.unwrap_or(0.1)
    }
}

/// New values of one joint law; what is not given stays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LawChange {
    /// Joint law by name.
    pub law: String,
    /// Friction angle (degrees), peak and residual.
    #[serde(default)]
    pub friction_deg: Option<f64>,
    /// Cohesion (Pa), peak and residual.
    #[serde(default)]
    pub cohesion: Option<f64>,
    /// Tensile strength (Pa), peak.
    #[serde(default)]
    pub tension: Option<f64>,
}

/// Joints of law `from` take law `to`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LawSwitch {
    /// Law to replace, by name.
    pub from: String,
    /// Law that takes its place, by name.
    pub to: String,
}

/// A material point whose motion goes into the history.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Monitor {
    /// Name; heads the columns.
    pub name: String,
    /// Place in the reference configuration (m).
    pub point: [f64; 2],
}

/// Files to write and their intervals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Simulated time between frames (s); default: a twentieth of the duration of a dynamic stage; in a static stage,
    /// two to four each time that its number of steps doubles.
    pub frame_interval: Option<f64>,
    /// Simulated time between rows of the history (s); default: a five-hundredth of the duration of a dynamic stage;
    /// in a static stage, 32 to 64 each time that its number of steps doubles.
    pub history_interval: Option<f64>,
    /// Simulated time between checkpoints (s); default: one at the end.
    pub checkpoint_interval: Option<f64>,
    /// Whether to write VTU frames.
    pub frames: bool,
    /// Which pictures to draw: `true` for the usual ones (`model`, `deformed`, `history`, and at the end of each stage
    /// `displacement_contours`, `joints`, `mean_stress_contours`), `false` for none, or a list of exactly those to
    /// draw.
    pub pictures: Pictures,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            frame_interval: None,
            history_interval: None,
            checkpoint_interval: None,
            frames: true,
            pictures: Pictures::Usual(true),
        }
    }
}

/// Time integration.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Lumped mass, leapfrog, open–close iteration.
    #[default]
    Explicit,
    /// Global stiffness, Newmark's rule, open–close iteration with refactorisation: the classical method.
    Implicit,
}

/// What becomes of corner contacts: corners of blocks that meet, in a point or over a short length, a side which rises
/// in front of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum CornerContacts {
    /// They carry force.
    Hold,
    /// They carry none where it would be more than the rock over their length bears.
    Break,
}

/// Newmark's rule of the implicit integrator.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Newmark {
    /// β = ½, γ = 1: constant acceleration as in discontinuous deformation analysis; damps fast motion.
    #[default]
    Constant,
    /// β = ¼, γ = ½: trapezoidal rule; keeps energy. For vibrations of whole rock: sliding blocks come out short by
    /// some percent (0.7 % and 5.3 % were measured).
    Trapezoidal,
}

/// Numerical choices; the defaults are those of `docs/theory.md`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Solver {
    /// Time integration.
    pub integrator: Integrator,
    /// Communication step (s); the internal step is an integer fraction of its tenth. Default: ten internal steps of
    /// the stability limit rounded down to two digits.
    pub communication_step: Option<f64>,
    /// Largest internal step (s); default: the stability limit.
    pub dt_max: Option<f64>,
    /// Share of the stability limit that is used.
    pub dt_safety: f64,
    /// Default stiffness of joints: normal_stiffness = this·(λ+2μ) over 1 m.
    pub contact_stiffness: f64,
    /// Shear over normal contact stiffness.
    pub shear_ratio: f64,
    /// θ of the contact spring at the default step: 1 is backward Euler, more adds a dashpot, which a shorter
    /// step keeps.
    pub contact_theta: f64,
    /// Change of a contact force, relative to the largest, below which the open–close iteration has settled.
    pub contact_tolerance: f64,
    /// Dynamic stages: time (s) by which friction follows the normal force of faces that stay in touch, so that blocks
    /// slide as far on any mesh; 0 is Coulomb friction at once. Default: a shear wave's way through the blocks that
    /// hang together, or 0.02 s if that is less.
    pub friction_delay: Option<f64>,
    /// Factor of safety: whether corner contacts hold or break; default: both are tried where they carry the slope, and
    /// the lower factor is the result.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub corner_contacts: Option<CornerContacts>,
    /// Most sweeps of the open–close iteration in a step.
    pub sweeps_max: u32,
    /// Penetration, relative to the mesh size, at which the run stops as failed.
    pub penetration_limit: f64,
    /// Static stages: how many times lighter than their rock free blocks are as rigid bodies, so that they settle in
    /// fewer steps; weights, and so the state of rest, stay those of the rock, but joints may slip by another path.
    pub mass_scaling: f64,
    /// Implicit: Newmark's rule.
    pub newmark: Newmark,
    /// Implicit: internal step (s); default: 20 times the explicit one. It is an integer fraction of the communication
    /// step's tenth as well.
    pub implicit_step: Option<f64>,
    /// Implicit: most open–close iterations in a step before it is cut to 0.3.
    pub iterations_max: u32,
    /// Implicit: largest displacement in a step, relative to half the height of the model, before it is cut.
    pub displacement_ratio: f64,
    /// Displacement (m) beyond which a block counts as failed; default: the mesh size.
    pub failure_displacement: Option<f64>,
    /// Memory (bytes) that a model may need.
    pub memory_limit: u64,
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            integrator: Integrator::Explicit,
            communication_step: None,
            dt_max: None,
            dt_safety: 0.9,
            contact_stiffness: 0.6,
            shear_ratio: 0.5,
            contact_theta: 4.0,
            contact_tolerance: 1e-2,
            friction_delay: None,
            corner_contacts: None,
            sweeps_max: 100,
            penetration_limit: 0.2,
            mass_scaling: 1.0,
            newmark: Newmark::Constant,
            implicit_step: None,
            iterations_max: 8,
            displacement_ratio: 0.01,
            failure_displacement: None,
            memory_limit: 8 << 30,
        }
    }
}
