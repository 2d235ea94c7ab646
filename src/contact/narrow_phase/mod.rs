//! Narrow phase: turns the near pairs of the broad phase into the contacts of a step. The vertex rule (theory §5)
//! decides which edge a node may enter; then geometry, length, springs and history of the contact follow.

mod constants;
mod make_contact;
mod near_sides;
mod nearest;
mod penetrating;
mod tributary_length;
mod vertex_rule;

use std::ops::Range;

use enmm_lanes::dispatch;
use rayon::prelude::*;

use crate::geometry::{Point, Vector, segment};
use crate::mechanics::StressField;

use near_sides::{NearRun, NearSide};
use nearest::{CARRIED, ENTERS, FindNearest, Nearest, OVER};

use super::frame::{EdgeFrame, Frames};
use super::{Boundary, ContactHistory, ContactState, EdgeId, JointLaw, LawId, NearPair, NodeId, SideId, VertexEdge};

pub use constants::EntranceRule;
pub use near_sides::NearSides;
pub use penetrating::PenetratingContacts;

/// Runs of each thread that are tested before their contacts are made.
const RUNS: usize = 8;
/// Least number of contacts that a thread makes.
const GRAIN: usize = 256;

/// No contact of the last step.
const NONE: u32 = u32::MAX;

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
    /// Its edges and nodes at their current positions.
    pub frames: &'a Frames,
    /// Star positions (m).
    pub star: &'a [Point],
    /// Displacements of the covers (m).
    pub displacement: &'a [Vector],
    /// Joint laws.
    pub laws: &'a [JointLaw],
    /// Law of each joint trace, after switches.
    pub trace_law: &'a [LawId],
    /// Law of contacts between faces that were no joints.
    pub default_law: LawId,
    /// Velocities (m/s) of the covers during the last step.
    pub velocity: &'a [Vector],
    /// Contacts of the last step, ordered by node and side.
    pub history: &'a [ContactHistory],
    /// Index of these contacts by node.
    pub cache: &'a ContactCache,
    /// Those in penetration, by node and by node segment.
    pub penetrating: &'a PenetratingContacts,
    /// Step (s) for which the default stiffness looks ahead; 0 in an implicit step.
    pub dt: f64,
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
    fn of_node(&self, node: NodeId) -> Range<usize> {
        self.of_nodes([node.index(), node.index() + 1])
    }

    /// Contacts of the nodes from the first to the one after the last.
    #[inline(always)]
    fn of_nodes(&self, [first, end]: [usize; 2]) -> Range<usize> {
        self.first[first] as usize..self.first[end] as usize
    }
}

/// A pair under test: a node over an edge of one side.
#[derive(Debug, Clone, Copy, Default)]
struct ContactCandidate {
    node: NodeId,
    side: SideId,
    edge: EdgeId,
    near_side: u32,
    gap: f64,
    along: f64,
    beyond: f64,
    length: f64,
    tangent: Vector,
    /// The contact of the last step, by its index.
    held: Option<u32>,
    /// Whether the contact carried force in the last step.
    is_held: bool,
    /// Whether the node is over the edge: it misses it by no more than a bend of the boundary explains.
    is_over: bool,
    /// Overlap (m) along the side before its start and its finish, with springs unloaded.
    overlap: [f64; 2],
    accepted: bool,
}

/// Candidates that the vertex rule accepts in one step: buffers of [`entrance_edges`].
#[derive(Debug, Clone, Default)]
pub struct AcceptedPairs {
    runs: Vec<Run>,
    candidates: Vec<ContactCandidate>,
    /// Near side of each contact of this step, and of those of the last one.
    pub near_side: Vec<u32>,
    near_side_last: Vec<u32>,
}

/// Candidates that it accepts of a run of near pairs.
#[derive(Debug, Clone, Default)]
struct Run {
    accepted: Vec<ContactCandidate>,
    /// Sides of the current node, and those of them that are accepted.
    sides: Vec<ContactCandidate>,
    accepted_sides: Vec<ContactCandidate>,
    nearest: Nearest,
    /// Contact of the last step of each near side, or [`NONE`].
    known: Vec<u32>,
    /// Near sides that rule 1 lets in.
    entering: Vec<u32>,
}

impl AcceptedPairs {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let numbers = |list: &Vec<u32>| size_of_val(list.as_slice());
        let of_run = |run: &Run| {
            let candidates = size_of_val(run.accepted.as_slice()) + size_of_val(run.sides.as_slice());
            candidates + run.nearest.bytes() + numbers(&run.known) + numbers(&run.entering)
        };
        let near_sides = numbers(&self.near_side) + numbers(&self.near_side_last);
        self.runs.iter().map(of_run).sum::<usize>() + size_of_val(self.candidates.as_slice()) + near_sides
    }
}

/// Applies the vertex rule to every near side and fills the contacts of this step, ordered by node and side.
pub fn entrance_edges(
    narrow: &NarrowPhase,
    near_pairs: &[NearPair],
    near_sides: &NearSides,
    accepted: &mut AcceptedPairs,
    contacts: &mut Vec<VertexEdge>,
) {
    std::mem::swap(&mut accepted.near_side_last, &mut accepted.near_side);
    accepted.near_side.clear();
    let mut made = 0;
    // In pieces: what is accepted of all near sides together would be as large as the contacts.
    let piece = if narrow.serial { 1 } else { RUNS * rayon::current_num_threads() };
    let mut first = 0;
    while first < near_sides.runs() {
        let end = near_sides.runs().min(first + piece);
        made = narrow.enter(near_pairs, near_sides, first..end, accepted, contacts, made);
        first = end;
    }
    contacts.truncate(made);
}

impl NarrowPhase<'_> {
    /// Applies the vertex rule to some runs and makes their contacts, from index `made` on; returns their end.
    fn enter(
        &self,
        near_pairs: &[NearPair],
        near_sides: &NearSides,
        range: Range<usize>,
        accepted: &mut AcceptedPairs,
        contacts: &mut Vec<VertexEdge>,
        made: usize,
    ) -> usize {
        let AcceptedPairs { runs, candidates, near_side, near_side_last } = accepted;
        runs.resize_with(runs.len().max(range.len()), Run::default);
        let runs = &mut runs[..range.len()];
        let apply = |(k, run): (usize, &mut Run)| {
            self.apply_vertex_rule(near_pairs, near_sides.run(k), near_side_last, run);
        };
        if let [run] = runs {
            apply((range.start, run));
            near_side.extend(run.accepted.iter().map(|candidate| candidate.near_side));
            return self.make(&run.accepted, contacts, made);
        }
        range.into_par_iter().zip(&mut *runs).for_each(apply);
        candidates.clear();
        runs.iter().for_each(|run| candidates.extend_from_slice(&run.accepted));
        near_side.extend(candidates.iter().map(|candidate| candidate.near_side));
        self.make(candidates, contacts, made)
    }

    /// Finds the candidates that the vertex rule accepts of the near sides of a run; `near_side_last` are those of the
    /// contacts of the last step, as a rule.
    fn apply_vertex_rule(&self, near_pairs: &[NearPair], near: NearRun, near_side_last: &[u32], run: &mut Run) {
        let Run { accepted, sides, accepted_sides, nearest, known, entering } = run;
        self.recall(near, near_side_last, nearest, known);
        dispatch(FindNearest { narrow: self, run: near, nearest });
        let found = Found { near_pairs, near, nearest, known };
        list_entering(&nearest.verdict, entering);
        accepted.clear();
        for group in entering.chunk_by(|&a, &b| found.node(a) == found.node(b)) {
            sides.clear();
            let mut contested = false;
            for &k in group {
                let mut candidate = self.candidate(&found, k as usize);
                let node = candidate.node;
                let Some(overlap) = self.overlap_at_ends(node, &candidate) else { continue };
                if self.is_false_sight(node, &candidate) {
                    continue;
                }
                (candidate.overlap, candidate.accepted) = (overlap, true);
                contested |= !candidate.is_held & (candidate.gap < -TIE_TOLERANCE * self.size);
                sides.push(candidate);
            }
            // Rejected sides matter only beside a new contact in penetration.
            if contested {
                std::mem::swap(sides, accepted_sides);
                self.all_sides(&found, group[0] as usize, accepted_sides, sides);
            }
            self.choose_sides(sides);
            accepted.extend(sides.iter().filter(|p| p.accepted));
        }
    }

    /// Finds the contacts of the last step among the near sides of a run, and the gaps of their unloaded springs.
    fn recall(&self, near: NearRun, near_side_last: &[u32], nearest: &mut Nearest, known: &mut Vec<u32>) {
        nearest.begin(near.near_sides.len());
        known.clear();
        known.resize(near.near_sides.len(), NONE);
        for k in self.cache.of_nodes(near.nodes()) {
            let contact = &self.history[k];
            let guess = near_side_last.get(k).map_or(usize::MAX, |&guess| (guess as usize).wrapping_sub(near.first));
            if let Some(at) = near.of(contact, guess) {
                known[at] = k as u32;
                let bonded = contact.intact && contact.normal_force < 0.0;
                nearest.verdict[at] = CARRIED * u8::from(contact.state != ContactState::Open);
                nearest.rest[at] = if bonded { f64::INFINITY } else { contact.rest - contact.offset };
            }
        }
    }

    /// The candidate of a near side of a run.
    #[inline(always)]
    fn candidate(&self, found: &Found, k: usize) -> ContactCandidate {
        let Found { near_pairs, near, nearest, known } = *found;
        let NearSide { node, side, first } = near.near_sides[k];
        let edge = near_pairs[(first + nearest.edge[k]) as usize].edge;
        let EdgeFrame { length, tangent, .. } = self.frames.edge(edge);
        let held = (known[k] != NONE).then_some(known[k]);
        ContactCandidate {
            node,
            side,
            edge,
            near_side: (near.first + k) as u32,
            gap: nearest.gap[k],
            along: nearest.along[k],
            beyond: nearest.beyond[k],
            length,
            tangent,
            held,
            is_held: nearest.verdict[k] & CARRIED != 0,
            is_over: nearest.verdict[k] & OVER != 0,
            overlap: [f64::INFINITY; 2],
            accepted: false,
        }
    }

    /// All sides that are considered of the node of a near side `k`, in their order, given those that are `accepted`.
    fn all_sides(&self, found: &Found, k: usize, accepted: &[ContactCandidate], sides: &mut Vec<ContactCandidate>) {
        sides.clear();
        let mut accepted = accepted.iter().peekable();
        for k in found.near.of_same_node(k).filter(|&k| is_considered(found.nearest.verdict[k])) {
            let known = accepted.next_if(|known| known.near_side as usize == found.near.first + k);
            sides.push(known.copied().unwrap_or_else(|| self.candidate(found, k)));
        }
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
            let ends = [point, next(point)].map(|point| self.frames.position(point));
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
        self.frames.node(node).position
    }

    /// Distance (m) beyond a corner that counts as the corner.
    fn corner_tolerance(&self, candidate: &ContactCandidate) -> f64 {
        self.size * if candidate.is_held { self.rule.held_beyond } else { CORNER_TOLERANCE }
    }
}

/// Results for the near sides of a run.
#[derive(Clone, Copy)]
struct Found<'a> {
    near_pairs: &'a [NearPair],
    near: NearRun<'a>,
    nearest: &'a Nearest,
    /// Contact of the last step of each, or [`NONE`].
    known: &'a [u32],
}

impl Found<'_> {
    /// Node of a near side.
    fn node(&self, k: u32) -> NodeId {
        self.near.near_sides[k as usize].node
    }
}

/// Whether the node is over the edge, or carried force in the last step; rule 2 then decides.
fn is_considered(verdict: u8) -> bool {
    verdict & (OVER | CARRIED) != 0
}

/// Lists the near sides that are considered, near and may be entered by rule 1. No branch depends on it.
fn list_entering(verdicts: &[u8], entering: &mut Vec<u32>) {
    entering.resize(verdicts.len(), 0);
    let mut count = 0;
    for (k, &verdict) in (0..).zip(verdicts) {
        entering[count] = k;
        count += usize::from((verdict & ENTERS != 0) & is_considered(verdict));
    }
    entering.truncate(count);
}
