//! Rule 2, convex corners: two convex corners p and q overlap when their relative position is inside both facets that
//! meet there. The corner leaves through the less deep facet; where the other facet cannot hold, through that of the
//! candidate.
//!
//! At each end of its side a candidate gets the length along the side over which both blocks overlap there: `None`
//! where this side is refused, infinite where the end sets no limit.
//!
//! ```text
//!                                 │ second side of p; own block: rock above the sides of p and to the right of p
//!       other block     ──────────┼───● q                    side s of q: facet (p, s), of depth −gap
//!       rock below s,      depth ╷│   │
//!       to the left of   under s ││   │ side round q         p faces that side as well: the other facet is
//!       the side round q         ╵●───┼────────── p's side   (p, side round q), and its depth the way from p to it
//!                                p│←─→│
//!                                   ╵ depth                  p does not face it: the other facet is (q, the side of p
//!                                                            that turns towards q)
//! ```
//!
//! A facet is a pair of one's corner and a side of the other that it faces. The other facet can hold when its corner is
//! over its side, or when it carries force. Depths are measured with springs unloaded: the penetration that a contact
//! of the last step causes along a direction is the compression of its spring, not depth. For a facet its own contact
//! counts, and all others of p and q and of the node segments next to them. So a block whose foot is pressed into the
//! floor is level with the next block of the floor, and slides onto it. A contact that carries force may lie beyond the
//! end of its side while the corners overlap; the other facet may still take over from it. Faces that lie on each other
//! (within 10°) do not exclude each other.

use crate::contact::{Corner, NodeId, SideEnd, SideId};
use crate::geometry::{Point, Vector};

use super::{ContactCandidate, End, EntranceRule, VertexRule, right_of};

/// The other facet of two convex corners, beside that of a candidate.
struct Facet {
    /// Its corner, of one block.
    tip: NodeId,
    /// Its side, of the other block.
    side: SideId,
    /// Direction out of it.
    out: Vector,
    /// Depth (m) of its corner.
    depth: f64,
    /// Distance (m) of the foot of its corner from the end of its side: negative beyond it.
    foot: f64,
    /// Whether the node's own face lies on the candidate's side.
    is_flush: bool,
    /// Whether q lies behind p's side there: a sharp block has been pierced.
    is_pierced: bool,
}

impl VertexRule<'_> {
    /// Overlap (m) along the side of a candidate with the block before the start and the finish of the side, with
    /// springs unloaded. It is infinite at ends that are far or not corners, and `None` where there is no contact with
    /// this side.
    #[inline(always)]
    pub(super) fn overlap_at_ends(&self, candidate: &ContactCandidate) -> Option<[f64; 2]> {
        let p = self.position(candidate.node);
        let tolerance = self.corner_tolerance(candidate);
        let mut overlap = [f64::INFINITY; 2];
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
            let corner = self.frames.position(at.point);
            if (p - corner).norm_squared() < self.size * self.size {
                overlap[end as usize] = self.overlap_round(candidate, p, end)?;
            }
        }
        Some(overlap)
    }

    /// Overlap (m) along a side with the block before a convex `end` of the side, with springs unloaded; `None` without
    /// overlap, or where the facet there is less deep.
    fn overlap_round(&self, candidate: &ContactCandidate, p: Point, end: End) -> Option<f64> {
        let facet = self.other_facet(candidate, p, end);
        let tolerance = self.corner_tolerance(candidate);
        if facet.depth < -tolerance {
            let stays = facet.is_flush && facet.is_pierced || self.is_kept(candidate, end);
            return stays.then_some(f64::INFINITY);
        }
        let rule = &self.constants;
        let slope = facet.out.dot(&candidate.tangent).abs().max(f64::MIN_POSITIVE);
        if -candidate.gap < rule.closure_most * self.size && facet.depth > rule.clear_depth() * self.size {
            return Some(facet.depth / slope);
        }
        let q = self.boundary.node_before[self.boundary.sides.ends[candidate.side][end as usize].point];
        let compression = |own: f64, out: Vector| own.max(self.closure_of_others(candidate.node, q, out));
        let unloaded = facet.depth - compression(self.closure_with(facet.tip, facet.side), facet.out);
        let can_hold = facet.foot >= -tolerance || self.carries(facet.tip, facet.side);
        if facet.is_flush || !can_hold {
            return Some(unloaded / slope);
        }
        let own = candidate.held.map_or(0.0, |known| -candidate.gap * self.history[known as usize].share);
        let own_unloaded = || -candidate.gap - compression(own, right_of(candidate.tangent));
        let most = unloaded + self.tie();
        (-candidate.gap <= most || own_unloaded() <= most).then_some(unloaded / slope)
    }

    /// The facet next to that of a candidate, whose node is at `p`, where its side ends in a convex corner q.
    #[inline(always)]
    fn other_facet(&self, candidate: &ContactCandidate, p: Point, end: End) -> Facet {
        let (boundary, node) = (self.boundary, candidate.node);
        let SideEnd { round, point, .. } = boundary.sides.ends[candidate.side][end as usize];
        let (q, tangent) = (self.frames.position(point), self.frames.edge(round).tangent);
        let outward = right_of(tangent);
        let frame = self.frames.node(node);
        let (own, distance) = (frame.to[end as usize], frame.distance[end as usize]);
        let facing = if end == End::Start { right_of(-own) } else { right_of(own) } / distance;
        let is_flush = -facing.dot(&right_of(candidate.tangent)) > self.flush_cosine;
        let is_pierced = (q - p).dot(&facing) <= 0.0;
        if is_flush || own.dot(&outward) >= 0.0 {
            let away = if end == End::Finish { tangent } else { -tangent };
            let (side, foot, depth) = (boundary.side[round], (p - q).dot(&away), (q - p).dot(&outward));
            return Facet { tip: node, side, out: outward, depth, foot, is_flush, is_pierced };
        }
        let (tip, side) = (boundary.node_before[point], boundary.sides_of_node(node)[end as usize]);
        let (foot, depth) = ((q - p).dot(&own) / distance, (q - p).dot(&-facing));
        Facet { tip, side, out: -facing, depth, foot, is_flush, is_pierced }
    }

    /// Distance (m) by which a node and a corner of another block separate along a direction, out of that block, when
    /// the springs of their other contacts are unloaded.
    fn closure_of_others(&self, node: NodeId, corner: NodeId, out: Vector) -> f64 {
        let [own, others] = [node, corner].map(|node| self.boundary.sides_of_node(node));
        self.closure_along(node, out, others).max(self.closure_along(corner, -out, own))
    }

    /// Whether a contact that carries force is kept beyond an end of its side.
    fn is_kept(&self, candidate: &ContactCandidate, end: End) -> bool {
        candidate.is_held && self.overlap_at(candidate, end) >= 0.0
    }

    /// Depth (m) of the node inside the facet round an end of the side, or of the corner there inside both facets of
    /// the node, unless that corner is a contact itself; negative where the two have separated.
    pub(in crate::contact) fn overlap_at(&self, candidate: &ContactCandidate, end: End) -> f64 {
        let at = self.boundary.sides.ends[candidate.side][end as usize];
        let frame = self.frames.node(candidate.node);
        let to = self.frames.position(at.point) - frame.position;
        let inside = to.dot(&self.frames.edge(at.round).normal());
        let depths = [to.perp(&frame.to[0]) / frame.distance[0], frame.to[1].perp(&to) / frame.distance[1]];
        let depth = depths[0].min(depths[1]);
        let (corner, own) = (self.boundary.node_before[at.point], self.boundary.sides_of_node(candidate.node));
        let is_corner = frame.is_convex(self.constants.flush_sine);
        let is_covered = is_corner && depth > inside && !self.carries(corner, own[end as usize]);
        if is_covered { depth } else { inside }
    }

    /// Distance (m) beyond a corner that counts as the corner.
    fn corner_tolerance(&self, candidate: &ContactCandidate) -> f64 {
        let EntranceRule { held_beyond, corner_tolerance, .. } = self.constants;
        self.size * if candidate.is_held { held_beyond } else { corner_tolerance }
    }
}
