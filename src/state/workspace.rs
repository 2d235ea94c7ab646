//! Buffers of a step; never part of a checkpoint.

use crate::contact::{
    AcceptedPairs, BlockImpulse, BoltRow, ContactCache, ContactSetting, Frames, GroutBuffers, LawId, NearSides,
    OpenClose, PenetratingContacts, SearchGrid, SectionForces, SideId, SupportRow, VertexEdge,
};
use crate::cover::{BlockId, ElementId};
use crate::geometry::Vector;
use crate::mechanics::block_lanes::{BlockSums, RigidVelocity, WorkSums};
use crate::mechanics::{Averages, BlockMotion, BlockStart, Damping, MassMatrix, PlasticStrain, Turn, YieldSurface};

use super::{Buffers, Crushing, Model, State};

/// Buffers, sized at the first step and reused: what the stages of a step hand on to each other.
#[doc(alias = "scratch buffers")]
#[derive(Debug, Clone, Default)]
pub struct Workspace {
    /// Masses with the fixities of the stage.
    pub mass_matrix: MassMatrix,
    /// Forces of loads on covers (N/m); empty where nothing pushes.
    pub load_force: Vec<Vector>,
    /// Plastic flow.
    pub yielding: YieldBuffers,
    /// Motion of covers, blocks and columns.
    pub motion: MotionBuffers,
    /// Sums over chunks.
    pub sums: Vec<ChunkSums>,
    /// Boundary edges and nodes at their current positions.
    pub frames: Frames,
    /// Search and selection of contacts.
    pub selection: SelectionBuffers,
    /// Contacts of this step.
    pub contacts: Vec<VertexEdge>,
    /// Supports and bolts.
    pub supports: SupportBuffers,
    /// Open–close iteration.
    pub sweep: SweepBuffers,
    /// Outcomes of the contacts in this step, by run.
    pub outcomes: Vec<ContactOutcome>,
    /// Forces of the sections of rock bridges in this step.
    pub sections: Vec<SectionForces>,
    /// Pairs of blocks that may overlap.
    pub suspects: Vec<Suspect>,
    /// Buffers of an integrator other than the explicit one.
    pub of_integrator: Option<Box<dyn Buffers>>,
    /// Whether the step keeps to the calling thread; the bits are the same.
    pub serial: bool,
    /// Seconds spent in each part of the step.
    pub seconds: Seconds,
}

impl Workspace {
    /// Data that the contacts of this step share.
    pub fn setting<'a>(&'a self, model: &'a Model, state: &'a State) -> ContactSetting<'a> {
        model.contact_setting(&state.laws, &self.frames, &self.selection)
    }
}

/// Motion of covers, blocks and columns in a step.
#[derive(Debug, Clone, Default)]
pub struct MotionBuffers {
    /// Velocities without contact forces (m/s); between steps those before the last one.
    pub predicted: Vec<Vector>,
    /// Velocities (m/s) of the covers of one block after damping and before any force.
    pub damped: Vec<Vector>,
    /// Centroid and spin of each block.
    pub blocks: Vec<BlockMotion>,
    /// How each block moved at the start of the step.
    pub start: Vec<BlockStart>,
    /// Damping of each block.
    pub damping: Vec<Damping>,
    /// Cache key of `damping`; none forces it to be computed again.
    pub damping_of: Option<Damping>,
    /// Whether all covers of each chunk can move along both axes.
    pub movable: Vec<bool>,
    /// Whether contacts, supports or bolts may read the predicted velocity of each cover: only these have it whole.
    pub exposed: Vec<bool>,
    /// Whether each block touches another.
    pub touching: Vec<bool>,
    /// How each block turns at the end of the step; none for one that does not.
    pub turns: Vec<Option<Turn>>,
    /// Velocities of free-field columns after this step (m/s).
    pub columns: Vec<Vec<Vector>>,
    /// Largest speed of a cover (m/s).
    pub speed_max: f64,
}

/// Plastic flow in a step.
#[derive(Debug, Clone, Default)]
pub struct YieldBuffers {
    /// Yield surface of each rock in this step; none for one that never yields.
    pub surfaces: Vec<Option<YieldSurface>>,
    /// Plastic flow of each run of elements.
    pub flows: Vec<Flow>,
    /// Averages over patches of elements; empty when no rock yields.
    pub averages: Averages,
}

/// Plastic flow of a run of elements in a step.
#[derive(Debug, Clone, Default)]
pub struct Flow {
    /// Energy (J/m) that each of them takes by itself.
    pub energy: f64,
    /// Growth of those that flow.
    pub grown: Vec<Grown>,
}

/// Growth of the plastic strain of an element in a step.
#[derive(Debug, Clone, Copy)]
pub struct Grown {
    /// The element.
    pub element: ElementId,
    /// Growth.
    pub strain: PlasticStrain,
    /// Mean stress (Pa) before, over its patch.
    pub mean: f64,
}

/// Search for near pairs, and selection of contacts among them.
#[derive(Debug, Clone, Default)]
pub struct SelectionBuffers {
    /// Buffers of the search for near pairs.
    pub grid: SearchGrid,
    /// Near pairs by node and side.
    pub near_sides: NearSides,
    /// Candidates that the vertex rule accepts in this step.
    pub accepted: AcceptedPairs,
    /// Where the contacts of the last step are.
    pub cache: ContactCache,
    /// Those contacts by the node segment that they lie on.
    pub penetrating: PenetratingContacts,
    /// Law of each joint trace after switches.
    pub trace_law: Vec<LawId>,
    /// Factor on the strength of all joints in this step.
    pub strength: f64,
    /// Shares of tension and of shear beyond the residual one that bonds of each section may carry in this step.
    pub section_share: Vec<[f64; 2]>,
    /// Share of the normal force of this step in that which delayed friction feels.
    pub filter_share: f64,
    /// Faces in touch in this step.
    pub faces: FaceBuffers,
    /// Gaps (m) that contacts of small displacements had without any displacement (Eq. 62a); empty until a step finds
    /// them.
    pub kept_gaps: Option<Vec<f64>>,
    /// Nodes of which block make no contact with which side, sorted.
    pub left_out: Vec<(BlockId, SideId)>,
}

/// The face that the contacts of one block with one side are, in a step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Face {
    /// The side.
    pub side: SideId,
    /// Time (s) since it last parted.
    pub age: f32,
    /// Whether it is in touch.
    pub touches: bool,
    /// Whether one of its contacts keeps the stiffness of an impact.
    pub in_impact: bool,
    /// Normal force (N/m) that friction feels, of all its contacts.
    pub filtered_normal: f64,
    /// Length (m) of those contacts where it feels any.
    pub length: f64,
}

/// Faces of the block in hand.
#[derive(Debug, Clone, Default)]
pub struct FaceBuffers {
    /// The faces.
    pub faces: Vec<Face>,
    /// Index of the face with each side, if there is one.
    pub of_side: Vec<u32>,
}

/// Supports and bolts of a step.
#[derive(Debug, Clone, Default)]
pub struct SupportBuffers {
    /// Supports of this step.
    pub rows: Vec<SupportRow>,
    /// Bar segments of this step.
    pub bolts: Vec<BoltRow>,
    /// Balance of grouted bars.
    pub grout: GroutBuffers,
}

/// Open–close iteration of a step.
#[derive(Debug, Clone, Default)]
pub struct SweepBuffers {
    /// Order and buffers of the open–close iteration.
    pub open_close: OpenClose,
    /// Velocity increments of covers by contact impulses (m/s).
    pub increment: Vec<Vector>,
    /// Impulse sums of blocks.
    pub push: Vec<BlockImpulse>,
}

/// A pair of blocks of which a node of one lies behind an edge of the other.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Suspect {
    /// Blocks, the lower id first.
    pub blocks: [BlockId; 2],
    /// How far behind the deepest node lies (m).
    pub depth: f64,
    /// Closure (m) of the most deeply pressed contact between them.
    pub closure: f64,
}

/// Outcome of a run of contacts in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactOutcome {
    /// Work of their forces (J/m).
    pub work: f64,
    /// Heat of friction (J/m).
    pub friction: f64,
    /// Part of it that dilation takes to lift the faces (J/m).
    pub dilation: f64,
    /// Rock that they crush.
    pub crushing: Crushing,
    /// Largest penetration (m) that springs resist.
    pub penetration: f64,
    /// Number of those that were seen for the first time in this step, and deep.
    pub deep: u64,
    /// The largest of their depths (m).
    pub deepest: f64,
}

/// Sums over the covers of a chunk.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ChunkSums {
    /// Part of a block: at the start of the step.
    pub block: BlockSums,
    /// Part of a block: what the whole block has in common.
    pub common: RigidVelocity,
    /// Part of a block: at the end of the step.
    pub works: WorkSums,
    /// Whole blocks: work of damping (J/m).
    pub damping: f64,
    /// Σ(∫ρw)(v + v') of velocities before and after the step (kg/s).
    pub row_sum: Vector,
    /// Square of the largest speed (m²/s²), first at the start and then at the end of the step.
    pub fastest: f64,
    /// Sum of the squares of speeds at the end of the step (m²/s²): not finite when any is not.
    pub squares: f64,
    /// Whether the last step left all displacements below the one from which on a block counts as failed.
    pub is_near: bool,
}

/// Wall time (s) by part of the step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Seconds {
    /// Elements and kick.
    pub elements: f64,
    /// Search for near edges.
    pub search: f64,
    /// Vertex rule and contact geometry.
    pub entrance: f64,
    /// Open–close iteration.
    pub sweep: f64,
    /// Velocities, positions, ledger.
    pub commit: f64,
}
