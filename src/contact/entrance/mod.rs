//! Narrow phase: which edge a node may enter, by the vertex rule of theory §6, and the contact's geometry.

mod contact;
mod length;
mod rule;

use crate::geometry::{Point, Vector};
use crate::mechanics::{BlockMotion, Metric, StressField};

use super::{Boundary, Candidate, ContactHistory, ContactState, JointLaw, VertexEdge};

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
