//! Current positions and directions of edges and nodes, computed once a step for the narrow phase.

use rayon::prelude::*;

use crate::contact::{Boundary, EdgeId, NodeId};
use crate::geometry::{Point, Vector};

use super::{is_convex, right_of};

/// Edges or nodes that a thread takes at least.
const GRAIN: usize = 2048;
/// Relative difference of squared distances above which rounding does not decide which is the larger.
const ROUNDING: f64 = 1e-12;

/// An edge at its current position.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeFrame {
    /// Start (m).
    pub start: Point,
    /// Unit tangent.
    pub tangent: Vector,
    /// Length (m).
    pub length: f64,
}

/// A node at its current position.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeFrame {
    /// Position (m).
    pub position: Point,
    /// To the node before it and to the node after it on its loop (m).
    pub to: [Vector; 2],
    /// How far those are (m).
    pub distance: [f64; 2],
    /// Whether it is a convex corner.
    pub is_convex: bool,
}

/// Position of a point relative to an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Over {
    /// Distance along the edge from its start (m).
    pub along: f64,
    /// Gap along the outward normal (m).
    pub gap: f64,
    /// Distance along the edge beyond its nearer end (m); 0 within.
    pub beyond: f64,
}

/// All edges and nodes at their current positions.
#[derive(Debug, Clone, Default)]
pub struct Frames {
    pub(super) edges: Vec<EdgeFrame>,
    pub(super) nodes: Vec<NodeFrame>,
}

impl Over {
    /// Distance from the edge (m).
    pub fn distance(&self) -> f64 {
        if self.beyond > 0.0 { libm::hypot(self.beyond, self.gap) } else { self.gap.abs() }
    }

    /// Whether this edge is the nearer one. Equal to the comparison of both distances, which costs more.
    #[inline(always)]
    pub fn is_nearer_than(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|over| over.beyond * over.beyond + over.gap * over.gap);
        if (own - others).abs() > ROUNDING * others { own < others } else { self.distance() < other.distance() }
    }
}

impl EdgeFrame {
    fn new(a: Point, b: Point) -> Self {
        let length = (b - a).norm();
        Self { start: a, tangent: (b - a) / length, length }
    }

    /// Outward unit normal.
    pub fn normal(&self) -> Vector {
        right_of(self.tangent)
    }

    /// Where a point is over the edge.
    pub fn over(&self, p: Point) -> Over {
        let from = p - self.start;
        let along = from.dot(&self.tangent);
        let beyond = (-along).max(along - self.length).max(0.0);
        Over { along, gap: from.dot(&self.normal()), beyond }
    }
}

impl NodeFrame {
    fn new(position: Point, neighbours: [Point; 2], flush_sine: f64) -> Self {
        let to = neighbours.map(|q| q - position);
        let distance = to.map(|d| d.norm());
        Self { position, to, distance, is_convex: is_convex(to, distance, flush_sine) }
    }
}

impl Frames {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        size_of_val(self.edges.as_slice()) + size_of_val(self.nodes.as_slice())
    }

    /// Updates all edges and nodes from the current positions of the boundary points; at a corner the boundary turns by
    /// more than an angle given by its sine.
    pub fn update(&mut self, boundary: &Boundary, position: &[Point], flush_sine: f64, serial: bool) {
        let edge = |(a, next): (&Point, &EdgeId)| EdgeFrame::new(*a, position[*next]);
        let at = |node: NodeId| position[boundary.node_point[node]];
        let node = |((point, previous), next): ((&EdgeId, &NodeId), &NodeId)| {
            NodeFrame::new(position[*point], [at(*previous), at(*next)], flush_sine)
        };
        let Boundary { node_point, node_previous, node_next, .. } = boundary;
        if serial {
            self.edges.clear();
            self.edges.extend(position.iter().zip(&boundary.next).map(edge));
            self.nodes.clear();
            self.nodes.extend(node_point.iter().zip(node_previous).zip(node_next).map(node));
        } else {
            let edges = position.par_iter().zip(&boundary.next).with_min_len(GRAIN);
            edges.map(edge).collect_into_vec(&mut self.edges);
            let nodes = node_point.par_iter().zip(node_previous).zip(node_next).with_min_len(GRAIN);
            nodes.map(node).collect_into_vec(&mut self.nodes);
        }
    }
}
