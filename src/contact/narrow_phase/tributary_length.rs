//! Tributary length of a contact: the share of the joint length that belongs to it (Eq. 13).

use crate::contact::constants::CORNER_SHARE;
use crate::contact::vertex_rule::End;
use crate::contact::{Corner, DetectionRule, NodeId};

use super::{ContactCandidate, NarrowPhase};

/// Lengths over which a node acts on an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tributary {
    /// Tributary length (m).
    pub length: f64,
    /// Length of joint (m) on which cohesion and tension act: faces that lie along each other, without those that meet
    /// at an angle. Where a joint ends on another one, the corners beside it have faces on both, and each face counts
    /// on its own joint alone.
    pub bonded: f64,
    /// Length for the default stiffness (m).
    pub penalty: f64,
    /// Share of its strength that the contact has.
    pub share: f64,
    /// Whether it keeps its stiffness through an impact: all but a corner that shares its lengths with another one.
    pub keeps: bool,
}

/// Lengths of the node segments that face a side (m), as far as they count.
#[derive(Debug, Clone, Copy, Default)]
struct Facing {
    /// Segments that lie along the side.
    flush: f64,
    /// Others.
    oblique: f64,
}

impl NarrowPhase<'_> {
    /// Lengths over which a node acts on an edge (Eq. 13). Where corners meet they are those of the overlap with
    /// springs unloaded: only the part of a face that lies against the other one carries force.
    #[inline(always)]
    pub(super) fn tributary(&self, node: NodeId, candidate: &ContactCandidate) -> Tributary {
        let DetectionRule { ledge, length_floor, stiffness_floor, .. } = self.rule.constants;
        let ramp = |overlap: f64| (overlap / (ledge * self.rule.size) - 1.0).clamp(0.0, 1.0);
        let at_ends = ramp(candidate.lengths[0].min(candidate.lengths[1]));
        let Facing { flush, oblique } = self.facing(node, candidate);
        let share = at_ends.max(ramp(flush));
        let span = 0.5 * self.rule.frames.node(node).distance.iter().sum::<f64>();
        let least = length_floor * span;
        let (length, bonded) = ((0.5 * (flush + at_ends * oblique)).max(least), (0.5 * flush).max(least));
        let penalty = length.max(stiffness_floor * span * share);
        let at_corner = self.share_at_corner(node, candidate);
        let keeps = at_corner == 1.0 || !self.rule.boundary.nodes.convex[node];
        Tributary { length: length * at_corner, bonded: bonded * at_corner, penalty: penalty * at_corner, share, keeps }
    }

    /// Node segments that end at a node and face the edge, as far as they lie over its node segment; those along the
    /// side no farther than the overlap at its ends.
    #[inline(always)]
    fn facing(&self, node: NodeId, candidate: &ContactCandidate) -> Facing {
        let boundary = self.rule.boundary;
        let frame = self.rule.frames.node(node);
        let p = frame.position.dot(&candidate.tangent);
        let before = boundary.node_before[candidate.edge];
        let after = boundary.nodes.next[before];
        let position = |n: NodeId| self.rule.position(n).dot(&candidate.tangent);
        let (from, to) = (position(before), position(after));
        let over = |q: f64| (p.max(q).min(to) - p.min(q).max(from)).max(0.0);
        let [q, r] = [boundary.nodes.previous[node], boundary.nodes.next[node]].map(position);
        let [low, high] = self.tie_shares(node, candidate, before, [p - from, to - p]);
        let flush_cosine = self.rule.flush_cosine;
        let mut facing = Facing::default();
        let mut add = |over: f64, along: f64, distance: f64, overlap: f64| {
            if along > flush_cosine * distance {
                facing.flush += over.min(overlap.max(0.0));
            } else {
                facing.oblique += over;
            }
        };
        if q > p {
            let beyond = self.reach_beyond(high, boundary.nodes.next[after], [to, q], candidate);
            add(over(q) + beyond, q - p, frame.distance[0], candidate.lengths[1]);
        }
        if r < p {
            let beyond = self.reach_beyond(low, boundary.nodes.previous[before], [from, r], candidate);
            add(over(r) + beyond, p - r, frame.distance[1], candidate.lengths[0]);
        }
        facing
    }

    /// Share that a convex corner keeps of the node segments beyond the ends of the one under it, by its distances (m)
    /// from those ends: 1 at an inner node of the other side, 0 beyond the band in which that node takes over.
    #[inline(always)]
    fn tie_shares(&self, node: NodeId, candidate: &ContactCandidate, before: NodeId, distances: [f64; 2]) -> [f64; 2] {
        let (boundary, band) = (self.rule.boundary, self.rule.constants.held_beyond * self.rule.size);
        if !boundary.nodes.convex[node] {
            return [0.0; 2];
        }
        let is_inner = |k: usize| match k {
            0 => boundary.sides.ends[candidate.side][0].edge != boundary.nodes.point[before],
            _ => boundary.side[boundary.nodes.point[boundary.nodes.next[before]]] == candidate.side,
        };
        [0, 1].map(|k| {
            let is_near = distances[k] < band && is_inner(k);
            if is_near { (1.0 - distances[k] / band).clamp(0.0, 1.0) } else { 0.0 }
        })
    }

    /// Share of the length (m) of a node segment from its end at `at` that the part up to `target` covers, along the
    /// candidate's edge.
    #[inline(always)]
    fn reach_beyond(&self, share: f64, far: NodeId, [at, target]: [f64; 2], candidate: &ContactCandidate) -> f64 {
        if share == 0.0 {
            return 0.0;
        }
        let far = self.rule.position(far).dot(&candidate.tangent);
        share * if target > at { (target.min(far) - at).max(0.0) } else { (at - target.max(far)).max(0.0) }
    }

    /// 1 inside a side; at its convex ends ½ for a corner, since the corner there is a contact as well, and 0 for an
    /// inner node, whose segments belong to that corner. The share of a contact that the overlap of the corners keeps
    /// fades with that overlap.
    #[inline(always)]
    fn share_at_corner(&self, node: NodeId, candidate: &ContactCandidate) -> f64 {
        let band = self.rule.constants.held_beyond * self.rule.size;
        let least = if self.rule.boundary.nodes.convex[node] { CORNER_SHARE } else { 0.0 };
        let mut share = 1.0f64;
        for (end, within) in [(End::Start, candidate.along), (End::Finish, candidate.length - candidate.along)] {
            let at = self.rule.boundary.sides.ends[candidate.side][end as usize];
            if within < band && at.edge == candidate.edge && at.corner == Corner::Convex {
                let kept = |overlap: f64| within.max((overlap - band).min(0.0));
                let is_past = candidate.is_held && within < 0.0;
                let within = if is_past { kept(self.rule.depth_at_end(candidate, end)) } else { within };
                share = share.min(least + (1.0 - least) * within / band);
            }
        }
        share.clamp(self.rule.constants.share_floor, 1.0)
    }
}
