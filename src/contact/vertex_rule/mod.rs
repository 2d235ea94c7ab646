//! The vertex rule: which edges a node may enter (theory §5). A wrong choice locks blocks that should slide.
//!
//! Each file beside this one states one of its four rules; constants are in `contact/constants.rs`.
//! [`VertexRule::enter`] applies them to one node. Before, the narrow phase leaves out sides that no node can enter.
//!
//! ```text
//!     own block   previous ●───────● node ───────● next            loops run with the rock on their left
//!                                  ┊ gap: distance along the normal out of the edge, negative inside the rock
//!     other block     ●────────────┴──────────────────────●        the edge; its side goes on to the next corner
//!                     finish              ←─along─        start    beyond: way from the foot to the edge, if any
//! ```

mod last_step;
mod rule1_entrance_angle;
mod rule2_convex_corners;
mod rule3_one_side;
mod rule4_new_contacts;

use crate::geometry::{Point, Vector};

use super::frame::{EdgeFrame, Frames, right_of};
use super::{Boundary, ContactHistory, ContactState, DetectionRule, EdgeId, NearPair, NodeId, SideId};

pub use last_step::{ContactCache, PenetratingContacts};

/// Boundary, positions and contacts of the last step, as the vertex rule reads them.
#[derive(Clone, Copy)]
pub struct VertexRule<'a> {
    /// Boundary of the blocks.
    pub boundary: &'a Boundary,
    /// Its edges and nodes at their current positions.
    pub frames: &'a Frames,
    /// Contacts of the last step, ordered by node and side.
    pub history: &'a [ContactHistory],
    /// Index of these contacts by node.
    pub cache: &'a ContactCache,
    /// Those in penetration, by node and by node segment.
    pub penetrating: &'a PenetratingContacts,
    /// Mesh size (m).
    pub size: f64,
    /// Constants.
    pub constants: DetectionRule,
    /// Cosine of the angle up to which two faces count as parallel.
    pub flush_cosine: f64,
    /// Gap (m) below which a pair becomes a contact of this step.
    pub reach: f64,
}

/// A pair under test: a node over the nearest edge of one side.
#[derive(Debug, Clone, Copy, Default)]
pub struct ContactCandidate {
    /// Node.
    pub node: NodeId,
    /// Side.
    pub side: SideId,
    /// Edge of the side.
    pub edge: EdgeId,
    /// Index of the near side.
    pub near_side: u32,
    /// Gap (m).
    pub gap: f64,
    /// Distance (m) of the foot of the node from the start of the edge.
    pub along: f64,
    /// Distance (m) of the foot beyond the nearer end of the edge; 0 over the edge.
    pub beyond: f64,
    /// Length (m) of the edge.
    pub length: f64,
    /// Direction of the edge.
    pub tangent: Vector,
    /// The contact of the last step, by its index.
    pub held: Option<u32>,
    /// Whether the contact carried force in the last step.
    pub is_held: bool,
    /// Whether the node is over the edge: it misses it by no more than a bend of the boundary explains.
    pub is_over: bool,
    /// Length (m) along the side over which both blocks overlap before its start and its finish.
    pub lengths: [f64; 2],
    /// Whether the node enters the edge, as far as the rules have been applied.
    pub accepted: bool,
}

impl ContactCandidate {
    /// Distance (m) of the node from the edge.
    pub fn distance(&self) -> f64 {
        distance(self.beyond, self.gap)
    }
}

/// One end of a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    Start,
    Finish,
}

impl VertexRule<'_> {
    /// A pair, before any rule; `near_side` is its index, and `held` that of the contact of the last step.
    #[inline(always)]
    pub fn candidate(&self, pair: &NearPair, near_side: u32, held: Option<u32>) -> ContactCandidate {
        let EdgeFrame { start, tangent, length } = self.frames.edge(pair.edge);
        let from = self.position(pair.node) - start;
        let (along, gap) = (from.dot(&tangent), from.dot(&right_of(tangent)));
        let beyond = (-along).max(along - length).max(0.0);
        ContactCandidate {
            node: pair.node,
            side: pair.side,
            edge: pair.edge,
            near_side,
            gap,
            along,
            beyond,
            length,
            tangent,
            held,
            is_held: held.is_some_and(|known| self.history[known as usize].state != ContactState::Open),
            is_over: beyond <= self.constants.wedge_ratio * gap.abs() + self.constants.held_beyond * self.size,
            lengths: [f64::INFINITY; 2],
            accepted: false,
        }
    }

    /// Applies the rules to one node: leaves in `entered` the sides that it enters. `likely` are near sides without
    /// those that it cannot enter. Rejected sides matter only beside a new contact in penetration: then `all` gives
    /// every near side, in the same order.
    #[inline(always)]
    pub fn enter<All: Iterator<Item = ContactCandidate>>(
        &self,
        likely: impl Iterator<Item = ContactCandidate>,
        all: impl FnOnce() -> All,
        entered: &mut Vec<ContactCandidate>,
        sides: &mut Vec<ContactCandidate>,
    ) {
        entered.clear();
        entered.extend(likely.filter_map(|candidate| self.admit(candidate)));
        if entered.iter().any(|side| !side.is_held & (side.gap < -self.tie())) {
            sides.clear();
            let mut admitted = entered.iter().peekable();
            for side in all().filter(is_considered) {
                sides.push(admitted.next_if(|known| known.side == side.side).copied().unwrap_or(side));
            }
            std::mem::swap(sides, entered);
        }
        self.choose_sides(entered);
        entered.retain(|side| side.accepted);
    }

    /// A candidate that the rules for one side alone accept.
    #[inline(always)]
    pub fn admit(&self, candidate: ContactCandidate) -> Option<ContactCandidate> {
        if !(self.is_near(&candidate) && is_considered(&candidate) && self.faces_edge(&candidate)) {
            return None;
        }
        let lengths = self.lengths_at_ends(&candidate)?;
        (!self.is_spurious(&candidate)).then_some(ContactCandidate { lengths, accepted: true, ..candidate })
    }

    /// Whether the gap, less that of the unloaded spring, is within reach.
    fn is_near(&self, candidate: &ContactCandidate) -> bool {
        let rest = candidate.held.map_or(0.0, |known| self.history[known as usize].unloaded_gap());
        candidate.gap - rest < self.reach
    }

    /// Difference of two depths (m) below which they count as equal.
    fn tie(&self) -> f64 {
        self.constants.tie_tolerance * self.size
    }

    /// Position of a node (m).
    #[inline(always)]
    pub(super) fn position(&self, node: NodeId) -> Point {
        self.frames.node(node).position
    }
}

/// Distance (m) from an edge.
pub(super) fn distance(beyond: f64, gap: f64) -> f64 {
    if beyond > 0.0 { libm::hypot(beyond, gap) } else { gap.abs() }
}

/// Whether the node is over the edge, or carried force in the last step: overlap, not the foot, ends such a contact.
fn is_considered(candidate: &ContactCandidate) -> bool {
    candidate.is_over || candidate.is_held
}
