//! Parts of a film, as plain data. SI units, y up, tension positive, counter-clockwise angles.

use serde::Serialize;

/// Head of a film.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Head {
    /// Title of the case.
    pub title: String,
    /// The command that made the film, such as `run`.
    pub command: String,
    /// Version of the engine.
    pub version: String,
    /// Name of the case file as the user gave it.
    pub case_file: String,
    /// Text of the case file.
    pub case_text: String,
    /// Axis of the slider.
    pub axis: Axis,
    /// Numbers of blocks in frames, of which the page shows all: first displacement x, y and rotation.
    pub block_numbers: Vec<BlockNumber>,
    /// Columns of the histories; the first is the time (s).
    pub columns: Vec<Column>,
    /// Monitored points.
    pub monitors: Vec<MonitorPlace>,
    /// Free lengths of bolts.
    pub bolts: Vec<BoltPlace>,
    /// Names of the rocks that [`Outline::rock`] counts.
    pub rocks: Vec<String>,
}

/// A number of blocks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct BlockNumber {
    /// Name, such as `velocity_x`, by which the page knows vectors and tensors.
    pub name: String,
    /// Unit; empty for a pure number.
    pub unit: String,
    /// Meaning in a few words.
    pub meaning: String,
    /// Smallest and largest value of its colours, where these do not follow from the film.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[u32; 2]>,
}

/// Axis of the slider.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Axis {
    /// Quantity, such as `time`.
    pub name: String,
    /// Unit, such as `s`; empty for a pure number.
    pub unit: String,
}

impl Axis {
    /// Simulated time in seconds.
    pub fn time() -> Self {
        Self { name: "time".to_owned(), unit: "s".to_owned() }
    }
}

/// A column of the histories.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Column {
    /// Name, such as `crest_ux`.
    pub name: String,
    /// Quantity that the chart names, such as `Displacement`; columns of one quantity and unit share a chart.
    pub quantity: String,
    /// Unit; empty for a pure number.
    pub unit: String,
    /// Whether NaN stands for no value; elsewhere it is a failure.
    #[serde(skip)]
    pub gaps: bool,
}

/// A monitored point.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MonitorPlace {
    /// Name.
    pub name: String,
    /// Reference position (m).
    pub place: [f64; 2],
}

/// A free length of a bolt.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BoltPlace {
    /// Name of its bolt; the lengths of a grouted one share it.
    pub name: String,
    /// Reference position of both ends (m), the end at the head first.
    pub ends: [[f64; 2]; 2],
}

/// A block in the reference configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Id that the user sees.
    pub id: u32,
    /// Whether the block is held.
    pub fixed: bool,
    /// Index of its rock in [`Head::rocks`].
    pub rock: u16,
    /// Area (m²).
    pub area: f64,
    /// Mass (kg/m).
    pub mass: f64,
    /// Centroid (m).
    pub centroid: [f64; 2],
    /// Corners of each loop (m), outer loop first.
    pub loops: Vec<Vec<[f64; 2]>>,
    /// Its elements; none in a film that shows blocks alone.
    pub mesh: Mesh,
}

/// Elements of a block in the reference configuration.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Points (m) of its elements that are no corners of the block.
    pub points: Vec<[f64; 2]>,
    /// Points of each element by their numbers: the corners of the block, loop by loop, then [`Mesh::points`].
    pub elements: Vec<Vec<u32>>,
    /// Whether the edge behind each corner has an opening and a slip; of two edges that face each other, one has.
    pub faces: Vec<bool>,
}

/// State of an edge of an outline in a frame: the edge behind corner `k` runs from corner `k` to the next of its loop.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum EdgeState {
    /// No joint: a free face.
    #[default]
    Free,
    /// A joint without contact force.
    Open,
    /// A joint that slips.
    Slip,
    /// A joint below its shear limit.
    Lock,
    /// A joint that softens, such as a rock bridge, and holds.
    Bridge,
    /// One that has broken.
    Broken,
}

/// A block in a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BlockFrame {
    /// Whether the block has been excavated.
    pub removed: bool,
    /// Its numbers, in the order of [`Head::block_numbers`].
    pub numbers: Vec<f64>,
}

/// A monitored point in a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MonitorFrame {
    /// Displacement (m).
    pub displacement: [f64; 2],
    /// Velocity (m/s).
    pub velocity: [f64; 2],
}

/// A free length of a bolt in a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BoltFrame {
    /// Number of its condition: 0 absent, 1 whole, 2 yielded, 3 broken.
    pub condition: u8,
    /// Displacement of both ends (m).
    pub displacement: [[f64; 2]; 2],
    /// Tension (N per metre of depth).
    pub force: f64,
}

/// A supported point in a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SupportFrame {
    /// Where (m).
    pub place: [f64; 2],
    /// Whether it is held along x and along y.
    pub axes: [bool; 2],
    /// Whether it is of a boundary that lets waves out, and not of a fixity.
    pub absorbs: bool,
}

/// Actions on the rock in a frame beside its joints.
#[derive(Debug, Clone, Copy, Default)]
pub struct Structures<'a> {
    /// All free lengths of bolts, in the order of [`Head::bolts`].
    pub bolts: &'a [BoltFrame],
    /// The supports that hold; a film keeps those of the first frame of each stage.
    pub supports: &'a [SupportFrame],
    /// Weight of the water (N/m³).
    pub water_weight: f64,
    /// Surface of the water (m) from left to right, level beyond both ends; empty without water.
    pub water_surface: &'a [[f64; 2]],
    /// Whether the water presses on the edge behind each corner; empty without water and in a film without joint
    /// states.
    pub wet: &'a [bool],
}

/// One instant.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    /// Where on the axis of the film (s for a film of time); not less than in the frame before.
    pub time: f64,
    /// Number of the stage, from 0.
    pub stage: u32,
    /// All blocks, in the order of their outlines.
    pub blocks: &'a [BlockFrame],
    /// Displacement (m) of all corners, loop by loop, in the order of the outlines.
    pub corners: &'a [[f64; 2]],
    /// State of the edge behind each corner; empty in a film without joint states.
    pub edges: &'a [EdgeState],
    /// All monitored points, in the order of [`Head::monitors`].
    pub monitors: &'a [MonitorFrame],
    /// Bolts, supports and water.
    pub structures: Structures<'a>,
}

/// Numbers of elements and joints in a frame.
#[derive(Debug, Clone, Copy)]
pub struct Elements<'a> {
    /// Displacement (m) of all [`Mesh::points`], block by block.
    pub points: &'a [[f64; 2]],
    /// Velocity (m/s) of all elements, at the mean of their points.
    pub velocity: &'a [[f64; 2]],
    /// Stress xx, yy, xy (Pa, tension positive) of all elements.
    pub stress: &'a [[f64; 3]],
    /// Opening and slip (m) of the edges that [`Mesh::faces`] names.
    pub joints: &'a [[f64; 2]],
}

/// Information beside the frames, appended as soon as there is some.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "note", rename_all = "snake_case")]
pub enum Note {
    /// A stage begins, or, with the same number again, has ended.
    Stage {
        /// Number, from 0.
        number: u32,
        /// Name.
        name: String,
        /// `static` or `dynamic`.
        kind: String,
        /// Time of its start (s).
        start: f64,
        /// Time of its end (s); none while it lasts.
        end: Option<f64>,
        /// How it ended, such as `at rest`; empty while it lasts.
        outcome: String,
    },
    /// A warning for the user.
    Warning {
        /// The warning.
        text: String,
    },
    /// A block has broken in two.
    Break(Break),
    /// Water that flows in the joints from this time on.
    Water(Water),
    /// Trials of a factor of safety.
    Trials(TrialTable),
    /// Blocks to mark on the slope, such as a failing mass.
    Marked(Marked),
    /// A short table of names and values.
    Facts {
        /// Head of the table.
        title: String,
        /// Rows.
        rows: Vec<Fact>,
    },
    /// Changes in the drawing that a reader may want to look up, of one kind.
    Changes {
        /// What has changed.
        title: String,
        /// Those that are listed.
        rows: Vec<Fact>,
        /// How many there are.
        count: usize,
    },
    /// Whether the slope has failed, and how.
    Verdict {
        /// In one line.
        text: String,
        /// Whether it has failed.
        failed: bool,
    },
    /// The film is complete.
    End {
        /// `finished`, `interrupted`, or why it failed.
        status: String,
    },
}

/// A block that has broken in two.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Break {
    /// When (s).
    pub at: f64,
    /// The block.
    pub block: u32,
    /// Number of the part that is new; a later note of the same part says the same.
    pub part: u32,
    /// How the section failed, such as `bends`.
    pub failure: String,
    /// Ends of the section in the reference configuration (m).
    pub ends: [[f64; 2]; 2],
    /// Share of its strength that it had.
    pub share: f64,
    /// Normal force (N/m, tension positive).
    pub normal: f64,
    /// Shear force (N/m).
    pub shear: f64,
    /// Bending moment (N).
    pub moment: f64,
}

/// Water that flows in the joints of a model.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Water {
    /// Name of the stage that has found it.
    pub stage: String,
    /// Ends and crossings of joints: x, y in the reference configuration and pressure head (m).
    pub nodes: Vec<[f64; 3]>,
    /// Pieces of joint that conduct: nodes at both ends, number of a block beside it, and the flow (m²/s) from the
    /// first to the second node.
    pub pieces: Vec<(u32, u32, u32, f64)>,
    /// Outcrops through which water leaves into the air: x, y (m) and the flow (m²/s).
    pub seeps: Vec<[f64; 3]>,
    /// Drains that act.
    pub drains: Vec<WaterDrain>,
    /// Water at each place where it enters and leaves.
    pub inlets: Vec<WaterInlet>,
}

/// A drain that acts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WaterDrain {
    /// Name.
    pub name: String,
    /// Its points (m), the mouth first.
    pub points: Vec<[f64; 2]>,
    /// Flow (m²/s) that it takes.
    pub flow: f64,
}

/// Water that enters and leaves at one place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WaterInlet {
    /// Name of the head, rain or drain; `reservoir` or `air`.
    pub name: String,
    /// Water (m²/s) that enters the joints.
    pub enters: f64,
    /// Water (m²/s) that leaves them.
    pub leaves: f64,
    /// Rain (m²/s) that runs off.
    pub runs_off: f64,
}

/// A row of [`Note::Facts`] or [`Note::Changes`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fact {
    /// What.
    pub name: String,
    /// Its value with the unit, as it is shown.
    pub value: String,
}

/// Trials of a factor of safety.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrialTable {
    /// Result in one line.
    pub result: String,
    /// Trials, ascending in the factor.
    pub trials: Vec<Trial>,
}

/// One trial of a factor of safety.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// Factor by which the strength was divided.
    pub factor: f64,
    /// `stable`, `unstable` or `caught`.
    pub verdict: String,
    /// Why.
    pub reason: String,
    /// Simulated time (s).
    pub time: f64,
    /// Largest displacement (m).
    pub displacement: f64,
    /// Largest speed (m/s).
    pub speed: f64,
    /// Failing blocks.
    pub failing: u32,
    /// Their area (m²).
    pub area: f64,
}

/// Blocks to mark on the slope.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Marked {
    /// Name, such as `failing mass`.
    pub name: String,
    /// Their ids.
    pub blocks: Vec<u32>,
    /// Lines about them, such as area, mass and share.
    pub rows: Vec<Fact>,
}
