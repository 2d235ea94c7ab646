//! The built model: nothing in it changes in time.

use crate::contact::{
    BoltSegment, Boundary, ContactHistory, ContactSetting, DetectionRule, EdgeId, Frames, JointLaw, LawId, Sections,
    Support,
};
use crate::cover::{self, BlockId, CoverId, Covers, ElementId};
use crate::flow::FlowNet;
use crate::geometry::{Point, Vector};
use crate::mechanics::{
    Averaging, Chunks, Column, ColumnPosition, Elasticity, Load, MassMatrix, PreStress, Record, RockStrength,
    StressField, YieldingRock, pressure,
};

use super::{OtherIntegrator, SelectionBuffers};

/// Covers that one fixity of the case holds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Fixity {
    /// Name.
    pub name: Option<String>,
    /// Covers that it holds, and along which axes.
    pub covers: Vec<(CoverId, [bool; 2])>,
    /// Whether it holds from the start.
    pub active: bool,
    /// Velocity (m/s) with which its supports move in dynamic stages.
    pub velocity: Vector,
    /// Port by which a host moves it.
    pub port: Option<u32>,
}

impl Fixity {
    /// Whether its supports may move: their work on the rock is then that of a load.
    pub fn is_moved(&self) -> bool {
        self.port.is_some() || self.velocity != Vector::zeros()
    }
}

/// Kind of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PortKind {
    /// A block: force and moment in, motion and contact force out.
    Block,
    /// A part of the outer boundary: traction and pressure in, motion and stress out.
    Boundary,
    /// Joint faces: fluid pressure in, contact forces and slip out.
    Joint,
    /// A quiet boundary: particle velocity of the incoming wave in, velocity and traction out.
    Quiet,
    /// Supports of a fixity: velocity or displacement in, reaction out.
    Fix,
}

/// A named position where hosts exchange values with the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Port {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: PortKind,
    /// The block, or the block of the first edge.
    pub block: BlockId,
    /// Boundary edges; none for a block and for a held point.
    pub edges: Vec<EdgeId>,
    /// Fixities of its supports: those of a quiet boundary, or one of the case; none for others.
    pub fixities: Vec<u32>,
    /// Force on the block (N/m) or traction on the boundary (Pa) at the start.
    pub force: Vector,
    /// Moment on the block (N·m/m) or pressure on the faces (Pa) at the start.
    pub scalar: f64,
}

impl Port {
    /// Whether a contact lies on its edges.
    pub fn has(&self, contact: &ContactHistory, boundary: &Boundary) -> bool {
        let [before, after] = boundary.edges_of_node(contact.node);
        [contact.edge, before, after].iter().any(|edge| self.edges.binary_search(edge).is_ok())
    }
}

/// Water with a level or a sloping surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Water {
    /// Density (kg/m³).
    pub density: f64,
    /// Surface at the start of each stage.
    pub surfaces: Vec<WaterSurface>,
    /// Boundary edges that it reaches.
    pub edges: Vec<EdgeId>,
    /// Whether rock below its surface has pore pressure.
    pub in_rock: bool,
}

/// Surface of water before a host moves its level.
#[derive(Debug, Clone, PartialEq)]
pub struct WaterSurface {
    /// Height y (m): of its highest point, when it slopes.
    pub level: f64,
    /// Points of a sloping surface (m), from left to right; empty for a level one.
    pub table: Vec<Point>,
}

impl WaterSurface {
    /// Vertical depth (m) of a position below the surface when its level has moved to `level`; negative above it.
    pub fn depth(&self, level: f64, at: Point) -> f64 {
        let [table, rise] = [pressure::surface(&self.table, at.x), level - self.level];
        if self.table.is_empty() { level - at.y } else { table + rise - at.y }
    }

    /// Points of the surface (m) when its level has moved to `level`; a single one of a level surface.
    pub fn moved_to(&self, level: f64) -> Vec<Point> {
        if self.table.is_empty() {
            return vec![Point::new(0.0, level)];
        }
        let rise = Vector::new(0.0, level - self.level);
        self.table.iter().map(|point| point + rise).collect()
    }
}

/// Quantity in the rows of a motion of the base.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionKind {
    /// Acceleration (m/s²), zero outside.
    Acceleration,
    /// Velocity (m/s) from zero, kept at the end.
    Velocity,
}

/// A record that begins with a stage and acts in dynamic stages.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedRecord {
    /// Rows.
    pub record: Record,
    /// Factor on the values, with direction.
    pub amplitude: Vector,
    /// Stage at whose start its time begins.
    pub stage: u32,
}

/// A motion of the base.
#[derive(Debug, Clone, PartialEq)]
pub struct BaseMotion {
    /// Quantity in the rows.
    pub kind: MotionKind,
    /// Rows and direction.
    pub motion: TimedRecord,
}

/// Viscous boundary: fixed in static stages; in dynamic stages it keeps the static reaction and absorbs waves.
#[doc(alias = "absorbing boundary")]
#[doc(alias = "viscous boundary")]
#[derive(Debug, Clone, PartialEq)]
pub struct QuietBoundary {
    /// Fixity of its springs.
    pub springs: u32,
    /// Fixity of its dashpots.
    pub dashpots: u32,
    /// Particle velocity (m/s) of the wave that it lets in, if any.
    pub wave: Option<TimedRecord>,
    /// Port by which a host lets in another.
    pub port: Option<u32>,
    /// Free-field column on its far side, if any.
    pub column: Option<u32>,
}

/// Action of a free-field column on a dashpot of the side beside it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FreeFieldPoint {
    /// Support that is the dashpot.
    pub support: u32,
    /// Where the column has the velocity that counts.
    pub at: ColumnPosition,
    /// Both ends of the piece of side that the dashpot stands for.
    pub ends: [ColumnPosition; 2],
    /// Force (N/m) along the dashpot per displacement of the column's second end relative to the first, along x and y.
    pub stiffness: Vector,
}

/// A rock whose blocks break.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BreakingRock {
    /// Its strength.
    pub strength: RockStrength,
    /// Law of its cracks.
    pub law: LawId,
    /// Whether its blocks also split from within.
    pub cores: bool,
}

/// How rock breaks.
#[derive(Debug, Clone, PartialEq)]
pub struct Breaking {
    /// By rock; none of rock that never breaks.
    pub rocks: Vec<Option<BreakingRock>>,
    /// Internal steps of a dynamic stage from one search to the next.
    pub every: u64,
    /// Longest section (m) that breaks.
    pub longest: f64,
    /// Least area of a part (m²).
    pub least_part: f64,
    /// Most parts that breaking may add.
    pub parts_max: usize,
    /// Most cuts that it may make.
    pub cuts_max: usize,
}

/// Covers, rocks, boundary, laws, loads and numerical choices of one model.
#[doc(alias = "slope")]
#[derive(Debug, Clone)]
pub struct Model {
    /// Covers, elements and blocks.
    pub covers: Covers,
    /// Covers and elements as a step passes over them.
    pub chunks: Chunks,
    /// Rocks.
    pub rocks: Vec<Elasticity>,
    /// Rock of each element.
    pub element_rock: Vec<u16>,
    /// In-situ stress of each element (Pa); empty when there is none.
    pub pre_stress: Vec<PreStress>,
    /// Strength of each rock; none for one that never yields.
    pub strengths: Vec<Option<YieldingRock>>,
    /// Elements of rock that yields whose volume changes are averaged.
    pub averaging: Averaging,
    /// In-situ stress out of the plane of each element (Pa); empty when there is none or no rock yields.
    pub pre_stress_out: Vec<f64>,
    /// Masses of all blocks as if free.
    pub mass_matrix: MassMatrix,
    /// 2π·cs/max(√A, h) of each block (1/s): what the damping ratio multiplies.
    pub block_frequency: Vec<f64>,
    /// Number of each block as hosts see it: its index, unless the rock has been cut. The part of a block that holds
    /// the point of its port, or else its reference point, keeps the number.
    pub labels: Vec<u32>,
    /// Boundary as contact sees it.
    pub boundary: Boundary,
    /// Joint laws at the start.
    pub laws: Vec<JointLaw>,
    /// Law of each joint trace.
    pub trace_law: Vec<LawId>,
    /// Law of contacts between faces that were no joints.
    pub default_law: LawId,
    /// Sections of rock bridges that break as a whole, and those of rock that has broken.
    pub sections: Sections,
    /// How rock breaks, if any does.
    pub breaking: Option<Breaking>,
    /// Fixities.
    pub fixities: Vec<Fixity>,
    /// Supports of all fixities.
    pub supports: Vec<Support>,
    /// Supports that belong to fixities of the case; those of quiet boundaries come after them.
    pub fixed_supports: u32,
    /// Motions of the base.
    pub base_motions: Vec<BaseMotion>,
    /// Quiet boundaries, sides along free-field columns included.
    pub quiets: Vec<QuietBoundary>,
    /// Free-field columns.
    pub columns: Vec<Column>,
    /// Action of the columns on the dashpots beside them, in the order of the supports.
    pub free_field: Vec<FreeFieldPoint>,
    /// Free lengths of all bolts.
    pub bolts: Vec<BoltSegment>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Ports.
    pub ports: Vec<Port>,
    /// Water, if any.
    pub water: Option<Water>,
    /// Joints that conduct water, if it flows.
    pub flow: Option<FlowNet>,
    /// Gravity (m/s²).
    pub gravity: Vector,
    /// In-situ stress, if any.
    pub in_situ: Option<StressField>,
    /// Internal step (s).
    pub dt: f64,
    /// Stability limit (s).
    pub critical_dt: f64,
    /// θ of the contact springs in a step of `theta_step`; bolts take it as it is.
    pub theta: f64,
    /// The default step of the mesh (s), from which a case may choose a shorter one.
    pub theta_step: f64,
    /// How many times lighter free blocks are as rigid bodies in explicit static stages.
    pub mass_scaling: f64,
    /// Relative change of force at which the open–close iteration has settled.
    pub tolerance: f64,
    /// Constants of contact.
    pub detection: DetectionRule,
    /// Delay of friction in dynamic stages (s), if the case gives it.
    pub friction_delay: Option<f64>,
    /// Most sweeps of the open–close iteration.
    pub sweeps_max: u32,
    /// The integrator; none for the explicit one.
    pub integrator: Option<OtherIntegrator>,
    /// Penetration (m) at which the run fails.
    pub penetration_limit: f64,
    /// Displacement (m) beyond which a block counts as failed.
    pub failure_displacement: f64,
}

impl Model {
    /// The block with a number that hosts see, if there is one.
    pub fn block_labelled(&self, label: u32) -> Option<BlockId> {
        let is_own = self.labels.get(label as usize) == Some(&label);
        let place = if is_own { Some(label as usize) } else { self.labels.iter().position(|own| *own == label) };
        place.map(BlockId::new)
    }

    /// Data that the contacts of a step share: the boundary at its positions, joint laws, and what the selection of the
    /// contacts has found of their friction.
    pub fn contact_setting<'a>(
        &'a self,
        laws: &'a [JointLaw],
        frames: &'a Frames,
        selection: &'a SelectionBuffers,
    ) -> ContactSetting<'a> {
        let SelectionBuffers { ref trace_law, ref section_share, strength, filter_share, .. } = *selection;
        let (boundary, crush_length) = (&self.boundary, self.detection.crush_floor * self.covers.mesh.size);
        ContactSetting { boundary, frames, laws, trace_law, section_share, strength, filter_share, crush_length }
    }

    /// θ of the solver's own springs in a step of `dt` (s): backward Euler, and a dashpot that a shorter step does not
    /// weaken (Eq. 15a).
    pub fn theta_in(&self, dt: f64) -> f64 {
        1.0 + (self.theta - 1.0) * self.theta_step / dt
    }

    /// Density of water at the start (kg/m³); 0 where there is none.
    pub fn water_density(&self) -> f64 {
        let flows = || self.flow.as_ref().map_or(0.0, |flow| flow.density);
        self.water.as_ref().map_or_else(flows, |water| water.density)
    }

    /// Material point: sum of a cover field over an element's covers at reference point `p`.
    pub fn sample(&self, element: ElementId, p: Point, field: &[Vector]) -> Vector {
        cover::sample(&self.covers.element_covers[element], &self.covers.weights(element, p), field)
    }
}
