//! Tributary lengths of nodes over edges (Eq. 13).

use crate::contact::Corner;

use super::rule::End;
use super::{HELD_BEYOND, Narrow, Pick};

/// Least tributary length, relative to the mean of the neighbouring node segments.
const LENGTH_FLOOR: f64 = 1e-3;
/// The same for the solver's own stiffness: rock that meets in a point is no softer than where it meets in a face.
const PENALTY_LENGTH_FLOOR: f64 = 0.5;

impl Narrow<'_> {
    /// Tributary length (m) of a node over an edge, and the length of the solver's own stiffness (Eq. 13).
    #[inline(always)]
    pub(super) fn tributary(&self, node: usize, pick: &Pick) -> (f64, f64) {
        let boundary = self.boundary;
        let frame = &self.frames.nodes[node];
        let p = frame.place.dot(&pick.tangent);
        let before = boundary.node_before[pick.edge as usize] as usize;
        let from = self.node_place(before).dot(&pick.tangent);
        let to = self.node_place(boundary.node_next[before] as usize).dot(&pick.tangent);
        let overlap = |q: f64| (p.max(q).min(to) - p.min(q).max(from)).max(0.0);
        let [q, r] = [boundary.node_previous[node], boundary.node_next[node]]
            .map(|n| self.node_place(n as usize).dot(&pick.tangent));
        let [low, high] = self.tie_shares(node, pick, before, [p - from, to - p]);
        let mut facing = 0.0;
        if q > p {
            let mut over = overlap(q);
            if high > 0.0 {
                let beyond = boundary.node_next[boundary.node_next[before] as usize];
                over += high * self.reach_beyond(beyond, to, q, pick);
            }
            facing += over;
        }
        if r < p {
            let mut over = overlap(r);
            if low > 0.0 {
                over += low * self.reach_beyond(boundary.node_previous[before], from, r, pick);
            }
            facing += over;
        }
        let share = self.share_at_corner(node, pick);
        let span = 0.5 * (frame.distance[0] + frame.distance[1]);
        let length = (0.5 * facing).max(LENGTH_FLOOR * span);
        let stiff = length.max(PENALTY_LENGTH_FLOOR * span);
        (length * share, stiff * share)
    }

    /// What a convex corner keeps of the node segments beyond the ends of the one under it, for its distances (m) from
    /// those ends: all at an inner node of the other side and nothing beyond the band in which that node takes over.
    #[inline(always)]
    fn tie_shares(&self, node: usize, pick: &Pick, before: usize, distances: [f64; 2]) -> [f64; 2] {
        let (boundary, band) = (self.boundary, HELD_BEYOND * self.size);
        if !boundary.node_convex[node] {
            return [0.0; 2];
        }
        let is_inner = |k: usize| match k {
            0 => boundary.side_first[pick.side as usize] != boundary.node_point[before],
            _ => {
                let after = boundary.node_point[boundary.node_next[before] as usize] as usize;
                boundary.side[after] == pick.side
            }
        };
        [0, 1].map(|k| {
            let is_near = distances[k] < band && is_inner(k);
            if is_near { (1.0 - distances[k] / band).clamp(0.0, 1.0) } else { 0.0 }
        })
    }

    /// Length (m) of a node segment from its end at `at` that the part up to `target` covers, along the pick's edge.
    #[inline(always)]
    fn reach_beyond(&self, far: u32, at: f64, target: f64, pick: &Pick) -> f64 {
        let far = self.node_place(far as usize).dot(&pick.tangent);
        if target > at { (target.min(far) - at).max(0.0) } else { (at - target.max(far)).max(0.0) }
    }

    /// 1 inside a side; at its convex ends ½ for a corner, since the corner there is a contact as well, and nothing for
    /// an inner node, whose segments that corner has. One that is kept by the overlap of the corners fades with it.
    #[inline(always)]
    fn share_at_corner(&self, node: usize, pick: &Pick) -> f64 {
        let band = HELD_BEYOND * self.size;
        let least = if self.boundary.node_convex[node] { 0.5 } else { 0.0 };
        let mut share = 1.0f64;
        for (end, within) in [(End::Start, pick.along), (End::Finish, pick.length - pick.along)] {
            let at = self.boundary.side_ends[pick.side as usize][end as usize];
            if within < band && at.edge == pick.edge && at.corner == Corner::Convex {
                let kept = |overlap: f64| within.max((overlap - band).min(0.0));
                let is_past = pick.is_held && within < 0.0;
                let within = if is_past { kept(self.overlap_at(node, pick, end)) } else { within };
                share = share.min(least + (1.0 - least) * within / band);
            }
        }
        share.clamp(1e-3, 1.0)
    }
}
