//! The case: all that a user writes about one model. Plain data with SI units; angles in degrees only under keys that
//! end in `_deg`. Reading it from a file is the work of `io`; building a model from it that of `assemble`.

mod bolt;
mod domain;
mod drawing;
mod expand;
mod fingerprint;
mod fix;
mod flow;
mod fracture;
mod ground;
mod ground_motion;
mod hoek_brown;
mod in_situ;
mod joint_law;
mod joint_set;
pub mod key;
pub mod keys;
pub mod limits;
mod load;
mod notes;
mod orientation;
mod output;
pub mod philox;
mod pictures;
pub mod plausible;
mod ponding;
mod port;
mod random;
pub mod record;
mod rock;
mod skin;
mod solver;
mod stage;
pub mod text;
mod validate;
mod water;
mod weakness;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use key::{Key, fail};

pub use bolt::{Anchorage, Bolt, BoltPattern, Support};
pub use domain::{Domain, JointTrace, Mesh};
pub use drawing::{CURVE_TOLERANCE, Flip, Layer, LayerUse, Transform};
pub use expand::{CUT_LAW, Expanded};
pub use fix::{Axes, Fix};
pub use flow::{Drain, Flow, FlowInMotion, FlowTime, Head, Rain, StageFlow};
pub use fracture::{Fracture, RockFracture};
pub use ground::{Axis, BaseMotion, FreeField, Quiet, RecordKeys};
pub use ground_motion::GroundMotion;
pub use hoek_brown::{Envelope, Equivalent, HoekBrown, Tangent};
pub use in_situ::InSitu;
pub use joint_law::{Breaks, DILATION_SLIP, JointLaw, JointLawKind};
pub use joint_set::{
    AngleDistribution, Bridge, CellShape, Cut, Distribution, JointSet, LawRegion, NamedJoint, Section, Side,
    Tessellation,
};
pub use key::Invalid;
pub use load::{Gravity, InitialVelocity, Load, LoadKind};
pub use notes::{FmuNotes, ReportNotes};
pub use orientation::{AZIMUTH, Orientation, Orientations, dip_in_section, trace_angle};
pub use output::{JointMonitor, Line, Monitor, Output};
pub use pictures::{PictureKind, Pictures};
pub use ponding::{Pond, PondPart};
pub use port::Port;
pub use random::{Ensemble, EnsembleOutput, RandomCorrelation, RandomDistribution, RandomOf, RandomVariable, Sampling};
pub use record::{BaseMotionKind, STANDARD_GRAVITY};
pub use rock::{Plane, Rock};
pub use skin::Skin;
pub use solver::{CornerContacts, Integrator, Newmark, Solver};
pub use stage::{LawChange, LawSwitch, Stage, StageCut, StageKind};
pub use water::{Water, WaterSurface};
pub use weakness::PlaneOfWeakness;

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
    /// How rock with a table `fracture` breaks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fracture: Option<Fracture>,
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
    /// Shotcrete and mesh along faces.
    #[serde(default, rename = "skin", skip_serializing_if = "Vec::is_empty")]
    pub skins: Vec<Skin>,
    /// Velocities at the start.
    #[serde(default, rename = "initial_velocity")]
    pub initial_velocities: Vec<InitialVelocity>,
    /// Stress before the first stage.
    #[serde(default)]
    pub in_situ: Option<InSitu>,
    /// Water with a level surface.
    #[serde(default)]
    pub water: Option<Water>,
    /// Water that flows in the joints.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow: Option<Flow>,
    /// Heads that are held in joints.
    #[serde(default, rename = "head", skip_serializing_if = "Vec::is_empty")]
    pub heads: Vec<Head>,
    /// Rain that joints take.
    #[serde(default, rename = "rain", skip_serializing_if = "Vec::is_empty")]
    pub rains: Vec<Rain>,
    /// Drains and wells that cross joints.
    #[serde(default, rename = "drain", skip_serializing_if = "Vec::is_empty")]
    pub drains: Vec<Drain>,
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
    /// Gauges across joints.
    #[serde(default, rename = "joint_monitor", skip_serializing_if = "Vec::is_empty")]
    pub joint_monitors: Vec<JointMonitor>,
    /// Rows of points, as of inclinometers.
    #[serde(default, rename = "line", skip_serializing_if = "Vec::is_empty")]
    pub lines: Vec<Line>,
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

impl Case {
    /// Whether any rock has a strength that can be exceeded.
    pub fn yields(&self) -> bool {
        self.rocks.values().any(Rock::yields)
    }

    /// The stage with whose start displacements of outputs begin to count, if not with that of the run.
    pub fn since_stage(&self) -> Option<usize> {
        let since = self.output.since.as_ref()?;
        self.stages.iter().position(|stage| stage.name == *since).map(|stage| stage + 1)
    }

    /// Whether any rock breaks.
    pub fn breaks(&self) -> bool {
        self.rocks.values().any(|rock| rock.fracture.is_some())
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

    /// Refuses stages that cut the rock and rock that breaks, on behalf of one that cannot follow a model whose blocks
    /// change.
    ///
    /// # Errors
    /// The first rock that breaks, or the first cut of a stage.
    pub fn refuse_cuts(&self, who: &str) -> Result<(), Invalid> {
        if let Some((name, _)) = self.rocks.iter().find(|(_, rock)| rock.fracture.is_some()) {
            let key = Key::root().field("rock").field(name).field("fracture");
            let message = format!("{who} cannot follow blocks that break; use `enmm fos`, or remove it from the case");
            return fail(&key, message);
        }
        let cut = self.stages.iter().position(|stage| !stage.cuts.is_empty());
        cut.map_or(Ok(()), |k| {
            let message = format!(
                "{who} cannot follow blocks that a stage parts: draw the line as a joint from the start, with a law \
                 that holds until a stage switches it, or remove it"
            );
            Err(Invalid { key: format!("stage[{k}].cut[0]"), message })
        })
    }

    /// Whether blocks can become more: rock breaks, or a stage cuts it.
    pub fn has_cuts(&self) -> bool {
        self.breaks() || self.stages.iter().any(|stage| !stage.cuts.is_empty())
    }

    /// Whether the rock is whole: no joint cuts it, and no bolt holds it.
    pub fn is_whole(&self) -> bool {
        self.joints.is_empty()
            && self.joint_sets.is_empty()
            && self.bridges.is_empty()
            && self.bolts.is_empty()
            && self.stages.iter().all(|stage| stage.cuts.is_empty())
    }
}
