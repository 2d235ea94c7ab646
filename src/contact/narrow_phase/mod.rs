//! Narrow phase: turns the near pairs of the broad phase into the contacts of a step. The vertex rule (theory §5)
//! decides which edge a node may enter; then geometry, length, springs and history of the contact follow.

mod constants;
mod frame;
mod make_contact;
mod penetrating;
mod tributary_length;
mod vertex_rule;

use rayon::prelude::*;

use crate::geometry::{Point, Vector, segment};
use crate::mechanics::{BlockMotion, MassMatrix, StressField};

use frame::{EdgeFrame, Over};

use super::{Boundary, ContactHistory, ContactState, EdgeId, JointLaw, LawId, NearPair, NodeId, SideId, VertexEdge};

pub use constants::EntranceRule;
pub use frame::Frames;
pub use penetrating::PenetratingContacts;

/// Near pairs in a run, which one thread tests: fixed, so that the order does not depend on threads.
const RUN: usize = 4096;
/// Runs that are tested before their contacts are made.
const RUNS: usize = 64;
/// Least number of contacts that a thread makes.
const GRAIN: usize = 256;

/// Distance beyond a corner, relative to the mesh size, that counts as the corner.
const CORNER_TOLERANCE: f64 = 1e-9;
/// Difference of two depths, relative to the mesh size, below which they count as equal.
const TIE_TOLERANCE: f64 = 1e-6;

/// Inputs of the narrow phase.
#[doc(alias = "entrance")]
#[doc(alias = "vertex rule")]
pub struct NarrowPhase<'a> {
    /// Boundary of the blocks.
    pub boundary: &'a Boundary,
    /// Current positions of the boundary points (m).
    pub position: &'a [Point],
    /// Edges and nodes at these positions.
    pub frames: &'a Frames,
    /// Star positions (m).
    pub star: &'a [Point],
    /// Displacements of the covers (m).
    pub displacement: &'a [Vector],
    /// Masses.
    pub mass_matrix: &'a MassMatrix,
    /// Centroids of the blocks.
    pub motion: &'a [BlockMotion],
    /// Joint laws.
    pub laws: &'a [JointLaw],
    /// Law of each joint trace, after switches.
    pub trace_law: &'a [LawId],
    /// Factor on the strength of all joints.
    pub strength: f64,
    /// Law of contacts between faces that were no joints.
    pub default_law: LawId,
    /// Velocities (m/s) of the covers during the last step.
    pub velocity: &'a [Vector],
    /// Last step (s).
    pub dt_last: f64,
    /// Contacts of the last step, ordered by node and side.
    pub history: &'a [ContactHistory],
    /// Index of these contacts by node.
    pub cache: &'a ContactCache,
    /// Those in penetration, by node and by node segment.
    pub penetrating: &'a PenetratingContacts,
    /// Velocities and step of an explicit step; `None` in an implicit one.
    pub approach: Option<Approach<'a>>,
    /// Mesh size (m).
    pub size: f64,
    /// Constants.
    pub rule: EntranceRule,
    /// Cosine of the angle up to which two faces count as parallel.
    pub flush_cosine: f64,
    /// Gap (m) below which a pair becomes a contact of this step.
    pub reach: f64,
    /// Whether contacts are those of the untouched model: joints are intact and pre-stressed.
    pub first: bool,
    /// Stress xx, yy, xy (Pa) before the first step, by position.
    pub in_situ: Option<&'a StressField>,
    /// Whether to keep to the calling thread.
    pub serial: bool,
}

/// Velocities and step for the springs of an explicit step.
pub struct Approach<'a> {
    /// Velocities (m/s) of the covers without contact forces.
    pub predicted: &'a [Vector],
    /// Step (s).
    pub dt: f64,
    /// Time (s) for which forces act.
    pub kick: f64,
    /// Forward weight of the solver's own springs: 1 and the dashpot.
    pub forward: f64,
    /// Damping ratio of a dynamic stage.
    pub damping: Option<f64>,
}

/// Index of the contacts of the last step by node; their list is ordered by node and side.
#[doc(alias = "persistent manifold")]
#[derive(Debug, Clone, Default)]
pub struct ContactCache {
    /// First contact of each node, and the number of contacts.
    first: Vec<u32>,
}

impl ContactCache {
    /// Bytes of the buffer.
    pub fn bytes(&self) -> usize {
        size_of_val(self.first.as_slice())
    }

    /// Indexes contacts by their nodes, of which there are `nodes`.
    pub fn index(&mut self, history: &[ContactHistory], nodes: usize) {
        self.first.clear();
        for (k, contact) in history.iter().enumerate() {
            self.first.resize(self.first.len().max(contact.node.index() + 1), k as u32);
        }
        self.first.resize(nodes + 1, history.len() as u32);
    }

    /// Contacts of a node.
    #[inline(always)]
    fn of_node(&self, node: NodeId) -> std::ops::Range<usize> {
        self.first[node] as usize..self.first[node.index() + 1] as usize
    }
}

/// A pair under test: a node over an edge of one side.
#[derive(Debug, Clone, Copy, Default)]
struct ContactCandidate {
    node: NodeId,
    side: SideId,
    edge: EdgeId,
    gap: f64,
    along: f64,
    beyond: f64,
    length: f64,
    tangent: Vector,
    /// The contact of the last step, by its index.
    held: Option<u32>,
    /// Whether the contact carried force in the last step.
    is_held: bool,
    /// Overlap (m) along the side before its start and its finish, with springs unloaded.
    overlap: [f64; 2],
    accepted: bool,
}

/// Candidates that the vertex rule accepts in one step: buffers of [`entrance_edges`].
#[derive(Debug, Clone, Default)]
pub struct AcceptedPairs {
    runs: Vec<Run>,
    candidates: Vec<ContactCandidate>,
}

/// Candidates that it accepts of a run of near pairs.
#[derive(Debug, Clone, Default)]
struct Run {
    accepted: Vec<ContactCandidate>,
    /// Sides of the current node.
    sides: Vec<ContactCandidate>,
}

impl AcceptedPairs {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let of_run = |run: &Run| size_of_val(run.accepted.as_slice()) + size_of_val(run.sides.as_slice());
        self.runs.iter().map(of_run).sum::<usize>() + size_of_val(self.candidates.as_slice())
    }
}

/// Tests every near pair and fills the contacts of this step, ordered by node and side.
pub fn entrance_edges(
    narrow: &NarrowPhase,
    near_pairs: &[NearPair],
    accepted: &mut AcceptedPairs,
    contacts: &mut Vec<VertexEdge>,
) {
    let mut made = 0;
    // In pieces: what is accepted of all near pairs together would be as large as the contacts.
    let runs = if narrow.serial { 1 } else { RUNS };
    let mut rest = near_pairs;
    while !rest.is_empty() {
        let (piece, others) = rest.split_at(first_of_run(rest, runs));
        made = narrow.enter(piece, accepted, contacts, made);
        rest = others;
    }
    contacts.truncate(made);
}

/// Start of run `k`: a multiple of its length, moved to the next node.
fn first_of_run(near_pairs: &[NearPair], k: usize) -> usize {
    let start = (k * RUN).min(near_pairs.len());
    match start.checked_sub(1).map(|last| near_pairs[last].node) {
        Some(node) => start + near_pairs[start..].iter().take_while(|c| c.node == node).count(),
        None => 0,
    }
}

impl NarrowPhase<'_> {
    /// Tests some near pairs and makes their contacts, from index `made` on; returns their end.
    fn enter(
        &self,
        near_pairs: &[NearPair],
        accepted: &mut AcceptedPairs,
        contacts: &mut Vec<VertexEdge>,
        made: usize,
    ) -> usize {
        let AcceptedPairs { runs, candidates } = accepted;
        let count = if self.serial { 1 } else { near_pairs.len().div_ceil(RUN) };
        runs.resize_with(runs.len().max(count), Run::default);
        let runs = &mut runs[..count];
        if let [run] = runs {
            self.apply_vertex_rule(near_pairs, run);
            return self.make(&run.accepted, contacts, made);
        }
        runs.par_iter_mut().enumerate().for_each(|(k, run)| {
            self.apply_vertex_rule(&near_pairs[first_of_run(near_pairs, k)..first_of_run(near_pairs, k + 1)], run);
        });
        candidates.clear();
        runs.iter().for_each(|run| candidates.extend_from_slice(&run.accepted));
        self.make(candidates, contacts, made)
    }

    /// Finds the candidates that the vertex rule accepts of some near pairs.
    fn apply_vertex_rule(&self, near_pairs: &[NearPair], run: &mut Run) {
        let Run { accepted, sides } = run;
        accepted.clear();
        for group in near_pairs.chunk_by(|a, b| a.node == b.node) {
            let node = group[0].node;
            sides.resize(sides.len().max(group.len()), ContactCandidate::default());
            let candidates = self.nearest_edges(node, group, sides);
            let mut contested = false;
            for candidate in candidates.iter_mut().filter(|candidate| candidate.accepted) {
                let overlap = self.overlap_at_ends(node, candidate).filter(|_| !self.is_false_sight(node, candidate));
                candidate.accepted = overlap.is_some();
                candidate.overlap = overlap.unwrap_or_default();
                contested |= candidate.accepted & !candidate.is_held & (candidate.gap < -TIE_TOLERANCE * self.size);
            }
            // Those that are not accepted matter only where a deep one without force is.
            let count = if contested { candidates.len() } else { keep_accepted(candidates) };
            self.choose_sides(&mut candidates[..count]);
            accepted.extend(candidates[..count].iter().filter(|p| p.accepted));
        }
    }

    /// The nearest edge of each side that the node is over, and whether it is near and faces the node; the buffers hold
    /// as many as there are near pairs.
    fn nearest_edges<'p>(
        &self,
        node: NodeId,
        group: &[NearPair],
        candidates: &'p mut [ContactCandidate],
    ) -> &'p mut [ContactCandidate] {
        let mut count = 0;
        let mut known = self.cache.of_node(node);
        for edges in group.chunk_by(|a, b| a.side == b.side) {
            while !known.is_empty() && self.history[known.start].side < edges[0].side {
                known.start += 1;
            }
            let held = !known.is_empty() && self.history[known.start].side == edges[0].side;
            // Whether it counts is seldom the same twice: no branch depends on it.
            let is_over = self.candidate(node, edges, held.then_some(known.start as u32), &mut candidates[count]);
            count += usize::from(is_over);
        }
        &mut candidates[..count]
    }

    /// Fills the candidate of one side; returns whether the node is over that side.
    #[inline(always)]
    fn candidate(&self, node: NodeId, edges: &[NearPair], held: Option<u32>, candidate: &mut ContactCandidate) -> bool {
        let (edge, over) = self.nearest(self.node_position(node), edges);
        let Over { along, gap, beyond } = over;
        let known = held.map(|k| &self.history[k as usize]);
        let is_held = known.is_some_and(|h| h.state != ContactState::Open);
        let EdgeFrame { length, tangent, .. } = self.frames.edges[edge];
        let NearPair { node: own, side, .. } = edges[0];
        *candidate = ContactCandidate {
            node: own,
            side,
            edge,
            gap,
            along,
            beyond,
            length,
            tangent,
            held,
            is_held,
            overlap: [f64::INFINITY; 2],
            accepted: false,
        };
        let bonded = known.is_some_and(|h| h.intact && h.normal_force < 0.0);
        let near = bonded | (gap - known.map_or(0.0, |h| h.rest - h.offset) < self.reach);
        candidate.accepted = near & self.enters(node, candidate);
        beyond <= self.rule.wedge_ratio * gap.abs() + self.rule.held_beyond * self.size
    }

    /// The nearest of some edges, the first of equally near ones, and where the point is over it.
    #[inline(always)]
    fn nearest(&self, p: Point, edges: &[NearPair]) -> (EdgeId, Over) {
        let over = |c: &NearPair| (c.edge, self.frames.edges[c.edge].over(p));
        edges[1..].iter().map(over).fold(over(&edges[0]), |a, b| if b.1.is_nearer_than(&a.1) { b } else { a })
    }

    /// Whether a new candidate cannot be a contact: it is deep and not of the nearest side of the rock around the node,
    /// or the node is outside the rock and beyond a side that does not meet this one, or it is deep within one block.
    fn is_false_sight(&self, node: NodeId, candidate: &ContactCandidate) -> bool {
        let tie = TIE_TOLERANCE * self.size;
        if candidate.held.is_some() || candidate.gap >= -tie {
            return false;
        }
        let boundary = self.boundary;
        let is_deep = self.is_deep(node, candidate, candidate.gap);
        if boundary.block[boundary.node_point[node]] == boundary.block[candidate.edge] {
            return is_deep;
        }
        let (depth, nearest) = self.depth_in_rock(node, candidate.edge);
        if is_deep {
            return -candidate.gap > depth + tie;
        }
        let meets = nearest == candidate.side || self.end_between(candidate.side, nearest).is_some();
        depth <= tie && !meets
    }

    /// Depth (m) of a node in the rock within the loop of an edge, 0 outside, and the nearest side of the loop.
    #[cold]
    fn depth_in_rock(&self, node: NodeId, edge: EdgeId) -> (f64, SideId) {
        let p = self.node_position(node);
        let next = |point: EdgeId| self.boundary.next[point];
        let (mut point, mut area, mut turns, mut nearest) = (edge, 0.0, 0, (f64::INFINITY, edge));
        loop {
            let ends = [point, next(point)].map(|point| self.position[point]);
            let [a, b] = ends.map(|end| end - p);
            area += a.perp(&b);
            if (a.y > 0.0) != (b.y > 0.0) && (a.perp(&b) > 0.0) == (b.y > 0.0) {
                turns += if b.y > 0.0 { 1 } else { -1 };
            }
            let distance = segment::distance(p, ends[0], ends[1]);
            if distance < nearest.0 {
                nearest = (distance, point);
            }
            point = next(point);
            if point == edge {
                break;
            }
        }
        let is_inside = turns > 0 || area < 0.0 && turns == 0;
        (if is_inside { nearest.0 } else { 0.0 }, self.boundary.side[nearest.1])
    }

    /// Whether the gap (m) of a candidate is deeper than a node moves in one step.
    fn is_deep(&self, node: NodeId, candidate: &ContactCandidate, gap: f64) -> bool {
        let Boundary { block, block_thickness, node_point, .. } = self.boundary;
        let blocks = [node_point[node], candidate.edge].map(|point| block[point]);
        let thin = blocks.map(|b| block_thickness[b]).into_iter().fold(f64::INFINITY, f64::min);
        -gap > (self.rule.deep * self.size).min(self.rule.deep_share * thin)
    }

    #[inline(always)]
    fn node_position(&self, node: NodeId) -> Point {
        self.frames.nodes[node].position
    }

    /// Distance (m) beyond a corner that counts as the corner.
    fn corner_tolerance(&self, candidate: &ContactCandidate) -> f64 {
        self.size * if candidate.is_held { self.rule.held_beyond } else { CORNER_TOLERANCE }
    }
}

/// Moves the accepted candidates to the front, in their order; returns their number.
fn keep_accepted(candidates: &mut [ContactCandidate]) -> usize {
    let mut kept = 0;
    for k in 0..candidates.len() {
        if candidates[k].accepted {
            candidates[kept] = candidates[k];
            kept += 1;
        }
    }
    kept
}

/// The direction a quarter turn to the right: outward where rock is on the left.
fn right_of(along: Vector) -> Vector {
    Vector::new(along.y, -along.x)
}

/// Whether the rock between the ways to the previous and the next node, of these lengths (m), is a corner of less than
/// half a turn, by more than an angle given by its sine.
fn is_convex([previous, next]: [Vector; 2], distance: [f64; 2], sine: f64) -> bool {
    let (cross, dot) = (next.perp(&previous), next.dot(&previous));
    cross > 0.0 && (dot > 0.0 || cross > sine * distance[0] * distance[1])
}

/// Whether a flat piece of boundary, given by its chord with rock on the left, faces an edge up to an angle given by
/// its sine.
fn faces(chord: Vector, normal: Vector, sine: f64) -> bool {
    chord.perp(&normal) > -sine * chord.norm()
}
