//! Rule 2, convex corners: of two convex corners p and q that overlap, p leaves through the less deep facet.
//!
//! Depths are measured with springs unloaded: the penetration that a contact of the last step causes along a direction
//! is the compression of its spring, not depth. So a block whose foot is pressed into the floor is level with the next
//! block of the floor, and slides onto it instead of catching on its end face.
//!
//! A facet is a corner of one block and a side of the other that it faces. The candidate is the facet (p, s), of depth
//! −gap. Beside it, where the side s ends in q, lies the other facet:
//!
//! ```text
//!                     │ p's block: rock                   other facet: (p, the side round q)
//!                     │
//!       ──────────────┼─────● q           side s
//!                     │     │
//!                   p ●─────┼───────────  p's side
//!       q's block:     ←───→
//!       rock          depth │ side round q
//! ```
//!
//! This is so where p's side and the side round q face each other. Where p's side turns away from it, the other facet
//! is (q, that side of p), and its depth is the way from q to that side.
//!
//! - The other facet can hold when its corner is over its side, or when it carries force; else p leaves through s.
//! - Faces that lie on each other (within 10°) do not exclude each other: p leaves through s.
//! - Where the corners no longer overlap, s is refused, unless its contact carries force or q lies under p's own face.
//!   A contact that carries force stays so beyond the end of its side; the other facet may still take over from it.
//! - A node that is no corner holds its side in an impact, and beyond the end of it while the corner there strikes too.
//! - A reflex end refuses only a node whose foot lies past it and which is not over the edge.
//!
//! The compression along a direction is the largest of those of the facet's own contact and of all other contacts of p
//! and q and of the node segments next to them. It is no sum, because these springs act side by side.

use crate::contact::{Corner, NodeId, SideEnd, SideId};
use crate::geometry::{Point, Vector};

use super::{ContactCandidate, DetectionRule, End, VertexRule, right_of};

/// The other facet of two convex corners, beside that of a candidate.
struct Facet {
    /// Its corner, of one block.
    corner: NodeId,
    /// Its side, of the other block.
    side: SideId,
    /// Direction out of it.
    out: Vector,
    /// Depth (m) of its corner, springs included.
    depth: f64,
    /// Distance (m) of the foot of its corner from the end of its side, to the inside: negative beyond the end.
    inset: f64,
    /// Whether p's own face lies on the candidate's side.
    is_flush: bool,
    /// Whether q lies under p's own face.
    is_under: bool,
}

impl VertexRule<'_> {
    /// Length (m) along the side of a candidate over which both blocks overlap, before its start and before its finish:
    /// infinite at an end that sets no limit, since it is far or reflex, or the contact is kept beyond it. `None` where
    /// one of the ends refuses the candidate.
    #[inline(always)]
    pub(super) fn lengths_at_ends(&self, candidate: &ContactCandidate) -> Option<[f64; 2]> {
        if self.is_struck(candidate) {
            return Some([f64::INFINITY; 2]);
        }
        let p = self.position(candidate.node);
        let tolerance = self.corner_tolerance(candidate);
        let mut lengths = [f64::INFINITY; 2];
        for end in [End::Start, End::Finish] {
            let at = self.boundary.sides.ends[candidate.side][end as usize];
            let past = match end {
                End::Start => candidate.along < 0.0,
                End::Finish => candidate.along > candidate.length,
            } && at.edge == candidate.edge;
            if at.corner == Corner::Reflex {
                if past && !candidate.is_over {
                    return None;
                }
                continue;
            }
            let missed = past && candidate.beyond > tolerance;
            if missed && !self.is_kept(candidate, end) {
                return None;
            }
            // No node segment is longer than a mesh size: an end that is farther limits none.
            let q = self.frames.position(at.point);
            if (p - q).norm_squared() < self.size * self.size {
                lengths[end as usize] = self.length_at_end(candidate, p, end)?;
            }
        }
        Some(lengths)
    }

    /// Whether an impact holds the candidate: its foot is on the side, or the corner that it has passed strikes too,
    /// which would take over with a spring of its own.
    #[inline(always)]
    fn is_struck(&self, candidate: &ContactCandidate) -> bool {
        let strikes = |known: u32| self.history[known as usize].meeting.kept_stiffness > 0.0;
        if !candidate.is_held || self.boundary.nodes.convex[candidate.node] || !candidate.held.is_some_and(strikes) {
            return false;
        }
        let corner_strikes = || {
            let end = self.boundary.sides.ends[candidate.side][usize::from(candidate.along > 0.0)];
            let (corner, sides) = (self.boundary.node_before[end.point], self.boundary.sides_of_node(candidate.node));
            let mut known = self.cache.of_node(corner);
            known.any(|k| sides.contains(&self.history[k].side) && strikes(k as u32))
        };
        candidate.beyond == 0.0 || corner_strikes()
    }

    /// Length (m) along the side before a convex `end` over which both blocks overlap; infinite where the contact is
    /// kept without overlap. `None` where the corners have separated, or the other facet is less deep.
    fn length_at_end(&self, candidate: &ContactCandidate, p: Point, end: End) -> Option<f64> {
        let facet = self.other_facet(candidate, p, end);
        let tolerance = self.corner_tolerance(candidate);
        if facet.depth < -tolerance {
            let stays = (facet.is_flush && facet.is_under) || self.is_kept(candidate, end);
            return stays.then_some(f64::INFINITY);
        }
        let constants = &self.constants;
        let slope = facet.out.dot(&candidate.tangent).abs().max(f64::MIN_POSITIVE);
        // No spring is so long that it would change the order of such depths, or the length by more than half.
        if -candidate.gap < constants.closure_most * self.size && facet.depth > constants.clear_depth() * self.size {
            return Some(facet.depth / slope);
        }
        let q = self.boundary.node_before[self.boundary.sides.ends[candidate.side][end as usize].point];
        let [sides_of_p, sides_of_q] = [candidate.node, q].map(|node| self.boundary.sides_of_node(node));
        let of_p = |out: Vector| self.closure_along(candidate.node, out, sides_of_q);
        let compression = |closure: f64, out| closure.max(of_p(out)).max(self.closure_along(q, -out, sides_of_p));
        let unloaded = facet.depth - compression(self.closure_with(facet.corner, facet.side), facet.out);
        let can_hold = facet.inset >= -tolerance || self.carries(facet.corner, facet.side);
        if facet.is_flush || !can_hold {
            return Some(unloaded / slope);
        }
        let closure = candidate.held.map_or(0.0, |known| -candidate.gap * self.history[known as usize].share);
        let candidate_unloaded = || -candidate.gap - compression(closure, right_of(candidate.tangent));
        let most = unloaded + self.tie();
        // The first comparison spares the search for springs, which only make the depth smaller.
        (-candidate.gap <= most || candidate_unloaded() <= most).then_some(unloaded / slope)
    }

    /// The facet next to that of a candidate, whose node is at `p`, where its side ends in a convex corner q.
    #[inline(always)]
    fn other_facet(&self, candidate: &ContactCandidate, p: Point, end: End) -> Facet {
        let (boundary, node) = (self.boundary, candidate.node);
        let SideEnd { round, point, .. } = boundary.sides.ends[candidate.side][end as usize];
        let (q, tangent) = (self.frames.position(point), self.frames.edge(round).tangent);
        let out_of_round = right_of(tangent);
        // Loops of two blocks that face each other run against each other: at the start of a side lies the way to the
        // node before p, at its finish that to the node after it.
        let frame = self.frames.node(node);
        let (to_neighbour, distance) = (frame.to[end as usize], frame.distance[end as usize]);
        let out_of_own = if end == End::Start { right_of(-to_neighbour) } else { right_of(to_neighbour) } / distance;
        let is_flush = -out_of_own.dot(&right_of(candidate.tangent)) > self.flush_cosine;
        let is_under = (q - p).dot(&out_of_own) <= 0.0;
        if is_flush || to_neighbour.dot(&out_of_round) >= 0.0 {
            let inwards = if end == End::Finish { tangent } else { -tangent };
            let (side, inset, depth) = (boundary.side[round], (p - q).dot(&inwards), (q - p).dot(&out_of_round));
            return Facet { corner: node, side, out: out_of_round, depth, inset, is_flush, is_under };
        }
        let (corner, side) = (boundary.node_before[point], boundary.sides_of_node(node)[end as usize]);
        let (inset, depth) = ((q - p).dot(&to_neighbour) / distance, (q - p).dot(&-out_of_own));
        Facet { corner, side, out: -out_of_own, depth, inset, is_flush, is_under }
    }

    /// Whether a contact that carries force is kept beyond an end of its side.
    fn is_kept(&self, candidate: &ContactCandidate, end: End) -> bool {
        candidate.is_held && self.depth_at_end(candidate, end) >= 0.0
    }

    /// Depth (m) to which the corners p and q overlap at an end of the side; negative where they have separated. It is
    /// that of p behind the side round q. Where p's corner covers q to a greater depth, that of q behind p's sides
    /// counts, unless q carries force there: its own contact then measures it.
    pub(in crate::contact) fn depth_at_end(&self, candidate: &ContactCandidate, end: End) -> f64 {
        let at = self.boundary.sides.ends[candidate.side][end as usize];
        let frame = self.frames.node(candidate.node);
        let to_q = self.frames.position(at.point) - frame.position;
        let of_p = to_q.dot(&self.frames.edge(at.round).normal());
        let behind = [to_q.perp(&frame.to[0]) / frame.distance[0], frame.to[1].perp(&to_q) / frame.distance[1]];
        let of_q = behind[0].min(behind[1]);
        let (q, sides_of_p) = (self.boundary.node_before[at.point], self.boundary.sides_of_node(candidate.node));
        let is_corner = frame.is_convex(self.constants.flush_sine);
        let is_covered = is_corner && of_q > of_p && !self.carries(q, sides_of_p[end as usize]);
        if is_covered { of_q } else { of_p }
    }

    /// Distance (m) beyond a corner that counts as the corner.
    fn corner_tolerance(&self, candidate: &ContactCandidate) -> f64 {
        let DetectionRule { held_beyond, corner_tolerance, .. } = self.constants;
        self.size * if candidate.is_held { held_beyond } else { corner_tolerance }
    }
}
