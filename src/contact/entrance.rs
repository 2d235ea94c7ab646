//! Narrow phase: which edge a node may enter, by the vertex rule of theory §6, and the contact's geometry.

use crate::cover::{self, Weights};
use crate::geometry::{Point, Vector};
use crate::mechanics::{BlockMotion, Metric, StressField};

use super::{Boundary, Candidate, Closure, ContactHistory, ContactState, Corner, JointLaw, Pair, VertexEdge};

/// Share of a node segment by which a neighbour may lie inside the edge: 0.17 ≈ sin 10°.
const ENTRANCE_SINE: f64 = 0.17;
/// Depth, relative to the mesh size, from which a contact at first sight starts without force.
const FIRST_SIGHT_DEPTH: f64 = 3e-3;
/// Distance beyond a corner, relative to the mesh size, up to which a contact that carries force is kept.
const HELD_BEYOND: f64 = 1e-3;
/// Distance beyond a corner, relative to the mesh size, that counts as the corner.
const CORNER_TOLERANCE: f64 = 1e-9;
/// Difference of two depths, relative to the mesh size, below which they count as equal.
const TIE_TOLERANCE: f64 = 1e-6;
/// Distance, relative to the gap, by which a foot may miss an edge where the boundary bends.
const WEDGE_RATIO: f64 = 0.5;
/// Height of a ledge, relative to the mesh size, that catches nothing: a corner that comes on by more in a step passes.
const LEDGE: f64 = 5e-4;
/// Share of its depth to which another facet must be shallower for a deep contact to give way.
const SHALLOWER: f64 = 0.25;
/// Cosine from which two sides of a block look apart, with rock between them: 60°.
const OPPOSED_COSINE: f64 = 0.5;
/// Cosine from which two faces that look at each other lie on each other: 10°.
const FLUSH_COSINE: f64 = 0.985;
/// Least tributary length, relative to the mean of the neighbouring node segments.
const LENGTH_FLOOR: f64 = 1e-3;
/// The same for the solver's own stiffness: rock that meets in a point is no softer than where it meets in a face.
const PENALTY_LENGTH_FLOOR: f64 = 0.5;

/// What the narrow phase reads.
pub struct Narrow<'a> {
    /// Boundary of the blocks.
    pub boundary: &'a Boundary,
    /// Current places of the boundary points (m).
    pub place: &'a [Point],
    /// Star positions (m).
    pub star: &'a [Point],
    /// Displacements of the covers (m).
    pub displacement: &'a [Vector],
    /// Masses.
    pub metric: &'a Metric,
    /// Centroids of the blocks.
    pub motion: &'a [BlockMotion],
    /// Joint laws.
    pub laws: &'a [JointLaw],
    /// Law of each joint trace, after switches.
    pub trace_law: &'a [u32],
    /// Factor on the strength of all joints.
    pub strength: f64,
    /// Law of contacts between faces that were no joints.
    pub default_law: u32,
    /// Velocities (m/s) of the covers during the last step.
    pub velocity: &'a [Vector],
    /// Last step (s).
    pub dt_last: f64,
    /// Contacts of the last step, ordered by node and side.
    pub history: &'a [ContactHistory],
    /// Mesh size (m).
    pub size: f64,
    /// Gap (m) below which a contact takes part in the iteration.
    pub reach: f64,
    /// θ of the contact springs.
    pub theta: f64,
    /// Nodes and sides with the side's rock between them, sorted.
    pub behind: &'a [[u32; 2]],
    /// Whether contacts are those of the untouched model: joints are intact and pre-stressed.
    pub first: bool,
    /// Stress xx, yy, xy (Pa) before the first step, by place.
    pub in_situ: Option<&'a StressField>,
}

/// One end of a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Start,
    Finish,
}

/// A node over an edge of one side.
#[derive(Debug, Clone, Copy)]
struct Pick {
    side: u32,
    edge: u32,
    gap: f64,
    along: f64,
    length: f64,
    tangent: Vector,
    held: Option<ContactHistory>,
    /// Whether the contact carried force in the last step.
    is_held: bool,
    admitted: bool,
}

/// Judges every candidate and appends the contacts that take part in this step, ordered by node and side.
pub fn entrance_edges(narrow: &Narrow, candidates: &[Candidate], contacts: &mut Vec<VertexEdge>) {
    let mut picks: [Option<Pick>; 12] = [None; 12];
    let mut known = narrow.history;
    let mut rest = candidates;
    while let Some(first) = rest.first() {
        let (group, others) = rest.split_at(rest.partition_point(|c| c.node == first.node));
        rest = others;
        known = &known[known.partition_point(|h| h.node < first.node)..];
        let mine = &known[..known.partition_point(|h| h.node == first.node)];
        let count = narrow.pick_edges(first.node as usize, group, mine, &mut picks);
        narrow.choose_sides(first.node as usize, &mut picks[..count]);
        for pick in picks[..count].iter().flatten().filter(|p| p.admitted) {
            contacts.push(narrow.contact(first.node as usize, pick));
        }
    }
}

impl Narrow<'_> {
    /// The nearest edge of each side that the node is over, and whether the vertex rule admits it so far.
    fn pick_edges(
        &self,
        node: usize,
        group: &[Candidate],
        known: &[ContactHistory],
        picks: &mut [Option<Pick>; 12],
    ) -> usize {
        let (mut count, mut rest) = (0, group);
        while let Some(first) = rest.first() {
            let (edges, others) = rest.split_at(rest.partition_point(|c| c.side == first.side));
            rest = others;
            let held = known.iter().find(|h| h.side == first.side).copied();
            if let Some(pick) = self.pick(node, edges, held)
                && count < picks.len()
            {
                picks[count] = Some(pick);
                count += 1;
            }
        }
        count
    }

    fn pick(&self, node: usize, edges: &[Candidate], held: Option<ContactHistory>) -> Option<Pick> {
        let is_held = held.is_some_and(|h| h.state != ContactState::Open);
        let p = self.node_place(node);
        let over = |c: &Candidate| {
            let (a, b) = self.ends(c.edge as usize);
            let length = (b - a).norm();
            let tangent = (b - a) / length;
            let along = (p - a).dot(&tangent);
            let gap = (p - a).dot(&right_of(tangent));
            let beyond = (-along).max(along - length).max(0.0);
            let (side, edge) = (c.side, c.edge);
            let pick = Pick { side, edge, gap, along, length, tangent, held, is_held, admitted: false };
            (beyond.hypot(gap), beyond, pick)
        };
        let (_, beyond, mut pick) = edges.iter().map(over).min_by(|x, y| x.0.total_cmp(&y.0))?;
        if beyond > WEDGE_RATIO * pick.gap.abs() + HELD_BEYOND * self.size {
            return None;
        }
        let bonded = held.is_some_and(|h| h.intact && h.normal_force < 0.0);
        let near = bonded || pick.gap - self.allowance(&pick) < self.reach;
        pick.admitted = near
            && !(held.is_none() && self.is_false_sight(node, &pick))
            && self.enters(node, &pick, p)
            && self.within(node, &pick, p, beyond);
        Some(pick)
    }

    /// Whether a deep first sight cannot be a contact: within one block, or of a side with rock before it.
    fn is_false_sight(&self, node: usize, pick: &Pick) -> bool {
        let boundary = self.boundary;
        let own = boundary.block[boundary.node_point[node] as usize] == boundary.block[pick.edge as usize];
        own && -pick.gap > FIRST_SIGHT_DEPTH * self.size
            || pick.gap < -TIE_TOLERANCE * self.size && self.behind.binary_search(&[node as u32, pick.side]).is_ok()
    }

    /// Closure that the contact's springs do not see (m).
    fn allowance(&self, pick: &Pick) -> f64 {
        pick.held.map_or(0.0, |h| h.rest - h.offset)
    }

    fn node_place(&self, node: usize) -> Point {
        self.place[self.boundary.node_point[node] as usize]
    }

    fn ends(&self, edge: usize) -> (Point, Point) {
        (self.place[edge], self.place[self.boundary.after(edge)])
    }

    /// Distance (m) beyond a corner that counts as the corner.
    fn corner_tolerance(&self, pick: &Pick) -> f64 {
        self.size * if pick.is_held { HELD_BEYOND } else { CORNER_TOLERANCE }
    }

    /// Rule (ii): at a convex end of the side the node is not beyond the end, and not past the facet round it.
    fn within(&self, node: usize, pick: &Pick, p: Point, beyond: f64) -> bool {
        let tolerance = self.corner_tolerance(pick);
        [End::Start, End::Finish].into_iter().all(|end| {
            let (edge, corner, point) = self.end(pick.side as usize, end);
            if corner == Corner::Reflex {
                return true;
            }
            let past = match end {
                End::Start => pick.along < 0.0,
                End::Finish => pick.along > pick.length,
            };
            let missed = edge == pick.edge && past && beyond > tolerance;
            !missed && ((p - point).norm() >= self.size || self.is_inside_round(node, pick, p, end))
        })
    }

    /// Edge, corner and place of an end of a side.
    fn end(&self, side: usize, end: End) -> (u32, Corner, Point) {
        let boundary = self.boundary;
        match end {
            End::Start => {
                let first = boundary.side_first[side];
                (first, boundary.side_corner[side], self.place[first as usize])
            }
            End::Finish => {
                let last = boundary.side_last[side];
                let corner = boundary.side_corner[boundary.side_next[side] as usize];
                (last, corner, self.ends(last as usize).1)
            }
        }
    }

    /// Whether the node, at a convex `end` of the side, is inside the facet that meets this one there.
    ///
    /// Two convex corners p and q overlap when they are inside both facets next to their meeting: pairs of one's
    /// corner and a side of the other that it faces. Next to (p, side) comes (p, the side round q), where p faces
    /// that as well, or else (q, the side of p that turns towards it). Inside both, the node enters this one if it
    /// carries force, or if it is the shallower and the other carries none; a deep contact gives way to a far
    /// shallower one. Faces that lie on each other do not exclude each other.
    fn is_inside_round(&self, node: usize, pick: &Pick, p: Point, end: End) -> bool {
        let boundary = self.boundary;
        let tolerance = self.corner_tolerance(pick);
        let side = pick.side as usize;
        let (edge, _, q) = self.end(side, end);
        let (round, corner, neighbour) = match end {
            End::Start => {
                (boundary.side_last[boundary.side_previous[side] as usize], edge, boundary.node_previous[node])
            }
            End::Finish => {
                let next = boundary.side_first[boundary.side_next[side] as usize];
                (next, next, boundary.node_next[node])
            }
        };
        let (a, b) = self.ends(round as usize);
        let outward = right_of(b - a).normalize();
        let own = self.node_place(neighbour as usize) - p;
        let facing = if end == End::Start { right_of(-own) } else { right_of(own) }.normalize();
        let flush = -facing.dot(&right_of(pick.tangent)) > FLUSH_COSINE;
        if flush || own.dot(&outward) >= 0.0 {
            return (p - q).dot(&outward) <= tolerance;
        }
        let gap = (q - p).dot(&facing);
        if pick.gap > 0.0 && gap <= 0.0 && !pick.is_held {
            return -gap > LEDGE * self.size || -gap > -self.opened(node, pick);
        }
        let own_side = || match end {
            End::Start => boundary.side_of_node_before(node),
            End::Finish => boundary.side[boundary.node_point[node] as usize],
        };
        if pick.gap > 0.0 || gap > 0.0 {
            return gap <= tolerance;
        }
        if pick.is_held {
            return -pick.gap < FIRST_SIGHT_DEPTH * self.size || gap < SHALLOWER * pick.gap;
        }
        gap <= pick.gap + TIE_TOLERANCE * self.size && !self.carries(boundary.node_before[corner as usize], own_side())
    }

    /// Whether a node carried force against a side in the last step.
    fn carries(&self, node: u32, side: u32) -> bool {
        let at = self.history.partition_point(|h| (h.node, h.side) < (node, side));
        self.history.get(at).is_some_and(|h| (h.node, h.side) == (node, side) && h.state != ContactState::Open)
    }

    /// Rule (i): both neighbours of the node lie outside the edge or hardly inside, and its own rock faces the edge.
    fn enters(&self, node: usize, pick: &Pick, p: Point) -> bool {
        let normal = right_of(pick.tangent);
        let [d, e] =
            [self.boundary.node_previous[node], self.boundary.node_next[node]].map(|n| self.node_place(n as usize) - p);
        let outside = |d: Vector| d.dot(&normal) >= -ENTRANCE_SINE * d.norm();
        outside(d) && outside(e) && (is_convex(d, e) || faces(e - d, normal))
    }

    /// Rule (iii): of the sides of one block that the node is over it enters one, unless they form a notch: the one
    /// that carries force, else the shallower. A node outside a near side is not inside a side behind it either.
    fn choose_sides(&self, node: usize, picks: &mut [Option<Pick>]) {
        for i in 0..picks.len() {
            for j in i + 1..picks.len() {
                let (Some(a), Some(b)) = (picks[i], picks[j]) else { continue };
                let block = |p: &Pick| self.boundary.block[p.edge as usize];
                if block(&a) != block(&b) {
                    continue;
                }
                let loser = match self.corner_between(a.side, b.side) {
                    Some(Corner::Reflex) => None,
                    corner => self.loser(node, &a, &b, corner.is_some()),
                };
                if let Some(first) = loser
                    && let Some(pick) = &mut picks[if first { i } else { j }]
                {
                    pick.admitted = false;
                }
            }
        }
    }

    /// Whether the node was behind the side already before the last step, so that it did not come in through it.
    fn was_deep(&self, node: usize, pick: &Pick) -> bool {
        self.opened(node, pick) - pick.gap > FIRST_SIGHT_DEPTH * self.size
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

    fn corner_between(&self, s: u32, t: u32) -> Option<Corner> {
        let (boundary, s, t) = (self.boundary, s as usize, t as usize);
        if boundary.side_next[s] as usize == t {
            Some(boundary.side_corner[t])
        } else if boundary.side_next[t] as usize == s {
            Some(boundary.side_corner[s])
        } else {
            None
        }
    }

    /// Which of two sides with rock between them the node does not enter: true for the first. Sides that do not meet
    /// have rock between them when they look apart and the node's foot on the deeper one lies behind the other.
    fn loser(&self, node: usize, a: &Pick, b: &Pick, adjacent: bool) -> Option<bool> {
        let first_is_deeper = a.gap < b.gap;
        let (deep, shallow) = if first_is_deeper { (a, b) } else { (b, a) };
        let cosine = deep.tangent.dot(&shallow.tangent);
        let opposed = cosine < -OPPOSED_COSINE && shallow.gap < deep.gap * cosine;
        if !adjacent && !opposed {
            return None;
        }
        let behind = -deep.gap > shallow.gap.abs() + TIE_TOLERANCE * self.size;
        let deep_loses = if deep.is_held {
            shallow.is_held && shallow.admitted
        } else {
            let far = !adjacent && shallow.gap > 0.0 || deep.held.is_none() && self.was_deep(node, deep);
            behind && far || shallow.admitted && shallow.gap <= 0.0
        };
        if deep_loses {
            return Some(first_is_deeper);
        }
        let contest = deep.gap <= 0.0 && shallow.gap <= 0.0 && deep.admitted && shallow.admitted;
        contest.then_some(!first_is_deeper)
    }

    /// Tributary length (m) of a node over an edge, and the length of the solver's own stiffness (Eq. 13).
    fn tributary(&self, node: usize, pick: &Pick) -> (f64, f64) {
        let boundary = self.boundary;
        let here = self.node_place(node);
        let p = here.dot(&pick.tangent);
        let before = boundary.node_before[pick.edge as usize] as usize;
        let from = self.node_place(before).dot(&pick.tangent);
        let to = self.node_place(boundary.node_next[before] as usize).dot(&pick.tangent);
        let overlap = |q: f64| (p.max(q).min(to) - p.min(q).max(from)).max(0.0);
        let previous = self.node_place(boundary.node_previous[node] as usize);
        let next = self.node_place(boundary.node_next[node] as usize);
        let (q, r) = (previous.dot(&pick.tangent), next.dot(&pick.tangent));
        let [low, high] = self.tie_shares(node, pick, before, [p - from, to - p]);
        let mut facing = 0.0;
        if q > p {
            let beyond = boundary.node_next[boundary.node_next[before] as usize];
            facing += overlap(q) + high * self.reach_beyond(beyond, to, q, pick);
        }
        if r < p {
            let beyond = boundary.node_previous[before];
            facing += overlap(r) + low * self.reach_beyond(beyond, from, r, pick);
        }
        let share = self.share_at_corner(node, pick);
        let span = 0.5 * ((previous - here).norm() + (next - here).norm());
        let length = (0.5 * facing).max(LENGTH_FLOOR * span);
        let stiff = length.max(PENALTY_LENGTH_FLOOR * span);
        (length * share, stiff * share)
    }

    /// Whether a node is the convex start of a side.
    fn is_convex_corner(&self, node: usize) -> bool {
        let (boundary, point) = (self.boundary, self.boundary.node_point[node]);
        let side = boundary.side[point as usize] as usize;
        boundary.side_first[side] == point && boundary.side_corner[side] == Corner::Convex
    }

    /// What a convex corner keeps of the node segments beyond the ends of the one under it, for its distances (m) from
    /// those ends: all at an inner node of the other side and nothing beyond the band in which that node takes over.
    fn tie_shares(&self, node: usize, pick: &Pick, before: usize, distances: [f64; 2]) -> [f64; 2] {
        if !self.is_convex_corner(node) {
            return [0.0; 2];
        }
        let boundary = self.boundary;
        let after = boundary.node_point[boundary.node_next[before] as usize] as usize;
        let inner =
            [boundary.side_first[pick.side as usize] != boundary.node_point[before], boundary.side[after] == pick.side];
        [0, 1].map(|k| {
            let share = (1.0 - distances[k] / (HELD_BEYOND * self.size)).clamp(0.0, 1.0);
            if inner[k] { share } else { 0.0 }
        })
    }

    /// Length (m) of a node segment from its end at `at` that the part up to `target` covers, along the pick's edge.
    fn reach_beyond(&self, far: u32, at: f64, target: f64, pick: &Pick) -> f64 {
        let far = self.node_place(far as usize).dot(&pick.tangent);
        if target > at { (target.min(far) - at).max(0.0) } else { (at - target.max(far)).max(0.0) }
    }

    /// 1 inside a side; at its convex ends ½ for a corner, since the corner there is a contact as well, and nothing for
    /// an inner node, whose segments that corner has.
    fn share_at_corner(&self, node: usize, pick: &Pick) -> f64 {
        let (boundary, side) = (self.boundary, pick.side as usize);
        let band = HELD_BEYOND * self.size;
        let convex = |s: usize| boundary.side_corner[s] == Corner::Convex;
        let least = if self.is_convex_corner(node) { 0.5 } else { 0.0 };
        let mut share = 1.0f64;
        if boundary.side_first[side] == pick.edge && convex(side) {
            share = share.min(least + (1.0 - least) * pick.along / band);
        }
        if boundary.side_last[side] == pick.edge && convex(boundary.side_next[side] as usize) {
            share = share.min(least + (1.0 - least) * (pick.length - pick.along) / band);
        }
        share.clamp(1e-3, 1.0)
    }

    fn contact(&self, node: usize, pick: &Pick) -> VertexEdge {
        let boundary = self.boundary;
        let (point, edge) = (boundary.node_point[node] as usize, pick.edge as usize);
        let p = self.place[point];
        let normal = right_of(pick.tangent);
        let covers = [boundary.covers[point], boundary.covers[edge]];
        let weights = [boundary.weights[point], self.weights_at(&covers[1], p)];
        let blocks = [boundary.block[point], boundary.block[edge]];
        let arms = blocks.map(|b| p - self.motion[b as usize].centre);
        let (length, penalty_length) = self.tributary(node, pick);
        let law = self.law(node, edge);
        let stiffness = self.laws[law as usize].stiffness(length, penalty_length);
        let closure_max = self.laws[law as usize].closure_max;
        let closure = Closure { stiffness: stiffness[0], most: closure_max };
        let history = pick.held.unwrap_or_else(|| self.first_sight(node, pick, length, closure, normal));
        let history = ContactHistory { edge: pick.edge, ..history };
        let mut pair = Pair { blocks, covers, weights, arms, z: [0.0; 2] };
        let compliance = pair.weigh(self.metric, [normal, pick.tangent]);
        VertexEdge {
            limits: self.laws[law as usize].limits(length, history.intact).times(self.strength),
            gap: pick.gap + history.offset - history.rest,
            penetration: -pick.gap,
            history,
            pair,
            normal,
            length,
            stiffness,
            closure_max,
            compliance,
            law,
            approach: [0.0; 2],
            forward: [self.theta; 2],
            lag: [0.0; 2],
            torn: false,
            fresh: pick.held.is_none(),
        }
    }

    /// Weights of an element's covers at a current place, by barycentric coordinates of its stars.
    fn weights_at(&self, covers: &[u32; 3], p: Point) -> Weights {
        let [x0, x1, x2] = covers.map(|i| self.star[i as usize] + self.displacement[i as usize]);
        let (d1, d2, d) = (x1 - x0, x2 - x0, p - x0);
        let area = d1.perp(&d2);
        let (w1, w2) = (d.perp(&d2) / area, d1.perp(&d) / area);
        [1.0 - w1 - w2, w1, w2]
    }

    /// Law of the joint between a node and an edge: that of the edge, of the node's own face, or the default.
    fn law(&self, node: usize, edge: usize) -> u32 {
        let law = |trace: u32| self.trace_law.get(trace as usize).copied();
        law(self.boundary.trace[edge]).or_else(|| law(self.boundary.node_trace(node))).unwrap_or(self.default_law)
    }

    fn first_sight(&self, node: usize, pick: &Pick, length: f64, closure: Closure, normal: Vector) -> ContactHistory {
        let mut history = ContactHistory {
            node: node as u32,
            side: pick.side,
            edge: pick.edge,
            normal_force: 0.0,
            shear_force: 0.0,
            shear_stored: 0.0,
            offset: 0.0,
            rest: 0.0,
            slip: 0.0,
            state: ContactState::Open,
            intact: self.first,
        };
        if -pick.gap > FIRST_SIGHT_DEPTH * self.size {
            history.offset = -pick.gap;
        }
        if let (true, Some(stress)) = (self.first, self.in_situ) {
            let [xx, yy, xy] = stress.at(self.boundary.reference[self.boundary.node_point[node] as usize]);
            let traction = Vector::new(xx * normal.x + xy * normal.y, xy * normal.x + yy * normal.y) * length;
            history.normal_force = -traction.dot(&normal);
            history.rest = closure.under(history.normal_force);
            history.shear_force = -traction.dot(&pick.tangent);
            history.shear_stored = history.shear_force;
            history.state = ContactState::Lock;
        }
        history
    }
}

/// The direction a quarter turn to the right: outward where rock is on the left.
fn right_of(along: Vector) -> Vector {
    Vector::new(along.y, -along.x)
}

/// Whether the rock between the directions to the previous and the next node is a corner of less than half a turn.
fn is_convex(previous: Vector, next: Vector) -> bool {
    let (cross, dot) = (next.perp(&previous), next.dot(&previous));
    cross > 0.0 && (dot > 0.0 || cross > ENTRANCE_SINE * previous.norm() * next.norm())
}

/// Whether a flat piece of boundary, given by its chord with rock on the left, looks towards an edge.
fn faces(chord: Vector, normal: Vector) -> bool {
    chord.perp(&normal) > -ENTRANCE_SINE * chord.norm()
}
