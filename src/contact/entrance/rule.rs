//! The vertex rule of theory §6: which of the sides near a node it may enter.

use crate::contact::{ContactState, Corner, SideEnd};
use crate::cover;
use crate::geometry::Point;

use super::{ENTRANCE_SINE, Narrow, Pick, TIE_TOLERANCE, faces, right_of};

/// Height of a ledge, relative to the mesh size, that catches nothing: a corner that comes on by more in a step passes.
const LEDGE: f64 = 5e-4;
/// Share of its depth to which another facet must be shallower for a deep contact to give way.
const SHALLOWER: f64 = 0.25;
/// Cosine from which two sides of a block look apart, with rock between them: 60°.
const OPPOSED_COSINE: f64 = 0.5;
/// Cosine from which two faces that look at each other lie on each other: 10°.
const FLUSH_COSINE: f64 = 0.985;

/// One end of a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    Start,
    Finish,
}

impl Narrow<'_> {
    /// Rule (ii): at a convex end of the side the node is not beyond the end, and not past the facet round it.
    pub(super) fn within(&self, node: usize, pick: &Pick) -> bool {
        let p = self.node_place(node);
        let tolerance = self.corner_tolerance(pick);
        [End::Start, End::Finish].into_iter().all(|end| {
            let at = self.boundary.side_ends[pick.side as usize][end as usize];
            if at.corner == Corner::Reflex {
                return true;
            }
            let past = match end {
                End::Start => pick.along < 0.0,
                End::Finish => pick.along > pick.length,
            };
            let missed = at.edge == pick.edge && past && pick.beyond > tolerance;
            if missed && !self.is_kept(node, pick, end) {
                return false;
            }
            let corner = self.place[at.point as usize];
            (p - corner).norm_squared() >= self.size * self.size || self.is_inside_round(node, pick, p, end)
        })
    }

    /// Whether the node, at a convex `end` of the side, is inside the facet that meets this one there.
    ///
    /// Two convex corners p and q overlap when they are inside both facets next to their meeting: pairs of one's
    /// corner and a side of the other that it faces. Next to (p, side) comes (p, the side round q), where p faces
    /// that as well, or else (q, the side of p that turns towards it). Inside both, the node enters this one if it
    /// carries force, or if it is the shallower and the other carries none; a deep contact gives way to a far
    /// shallower one. Faces that lie on each other do not exclude each other, and overlap when each has the other's
    /// corner behind it, though a sharp one may be pierced: the node is then past the facet round its tip.
    fn is_inside_round(&self, node: usize, pick: &Pick, p: Point, end: End) -> bool {
        let boundary = self.boundary;
        let tolerance = self.corner_tolerance(pick);
        let SideEnd { round, point: corner, .. } = boundary.side_ends[pick.side as usize][end as usize];
        let (q, outward) = (self.place[corner as usize], self.frames.edges[round as usize].normal());
        let frame = &self.frames.nodes[node];
        let (own, distance) = (frame.to[end as usize], frame.distance[end as usize]);
        let facing = if end == End::Start { right_of(-own) } else { right_of(own) } / distance;
        let flush = -facing.dot(&right_of(pick.tangent)) > FLUSH_COSINE;
        let gap = (q - p).dot(&facing);
        if flush || own.dot(&outward) >= 0.0 {
            let is_inside = (p - q).dot(&outward) <= tolerance || self.is_kept(node, pick, end);
            return is_inside || flush && gap <= 0.0 && !self.came_in_elsewhere(node, pick, Some(end));
        }
        if pick.gap > 0.0 && gap <= 0.0 && !pick.is_held {
            return -gap > LEDGE * self.size || -gap > -self.opened(node, pick);
        }
        if pick.gap > 0.0 || gap > 0.0 {
            return gap <= tolerance;
        }
        if pick.is_held {
            return !self.is_deep(node, pick, pick.gap) || gap < SHALLOWER * pick.gap;
        }
        gap <= pick.gap + TIE_TOLERANCE * self.size && !self.is_borne(node, corner, end)
    }

    /// Whether a contact that carries force outlasts an end of its side.
    fn is_kept(&self, node: usize, pick: &Pick, end: End) -> bool {
        pick.is_held && self.overlap_at(node, pick, end) >= 0.0
    }

    /// How far (m) the node is inside the facet round an end of the side, or the corner there inside both facets of the
    /// node, unless that corner is a contact itself; negative where the two have parted.
    pub(super) fn overlap_at(&self, node: usize, pick: &Pick, end: End) -> f64 {
        let at = self.boundary.side_ends[pick.side as usize][end as usize];
        let frame = &self.frames.nodes[node];
        let to = self.place[at.point as usize] - frame.place;
        let inside = to.dot(&self.frames.edges[at.round as usize].normal());
        let depths = [to.perp(&frame.to[0]) / frame.distance[0], frame.to[1].perp(&to) / frame.distance[1]];
        let depth = depths[0].min(depths[1]);
        let is_covered = frame.is_convex && depth > inside && !self.is_borne(node, at.point, end);
        if is_covered { depth } else { inside }
    }

    /// Whether the corner at an end of a side carried force against the node's own side towards that end.
    fn is_borne(&self, node: usize, corner: u32, end: End) -> bool {
        let own_side = match end {
            End::Start => self.boundary.side_of_node_before(node),
            End::Finish => self.boundary.side[self.boundary.node_point[node] as usize],
        };
        self.carries(self.boundary.node_before[corner as usize], own_side)
    }

    /// Whether a node carried force against a side in the last step.
    fn carries(&self, node: u32, side: u32) -> bool {
        let known = &self.history[self.remembered.of_node(node as usize)];
        known.iter().any(|h| h.side == side && h.state != ContactState::Open)
    }

    /// Rule (i): both neighbours of the node lie outside the edge or hardly inside, and its own rock faces the edge.
    pub(super) fn enters(&self, node: usize, pick: &Pick) -> bool {
        let (normal, frame) = (right_of(pick.tangent), &self.frames.nodes[node]);
        let outside = |k: usize| frame.to[k].dot(&normal) >= -ENTRANCE_SINE * frame.distance[k];
        outside(0) & outside(1) & (frame.is_convex || faces(frame.to[1] - frame.to[0], normal))
    }

    /// Rule (iii): of the sides of one block that the node is over it enters one, unless they form a notch: the one
    /// that carries force, else the shallower. A node outside a near side is not inside a side behind it either.
    pub(super) fn choose_sides(&self, node: usize, picks: &mut [Pick]) {
        let block = |p: &Pick| self.boundary.block[p.edge as usize];
        for i in 0..picks.len() {
            for j in i + 1..picks.len() {
                let (a, b) = (&picks[i], &picks[j]);
                if block(a) != block(b) || self.is_notch(a.side, b.side) {
                    continue;
                }
                if let Some(first) = self.loser(node, a, b) {
                    picks[if first { i } else { j }].admitted = false;
                }
            }
        }
    }

    /// Whether a node at first sight was behind the side already before the last step, while the corner at this end of
    /// the side did not bear on the node's own: it came in neither through the side nor round that corner.
    fn came_in_elsewhere(&self, node: usize, pick: &Pick, end: Option<End>) -> bool {
        let at = &self.boundary.side_ends[pick.side as usize];
        let was_deep = || self.is_deep(node, pick, pick.gap - self.opened(node, pick));
        let is_met = |end: End| self.is_borne(node, at[end as usize].point, end);
        pick.held.is_none() && was_deep() && !end.is_some_and(is_met)
    }

    /// How far (m) the gap opened in the last step.
    fn opened(&self, node: usize, pick: &Pick) -> f64 {
        let boundary = self.boundary;
        let point = boundary.node_point[node] as usize;
        let covers = &boundary.covers[pick.edge as usize];
        let weights = self.weights_at(covers, self.node_place(node));
        let relative = boundary.sample(point, self.velocity) - cover::sample(covers, &weights, self.velocity);
        relative.dot(&right_of(pick.tangent)) * self.dt_last
    }

    /// Whether two sides meet in a notch.
    fn is_notch(&self, s: u32, t: u32) -> bool {
        let at = &self.boundary.side_ends[s as usize];
        self.end_between(s, t).is_some_and(|end| at[end as usize].corner == Corner::Reflex)
    }

    /// The end of side `s` at which it meets side `t`.
    fn end_between(&self, s: u32, t: u32) -> Option<End> {
        if self.boundary.side_next[s as usize] == t {
            Some(End::Finish)
        } else {
            (self.boundary.side_previous[s as usize] == t).then_some(End::Start)
        }
    }

    /// Which of two sides with rock between them the node does not enter: true for the first. Sides that do not meet
    /// have rock between them when they look apart and the node's foot on the deeper one lies behind the other.
    fn loser(&self, node: usize, a: &Pick, b: &Pick) -> Option<bool> {
        let first_is_deeper = a.gap < b.gap;
        let (deep, shallow) = if first_is_deeper { (a, b) } else { (b, a) };
        let cosine = deep.tangent.dot(&shallow.tangent);
        let opposed = cosine < -OPPOSED_COSINE && shallow.gap < deep.gap * cosine;
        let end = self.end_between(deep.side, shallow.side);
        if end.is_none() && !opposed {
            return None;
        }
        let behind = -deep.gap > shallow.gap.abs() + TIE_TOLERANCE * self.size;
        let deep_loses = if deep.is_held {
            shallow.is_held && shallow.admitted
        } else {
            let far = || end.is_none() && shallow.gap > 0.0 || self.came_in_elsewhere(node, deep, end);
            behind && far() || shallow.admitted && (shallow.is_held || shallow.gap <= 0.0)
        };
        if deep_loses {
            return Some(first_is_deeper);
        }
        let contest = deep.gap <= 0.0 && shallow.gap <= 0.0 && deep.admitted && shallow.admitted;
        contest.then_some(!first_is_deeper)
    }
}
