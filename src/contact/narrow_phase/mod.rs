//! Narrow phase: turns the near pairs of the broad phase into the contacts of a step. The vertex rule (theory §5)
//! decides which edge a node may enter; then geometry, length, springs and history of the contact follow.

mod make_contact;
mod near_sides;
mod prefilter;
mod tributary_length;

use rayon::prelude::*;

use crate::geometry::{Point, Vector};
use crate::mechanics::StressField;

use near_sides::{NearRun, NearSide};
use prefilter::Nearest;

use super::{
    BondHistory, ContactCandidate, FoundContact, JointLaw, LawId, NearPair, NodeId, Sections, VertexEdge, VertexRule,
};

pub use near_sides::NearSides;
pub use prefilter::prefiltered;

/// Runs of each thread that are tested before their contacts are made.
const RUNS: usize = 8;

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
    /// Sections of rock bridges.
    pub sections: &'a Sections,
    /// Stress xx, yy, xy (Pa) before the first step, by position.
    pub in_situ: Option<&'a StressField>,
    /// Whether to keep to the calling thread.
    pub serial: bool,
}

/// Contacts of one step before they are made: buffers of [`find_contacts`].
#[derive(Debug, Clone, Default)]
pub struct AcceptedPairs {
    runs: Vec<Run>,
    /// The contacts of this step as they were found.
    pub found: Vec<FoundContact>,
}

/// A contact of this step before it is made.
#[derive(Debug, Clone, Copy)]
enum Accepted {
    /// The contact of the last step that has this index stays as it was found.
    Stays(u32),
    /// The vertex rule has accepted the candidate of its run that has this index.
    Found(u32),
}

/// Contacts of a run of near pairs.
#[derive(Debug, Clone, Default)]
struct Run {
    accepted: Vec<Accepted>,
    candidates: Vec<ContactCandidate>,
    /// Sides that the current node enters, and a buffer for others.
    entered: Vec<ContactCandidate>,
    sides: Vec<ContactCandidate>,
    /// Whether the contacts of the node of each near side stay as they were found.
    stays: Vec<bool>,
    nearest: Nearest,
    /// Near sides that the prefilter leaves.
    likely: Vec<u32>,
}

impl AcceptedPairs {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let of_run = |run: &Run| {
            let candidates = size_of_val(run.candidates.as_slice()) + size_of_val(run.sides.as_slice());
            let lists = size_of_val(run.accepted.as_slice()) + size_of_val(run.likely.as_slice());
            candidates + lists + run.nearest.bytes() + run.stays.len()
        };
        self.runs.iter().map(of_run).sum::<usize>() + size_of_val(self.found.as_slice())
    }
}

/// Applies the vertex rule to the near sides of all nodes that have moved, and fills the contacts of this step, ordered
/// by node and side.
pub fn find_contacts(
    narrow: &NarrowPhase,
    near_pairs: &[NearPair],
    near_sides: &NearSides,
    accepted: &mut AcceptedPairs,
    contacts: &mut Vec<VertexEdge>,
) {
    let AcceptedPairs { runs, found } = accepted;
    // In pieces: what is accepted of all near sides together would be as large as the contacts.
    let piece = if narrow.serial { 1 } else { RUNS * rayon::current_num_threads() };
    runs.resize_with(runs.len().max(piece.min(near_sides.runs())), Run::default);
    let (mut first, mut made) = (0, 0);
    while first < near_sides.runs() {
        let runs = &mut runs[..piece.min(near_sides.runs() - first)];
        let apply = |(k, run)| narrow.apply_vertex_rule(near_pairs, near_sides.run(first + k), run);
        match &mut *runs {
            [run] => apply((0, run)),
            runs => runs.par_iter_mut().enumerate().for_each(apply),
        }
        let end = made + runs.iter().map(|run| run.accepted.len()).sum::<usize>();
        found.resize(found.len().max(end), FoundContact::default());
        contacts.resize(contacts.len().max(end), VertexEdge::default());
        narrow.make(runs, &mut found[made..end], &mut contacts[made..end]);
        (first, made) = (first + runs.len(), end);
    }
    contacts.truncate(made);
    found.truncate(made);
}

impl NarrowPhase<'_> {
    /// Finds the contacts of a run: candidates that the vertex rule accepts, and those that stay.
    fn apply_vertex_rule(&self, near_pairs: &[NearPair], near: NearRun, run: &mut Run) {
        let Run { accepted, candidates, entered, sides: others, stays, nearest, likely } = run;
        let by_node = || near.near_sides.chunk_by(|a, b| a.node == b.node);
        accepted.clear();
        candidates.clear();
        stays.clear();
        by_node().for_each(|sides| stays.resize(stays.len() + sides.len(), self.stays(sides)));
        nearest.fill(&self.rule, near, stays, self.last);
        list_likely(&nearest.may_enter, likely);
        let candidate = |k: usize| {
            let pair = &near_pairs[(near.near_sides[k].first + nearest.edge[k]) as usize];
            self.rule.candidate(pair, (near.first + k) as u32, nearest.held(k))
        };
        let (mut rest, mut first) = (likely.as_slice(), 0);
        for sides in by_node() {
            let end = first + sides.len();
            let (own, later) = rest.split_at(rest.iter().take_while(|&&k| (k as usize) < end).count());
            rest = later;
            if stays[first] {
                accepted.extend(self.rule.cache.of_node(sides[0].node).map(|known| Accepted::Stays(known as u32)));
            } else if !own.is_empty() {
                let all = || (first..end).map(candidate);
                self.rule.enter(own.iter().map(|&k| candidate(k as usize)), all, entered, others);
                accepted.extend((candidates.len()..).map(|k| Accepted::Found(k as u32)).take(entered.len()));
                candidates.extend_from_slice(entered);
            }
            first = end;
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
