//! Narrow phase: turns the near pairs of the broad phase into the contacts of a step. The vertex rule (theory §5)
//! decides which edge a node may enter; then geometry, length, springs and history of the contact follow.

mod make_contact;
mod near_sides;
mod prefilter;
mod tributary_length;

use std::ops::Range;

use rayon::prelude::*;

use crate::geometry::{Point, Vector};
use crate::mechanics::StressField;

use near_sides::{NearRun, NearSide};
use prefilter::Nearest;

use super::{
    BondHistory, ContactCandidate, ContactHistory, FoundContact, JointLaw, LawId, NearPair, NodeId, VertexEdge,
    VertexRule,
};

pub use near_sides::NearSides;
pub use prefilter::prefiltered;

/// Runs of each thread that are tested before their contacts are made.
const RUNS: usize = 8;
/// Least number of contacts that a thread makes.
const GRAIN: usize = 256;

/// Inputs of the narrow phase.
#[doc(alias = "entrance")]
#[doc(alias = "vertex rule")]
pub struct NarrowPhase<'a> {
    /// The vertex rule, with boundary, positions and contacts of the last step.
    pub rule: VertexRule<'a>,
    /// The contacts of the last step as they were found; empty when none of them stays.
    pub last: &'a [FoundContact],
    /// Positions of the nodes when all contacts were found (m); none where this step has to find all.
    pub found_at: Option<&'a [Point]>,
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
    /// Step (s) for which the default stiffness looks ahead; 0 in an implicit step.
    pub dt: f64,
    /// 1/M (1/kg·m) of all blocks, in an explicit step in which impacts keep the stiffness of their first touch.
    pub impacts: Option<&'a [f64]>,
    /// Whether contacts are those of the untouched model: joints are intact and pre-stressed.
    pub first: bool,
    /// Whether joints of the laws soften.
    pub softens: bool,
    /// Bonds of the contacts of the last step; empty in a model whose joints do not soften.
    pub bonds: &'a [BondHistory],
    /// Stress xx, yy, xy (Pa) before the first step, by position.
    pub in_situ: Option<&'a StressField>,
    /// Whether to keep to the calling thread.
    pub serial: bool,
}

/// Candidates that the vertex rule accepts in one step: buffers of [`entrance_edges`].
#[derive(Debug, Clone, Default)]
pub struct AcceptedPairs {
    runs: Vec<Run>,
    candidates: Vec<ContactCandidate>,
    /// The contacts of this step as they were found.
    pub found: Vec<FoundContact>,
}

/// Candidates that it accepts of a run of near pairs.
#[derive(Debug, Clone, Default)]
struct Run {
    accepted: Vec<ContactCandidate>,
    /// Sides that the current node enters, and a buffer for others.
    entered: Vec<ContactCandidate>,
    sides: Vec<ContactCandidate>,
    /// Whether the contacts of each node stay as they were found.
    stays: Vec<bool>,
    nearest: Nearest,
    /// Near sides that the prefilter leaves.
    likely: Vec<u32>,
}

impl AcceptedPairs {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let numbers = |list: &Vec<u32>| size_of_val(list.as_slice());
        let of_run = |run: &Run| {
            let candidates = size_of_val(run.accepted.as_slice()) + size_of_val(run.sides.as_slice());
            candidates + run.nearest.bytes() + numbers(&run.likely) + run.stays.len()
        };
        let found = size_of_val(self.candidates.as_slice()) + size_of_val(self.found.as_slice());
        self.runs.iter().map(of_run).sum::<usize>() + found
    }
}

/// Applies the vertex rule to the near sides of all nodes that have moved, and fills the contacts of this step, ordered
/// by node and side.
pub fn entrance_edges(
    narrow: &NarrowPhase,
    near_pairs: &[NearPair],
    near_sides: &NearSides,
    accepted: &mut AcceptedPairs,
    contacts: &mut Vec<VertexEdge>,
) {
    let mut made = 0;
    // In pieces: what is accepted of all near sides together would be as large as the contacts.
    let piece = if narrow.serial { 1 } else { RUNS * rayon::current_num_threads() };
    let mut first = 0;
    while first < near_sides.runs() {
        let end = near_sides.runs().min(first + piece);
        made = narrow.enter((near_pairs, near_sides), first..end, accepted, contacts, made);
        first = end;
    }
    contacts.truncate(made);
    accepted.found.truncate(made);
}

impl NarrowPhase<'_> {
    /// Applies the vertex rule to some runs and makes their contacts, from index `made` on; returns their end.
    fn enter(
        &self,
        (near_pairs, near_sides): (&[NearPair], &NearSides),
        range: Range<usize>,
        accepted: &mut AcceptedPairs,
        contacts: &mut Vec<VertexEdge>,
        made: usize,
    ) -> usize {
        let AcceptedPairs { runs, candidates, found } = accepted;
        runs.resize_with(runs.len().max(range.len()), Run::default);
        let runs = &mut runs[..range.len()];
        let apply = |(k, run)| self.apply_vertex_rule(near_pairs, near_sides.run(k), run);
        if let [run] = runs {
            apply((range.start, run));
            return self.make(&run.accepted, found, contacts, made);
        }
        range.into_par_iter().zip(&mut *runs).for_each(apply);
        candidates.clear();
        runs.iter().for_each(|run| candidates.extend_from_slice(&run.accepted));
        self.make(candidates, found, contacts, made)
    }

    /// Finds the contacts of a run: candidates that the vertex rule accepts, and those that stay.
    fn apply_vertex_rule(&self, near_pairs: &[NearPair], near: NearRun, run: &mut Run) {
        let Run { accepted, entered, sides: others, stays, nearest, likely } = run;
        accepted.clear();
        let by_node = || near.near_sides.chunk_by(|a, b| a.node == b.node);
        stays.clear();
        stays.extend(by_node().map(|sides| self.stays(sides)));
        if stays.iter().all(|&stays| stays) {
            return by_node().for_each(|sides| accepted.extend(self.staying(sides[0].node)));
        }
        nearest.fill(&self.rule, near, self.last);
        list_likely(&nearest.may_enter, likely);
        let candidate = |k: usize| {
            let pair = &near_pairs[(near.near_sides[k].first + nearest.edge[k]) as usize];
            self.rule.candidate(pair, (near.first + k) as u32, nearest.held(k))
        };
        let mut rest = likely.as_slice();
        for (sides, stays) in by_node().zip(stays) {
            let node = sides[0].node;
            let own = rest.iter().take_while(|&&k| near.near_sides[k as usize].node == node).count();
            let (own, later) = rest.split_at(own);
            rest = later;
            if *stays {
                accepted.extend(self.staying(node));
            } else if let [first, ..] = *own {
                let all = || near.of_same_node(first as usize).map(candidate);
                self.rule.enter(own.iter().map(|&k| candidate(k as usize)), all, entered, others);
                accepted.extend_from_slice(entered);
            }
        }
    }

    /// Whether the contacts of a node with some sides stay as they were found: it has hardly moved against these, and
    /// strikes none of them.
    fn stays(&self, sides: &[NearSide]) -> bool {
        let Some(found_at) = self.found_at else { return false };
        let way = |node: NodeId| self.rule.position(node) - found_at[node.index()];
        let (node, most) = (sides[0].node, self.rule.constants.stays * self.rule.size);
        let own = way(node);
        let is_still = |&end: &NodeId| (way(end) - own).norm_squared() <= most * most;
        let known = &self.rule.history[self.rule.cache.of_node(node)];
        sides.iter().all(|near| near.ends.iter().all(is_still))
            && known.iter().all(|contact| contact.meeting.kept_stiffness == 0.0)
    }

    /// The contacts of a node in the last step, which stay.
    fn staying(&self, node: NodeId) -> impl Iterator<Item = ContactCandidate> {
        self.rule.cache.of_node(node).map(|k| {
            let ContactHistory { node, side, edge, .. } = self.rule.history[k];
            let candidate = self.rule.candidate(&NearPair { node, side, edge }, self.last[k].near_side, Some(k as u32));
            ContactCandidate { stays: true, ..candidate }
        })
    }
}

/// Lists the near sides that the node may enter. No branch depends on it.
fn list_likely(may_enter: &[u8], likely: &mut Vec<u32>) {
    likely.resize(may_enter.len(), 0);
    let mut count = 0;
    for (k, &may_enter) in (0..).zip(may_enter) {
        likely[count] = k;
        count += usize::from(may_enter);
    }
    likely.truncate(count);
}
