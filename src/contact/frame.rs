//! Current positions and directions of edges and nodes, computed once a step.

use enmm_lanes::{Pair, prefetch};
use rayon::prelude::*;

use crate::geometry::{Point, Vector};

use super::{Boundary, EdgeId, NodeId};

/// Edges or nodes that a thread takes at least.
const GRAIN: usize = 2048;

/// Pairs of an edge: its start, its tangent, and its length with a zero.
pub(super) const EDGE_PAIRS: usize = 3;
/// Pairs of a node: its position, the ways to the node before it and to the one after it, and their lengths.
pub(super) const NODE_PAIRS: usize = 4;

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
}

/// All edges and nodes at their current positions, in pairs of numbers that lanes can gather.
#[derive(Debug, Clone, Default)]
pub struct Frames {
    edges: Vec<[Pair; EDGE_PAIRS]>,
    nodes: Vec<[Pair; NODE_PAIRS]>,
}

impl EdgeFrame {
    /// Outward unit normal.
    pub fn normal(&self) -> Vector {
        right_of(self.tangent)
    }
}

impl NodeFrame {
    /// Whether the rock at the node is a corner of less than half a turn, by more than an angle given by its sine.
    pub fn is_convex(&self, sine: f64) -> bool {
        let ([previous, next], [before, after]) = (self.to, self.distance);
        let (cross, dot) = (next.perp(&previous), next.dot(&previous));
        cross > 0.0 && (dot > 0.0 || cross > sine * before * after)
    }

    /// Whether the boundary turns back at the node, up to an angle given by its sine: a spike, or a closed crack.
    pub fn turns_back(&self, sine: f64) -> bool {
        let ([previous, next], [before, after]) = (self.to, self.distance);
        next.dot(&previous) > 0.0 && next.perp(&previous).abs() < sine * before * after
    }
}

impl Frames {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        size_of_val(self.edges.as_slice()) + size_of_val(self.nodes.as_slice())
    }

    /// An edge.
    #[inline(always)]
    pub(super) fn edge(&self, edge: EdgeId) -> EdgeFrame {
        let [start, tangent, length] = self.edges[edge.index()];
        EdgeFrame { start, tangent, length: length.x }
    }

    /// A node.
    #[inline(always)]
    pub(super) fn node(&self, node: NodeId) -> NodeFrame {
        let [position, previous, next, distance] = self.nodes[node.index()];
        NodeFrame { position, to: [previous, next], distance: [distance.x, distance.y] }
    }

    /// Prefetches an edge and the point at its start.
    #[inline(always)]
    pub(super) fn fetch(&self, edge: EdgeId) {
        prefetch(&self.edges[edge.index()..=edge.index()]);
    }

    /// Position of a boundary point (m).
    #[inline(always)]
    pub fn position(&self, point: EdgeId) -> Point {
        self.edges[point.index()][0]
    }

    /// Positions of all nodes (m).
    pub fn node_positions(&self) -> impl ExactSizeIterator<Item = Point> {
        self.nodes.iter().map(|[position, ..]| *position)
    }

    /// The pairs of all edges.
    pub(super) fn edge_pairs(&self) -> &[Pair] {
        self.edges.as_flattened()
    }

    /// The pairs of all nodes.
    pub(super) fn node_pairs(&self) -> &[Pair] {
        self.nodes.as_flattened()
    }

    /// Updates all edges and nodes from the current positions of the boundary points (m).
    pub fn update(&mut self, boundary: &Boundary, position: impl Fn(EdgeId) -> Point + Sync, serial: bool) {
        let Self { edges, nodes } = self;
        let Boundary { next, nodes: of, .. } = boundary;
        edges.resize(next.len(), [Pair::zeros(); EDGE_PAIRS]);
        if serial {
            fill(edges, 0, next, &position);
        } else {
            let parts = edges.par_chunks_mut(GRAIN).enumerate();
            parts.for_each(|(k, part): (_, &mut [_])| fill(part, k * GRAIN, next, &position));
        }
        let at = |point: EdgeId| edges[point.index()][0];
        let node = |((point, previous), next): ((&EdgeId, &NodeId), &NodeId)| {
            let to = [*previous, *next].map(|q| at(of.point[q]) - at(*point));
            [at(*point), to[0], to[1], Pair::new(to[0].norm(), to[1].norm())]
        };
        if serial {
            nodes.clear();
            nodes.extend(of.point.iter().zip(&of.previous).zip(&of.next).map(node));
        } else {
            let all = of.point.par_iter().zip(&of.previous).zip(&of.next).with_min_len(GRAIN);
            all.map(node).collect_into_vec(nodes);
        }
    }
}

/// Fills the edges from the index `first` on, given the point after each.
fn fill(edges: &mut [[Pair; EDGE_PAIRS]], first: usize, next: &[EdgeId], position: &impl Fn(EdgeId) -> Point) {
    for (point, edge) in EdgeId::range(first..first + edges.len()).zip(&mut *edges) {
        edge[0] = position(point);
    }
    for k in 0..edges.len() {
        let next = next[first + k];
        let known = next.index().checked_sub(first).and_then(|k| edges.get(k));
        let way = known.map_or_else(|| position(next), |edge| edge[0]) - edges[k][0];
        let length = way.norm();
        (edges[k][1], edges[k][2]) = (way / length, Pair::new(length, 0.0));
    }
}

/// The direction a quarter turn to the right: outward where rock is on the left.
pub(super) fn right_of(along: Vector) -> Vector {
    Vector::new(along.y, -along.x)
}
