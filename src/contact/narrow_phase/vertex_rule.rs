//! The vertex rule (theory §5): which of the sides near a node it may enter. A wrong choice locks blocks that should
//! slide. Rule 1 is applied in `nearest.rs`, eight near sides at once.

use crate::contact::frame::right_of;
use crate::contact::{ContactState, Corner, EdgeId, NodeId, SideEnd, SideId};
use crate::geometry::{Point, Vector};

use super::{ContactCandidate, NarrowPhase, TIE_TOLERANCE};

/// One end of a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    Start,
    Finish,
}

impl NarrowPhase<'_> {
    /// Rule 2: overlap (m) along the side of a node with the block before the start and the finish of the side, with
    /// springs unloaded. It is infinite at ends that are far or not corners, and `None` where there is no contact with
    /// this side.
    pub(super) fn overlap_at_ends(&self, node: NodeId, candidate: &ContactCandidate) -> Option<[f64; 2]> {
        let p = self.node_position(node);
        let tolerance = self.corner_tolerance(candidate);
        let mut overlap = [f64::INFINITY; 2];
        for end in [End::Start, End::Finish] {
            let at = self.boundary.side_ends[candidate.side][end as usize];
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
            if missed && !self.is_kept(node, candidate, end) {
                return None;
            }
            let corner = self.frames.position(at.point);
            if (p - corner).norm_squared() < self.size * self.size {
                overlap[end as usize] = self.overlap_round(node, candidate, p, end)?;
            }
        }
        Some(overlap)
    }

    /// Overlap (m) along a side of a node with the block before a convex `end` of the side, with springs unloaded;
    /// `None` without overlap, or where the facet there is less deep.
    ///
    /// Two convex corners p and q overlap when they are inside both facets next to their meeting: pairs of one's corner
    /// and a side of the other that it faces. Next to (p, side) comes (p, the side round q), where p faces that as
    /// well, or else (q, the side of p that turns towards it). The corner leaves through the less deep facet of those
    /// that can hold it: whose corner is over the side, or that carry force. The compression of springs, of this facet
    /// or of others beside it, does not count as depth. Parallel faces do not exclude each other; a sharp block may be
    /// pierced: the node is then beyond the facet round its tip.
    fn overlap_round(&self, node: NodeId, candidate: &ContactCandidate, p: Point, end: End) -> Option<f64> {
        let boundary = self.boundary;
        let SideEnd { round, point: corner, .. } = boundary.side_ends[candidate.side][end as usize];
        let meets = boundary.node_before[corner];
        let (q, outward) = (self.frames.position(corner), self.frames.edge(round).normal());
        let frame = self.frames.node(node);
        let (own, distance) = (frame.to[end as usize], frame.distance[end as usize]);
        let facing = if end == End::Start { right_of(-own) } else { right_of(own) } / distance;
        let normal = right_of(candidate.tangent);
        let flush = -facing.dot(&normal) > self.flush_cosine;
        let faces_round = flush || own.dot(&outward) >= 0.0;
        let out = if faces_round { outward } else { -facing };
        let depth = (q - p).dot(&out);
        if depth < -self.corner_tolerance(candidate) {
            let pierced = flush && (q - p).dot(&facing) <= 0.0;
            return (pierced || self.is_kept(node, candidate, end)).then_some(f64::INFINITY);
        }
        let most = self.rule.closure_most * self.size;
        let along = out.dot(&candidate.tangent).abs().max(f64::MIN_POSITIVE);
        if -candidate.gap < most && depth > 2.0 * most {
            return Some(depth / along);
        }
        let (tip, facet, foot) = if faces_round {
            (node, boundary.side[round], (p - q).dot(&self.away(round, end)))
        } else {
            (meets, boundary.sides_of_node(node)[end as usize], (q - p).dot(&own) / distance)
        };
        let beyond = depth - self.closure_with(tip, facet).max(self.let_in_by_others(node, meets, out));
        let can_hold = foot >= -self.corner_tolerance(candidate) || self.carries(tip, facet);
        if flush || !can_hold {
            return Some(beyond / along);
        }
        let closure = candidate.held.map_or(0.0, |known| -candidate.gap * self.history[known as usize].share);
        let tie = TIE_TOLERANCE * self.size;
        let way_out = || -candidate.gap - closure.max(self.let_in_by_others(node, meets, normal));
        (-candidate.gap <= beyond + tie || way_out() <= beyond + tie).then_some(beyond / along)
    }

    /// Direction of the side round an end of another, away from that end.
    fn away(&self, round: EdgeId, end: End) -> Vector {
        let tangent = self.frames.edge(round).tangent;
        if end == End::Finish { tangent } else { -tangent }
    }

    /// Distance (m) by which a node and a corner of another block separate along a direction, out of that block, when
    /// the springs of their other contacts are unloaded.
    fn let_in_by_others(&self, node: NodeId, corner: NodeId, out: Vector) -> f64 {
        let [own, others] = [node, corner].map(|node| self.boundary.sides_of_node(node));
        self.let_in(node, out, others).max(self.let_in(corner, -out, own))
    }

    /// Whether a contact that carries force is kept beyond an end of its side.
    fn is_kept(&self, node: NodeId, candidate: &ContactCandidate, end: End) -> bool {
        candidate.is_held && self.overlap_at(node, candidate, end) >= 0.0
    }

    /// Depth (m) of the node inside the facet round an end of the side, or of the corner there inside both facets of
    /// the node, unless that corner is a contact itself; negative where the two have separated.
    pub(super) fn overlap_at(&self, node: NodeId, candidate: &ContactCandidate, end: End) -> f64 {
        let at = self.boundary.side_ends[candidate.side][end as usize];
        let frame = self.frames.node(node);
        let to = self.frames.position(at.point) - frame.position;
        let inside = to.dot(&self.frames.edge(at.round).normal());
        let depths = [to.perp(&frame.to[0]) / frame.distance[0], frame.to[1].perp(&to) / frame.distance[1]];
        let depth = depths[0].min(depths[1]);
        let is_covered = frame.is_convex(self.rule.flush_sine) && depth > inside && !self.is_borne(node, at.point, end);
        if is_covered { depth } else { inside }
    }

    /// Whether the corner at an end of a side carried force against the node's own side towards that end.
    fn is_borne(&self, node: NodeId, corner: EdgeId, end: End) -> bool {
        self.carries(self.boundary.node_before[corner], self.boundary.sides_of_node(node)[end as usize])
    }

    /// Whether a node carried force against a side in the last step.
    fn carries(&self, node: NodeId, side: SideId) -> bool {
        self.known(node).iter().any(|h| h.side == side && h.state != ContactState::Open)
    }

    /// Rule 3: of the sides of one block that the node is over, it enters only one, unless they form a notch: the one
    /// that carries force, or else the less deep one. A node outside a near side is not inside a side behind it either.
    pub(super) fn choose_sides(&self, candidates: &mut [ContactCandidate]) {
        let block = |p: &ContactCandidate| self.boundary.block[p.edge];
        for i in 0..candidates.len() {
            for j in i + 1..candidates.len() {
                let (a, b) = (&candidates[i], &candidates[j]);
                if block(a) != block(b) || self.is_notch(a.side, b.side) {
                    continue;
                }
                if let Some(first) = self.loser(a, b) {
                    candidates[if first { i } else { j }].accepted = false;
                }
            }
        }
    }

    /// Whether two sides meet in a notch.
    fn is_notch(&self, s: SideId, t: SideId) -> bool {
        let at = &self.boundary.side_ends[s];
        self.end_between(s, t).is_some_and(|end| at[end as usize].corner == Corner::Reflex)
    }

    /// The end of side `s` at which it meets side `t`.
    pub(super) fn end_between(&self, s: SideId, t: SideId) -> Option<End> {
        if self.boundary.side_next[s] == t {
            Some(End::Finish)
        } else {
            (self.boundary.side_previous[s] == t).then_some(End::Start)
        }
    }

    /// Which of two sides with rock between them the node does not enter: true for the first. Sides that do not meet
    /// have rock between them when they face away from each other and the foot of the node on the deeper one lies
    /// behind the other.
    fn loser(&self, a: &ContactCandidate, b: &ContactCandidate) -> Option<bool> {
        let first_is_deeper = a.gap < b.gap;
        let (deep, shallow) = if first_is_deeper { (a, b) } else { (b, a) };
        let cosine = deep.tangent.dot(&shallow.tangent);
        let opposed = cosine < -self.rule.opposed_cosine && shallow.gap < deep.gap * cosine;
        let end = self.end_between(deep.side, shallow.side);
        if end.is_none() && !opposed {
            return None;
        }
        let behind = -deep.gap > shallow.gap.abs() + TIE_TOLERANCE * self.size;
        let deep_loses = if deep.is_held {
            shallow.is_held && shallow.accepted
        } else {
            behind && end.is_none() && shallow.gap > 0.0 || shallow.accepted && (shallow.is_held || shallow.gap <= 0.0)
        };
        if deep_loses {
            return Some(first_is_deeper);
        }
        let contest = deep.gap <= 0.0 && shallow.gap <= 0.0 && deep.accepted && shallow.accepted;
        contest.then_some(!first_is_deeper)
    }
}
