//! Boundary of the blocks for contact: points with weights, edges between them, nodes and sides. It is built once with
//! the model; broad and narrow phase read it.

use std::ops::Range;

use crate::cover::{self, BlockId, BoundaryPiece, CoverId, Covers, ElementId, NodePlaces, Outlines, Weights};
use crate::geometry::{Point, TraceId, Vector, id};

use super::DetectionRule;
use super::constants::BOUNDARY_ROUND_OFF;

id! {
    /// A node of the boundary: a point of it that may touch edges.
    NodeId: plain
}
id! {
    /// An edge of the boundary, and the boundary point at its start.
    EdgeId: plain
}
id! {
    /// A side: edges between two corners.
    SideId: plain
}

/// Kind of the end of a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// Rock within less than half a turn.
    Convex,
    /// Rock within more than half a turn, crack tips included.
    Reflex,
}

/// Boundary points in loop order. Edge `k` runs from point `k` to point `next[k]` inside one element, rock on its left.
#[doc(alias = "collision geometry")]
#[doc(alias = "vertices and edges")]
#[derive(Debug, Clone, Default)]
pub struct Boundary {
    /// Covers of the element that carries point `k`.
    pub covers: Vec<[CoverId; 3]>,
    /// Point whose covers carry edge `k` beyond its middle: its start, as before the middle, but on a sliver its end.
    pub beyond: Vec<EdgeId>,
    /// Edges that lie on a sliver, in their order.
    pub slivers: Vec<(EdgeId, ElementId)>,
    /// Weights of the covers of point `k` there.
    pub weights: Vec<Weights>,
    /// Reference position of point `k` (m).
    pub reference: Vec<Point>,
    /// The point after `k` on its loop.
    pub next: Vec<EdgeId>,
    /// Block of edge and point `k`.
    pub block: Vec<BlockId>,
    /// Side that edge `k` is part of.
    pub side: Vec<SideId>,
    /// Node at or before point `k`.
    pub node_before: Vec<NodeId>,
    /// Joint trace of edge `k`; none on an outline.
    pub trace: Vec<Option<TraceId>>,
    /// Whether both sides of edge `k` belong to one block.
    pub partial: Vec<bool>,
    /// Its nodes.
    pub nodes: Nodes,
    /// Its sides.
    pub sides: Sides,
    /// Thickness of each block: twice its area over its perimeter (m).
    pub block_thickness: Vec<f64>,
}

/// Nodes of the boundary, by [`NodeId`].
#[derive(Debug, Clone, Default)]
pub struct Nodes {
    /// Boundary point of each node.
    pub point: Vec<EdgeId>,
    /// Whether each node is the convex start of a side.
    pub convex: Vec<bool>,
    /// Edge that ends at each node: the last point before it on its loop.
    pub edge_before: Vec<EdgeId>,
    /// Node before each node on its loop.
    pub previous: Vec<NodeId>,
    /// Node after each node on its loop.
    pub next: Vec<NodeId>,
}

/// Sides of the boundary, by [`SideId`].
#[derive(Debug, Clone, Default)]
pub struct Sides {
    /// Side before each side on its loop.
    pub previous: Vec<SideId>,
    /// Side after each side on its loop.
    pub next: Vec<SideId>,
    /// Both ends of each side, start and finish.
    pub ends: Vec<[SideEnd; 2]>,
}

/// One end of a side.
#[derive(Debug, Clone, Copy)]
pub struct SideEnd {
    /// Edge of the side at this end.
    pub edge: EdgeId,
    /// Edge of the other side that meets it round the corner.
    pub round: EdgeId,
    /// Boundary point that is the end.
    pub point: EdgeId,
    /// Kind of the end.
    pub corner: Corner,
}

/// A point of a loop while it is laid out: the piece that starts there and the turn onto it.
struct Station {
    piece: BoundaryPiece,
    turn: f64,
    node: bool,
    corner: bool,
}

impl Boundary {
    /// Lays nodes and edges along the boundary loops: a node at every corner and kink and at most a mesh size apart,
    /// but none between those that a piece keeps.
    pub fn new(covers: &Covers, outlines: &Outlines, rule: &DetectionRule) -> Self {
        let mut boundary = Self::default();
        let carrier = covers.carriers();
        for k in 0..outlines.len() {
            let mut stations = stations(outlines.of_loop(k), rule);
            place_nodes(&mut stations, covers.mesh.size, rule);
            boundary.push_loop(covers, &carrier, outlines.loop_block[k], &stations);
        }
        boundary.measure_blocks(covers);
        boundary
    }

    /// Number of points, and of edges.
    pub fn len(&self) -> usize {
        self.covers.len()
    }

    /// All edges, and so all points.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = EdgeId> + Clone {
        EdgeId::all(self.len())
    }

    /// Whether there is no boundary.
    pub fn is_empty(&self) -> bool {
        self.covers.is_empty()
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.point.len()
    }

    /// A cover field at point `k`.
    #[inline(always)]
    pub fn sample(&self, k: EdgeId, field: &[Vector]) -> Vector {
        cover::sample(&self.covers[k], &self.weights[k], field)
    }

    /// Point after point `k`.
    pub fn after(&self, k: EdgeId) -> EdgeId {
        self.next[k]
    }

    /// Length of an edge in the reference configuration (m).
    pub fn reference_length(&self, edge: EdgeId) -> f64 {
        (self.reference[self.after(edge)] - self.reference[edge]).norm()
    }

    /// The sliver on which an edge lies.
    pub fn sliver(&self, edge: EdgeId) -> Option<ElementId> {
        let found = self.slivers.binary_search_by_key(&edge, |sliver| sliver.0);
        found.ok().map(|k| self.slivers[k].1)
    }

    /// Joint trace of a node: that of the edge after it, or else of the edge before it.
    pub fn node_trace(&self, node: NodeId) -> Option<TraceId> {
        self.trace[self.nodes.point[node]].or(self.trace[self.nodes.edge_before[node]])
    }

    /// Covers that may carry positions on an edge.
    pub fn covers_on(&self, edge: EdgeId) -> impl Iterator<Item = CoverId> {
        [edge, self.beyond[edge]].into_iter().flat_map(|point| self.covers[point])
    }

    /// Edges of both segments that end at a node, from the node before it to the one after it.
    pub fn edges_about(&self, node: NodeId) -> impl Iterator<Item = EdgeId> {
        [self.nodes.previous[node], node].into_iter().flat_map(|first| self.segment(first))
    }

    /// Edges from a node to the next one.
    pub fn segment(&self, node: NodeId) -> impl Iterator<Item = EdgeId> {
        let [first, end] = [node, self.nodes.next[node]].map(|node| self.nodes.point[node]);
        std::iter::successors(Some(first), |&edge| Some(self.after(edge))).take_while(move |&edge| edge != end)
    }

    /// Edges before and after a node on its loop.
    pub fn edges_of_node(&self, node: NodeId) -> [EdgeId; 2] {
        [self.nodes.edge_before[node], self.nodes.point[node]]
    }

    /// Sides before and after a node: those that lie towards the start and the finish of a side that it faces.
    #[inline(always)]
    pub fn sides_of_node(&self, node: NodeId) -> [SideId; 2] {
        self.edges_of_node(node).map(|edge| self.side[edge])
    }

    /// Whether the node lies on a partial cut.
    pub fn node_partial(&self, node: NodeId) -> bool {
        self.edges_of_node(node).iter().any(|&edge| self.partial[edge])
    }

    /// Side that ends at or passes through a node.
    pub fn side_of_node_before(&self, node: NodeId) -> SideId {
        self.side[self.nodes.edge_before[node]]
    }

    fn measure_blocks(&mut self, covers: &Covers) {
        let mut perimeter = vec![0.0; covers.block_count()];
        for (k, &block) in self.edges().zip(&self.block) {
            perimeter[block] += (self.reference[self.after(k)] - self.reference[k]).norm();
        }
        let area = |block: BlockId| covers.elements_of(block).map(|e| covers.element_area[e]).sum::<f64>();
        self.block_thickness =
            covers.blocks().zip(&perimeter).map(|(b, perimeter)| 2.0 * area(b) / perimeter).collect();
    }

    fn push_loop(
        &mut self,
        covers: &Covers,
        carrier: &impl Fn(ElementId, ElementId) -> ElementId,
        block: BlockId,
        stations: &[Station],
    ) {
        let (first, first_node, first_side) = (self.len(), self.node_count(), self.sides.ends.len());
        let last = first + stations.len() - 1;
        for (k, station) in stations.iter().enumerate() {
            let edge = EdgeId::new(first + k);
            if station.corner {
                let corner = if station.turn > 0.0 { Corner::Convex } else { Corner::Reflex };
                let [start, end] = [edge, edge].map(|edge| SideEnd { edge, round: edge, point: edge, corner });
                self.sides.ends.push([start, end]);
            }
            if station.node {
                self.nodes.point.push(edge);
                self.nodes.convex.push(station.corner && station.turn > 0.0);
                self.nodes.edge_before.push(EdgeId::new(if k == 0 { last } else { first + k - 1 }));
            }
            let on = |k: usize| stations[k % stations.len()].piece.element;
            let own = on(k);
            let element = carrier(on(k + stations.len() - 1), own);
            self.covers.push(covers.element_covers[element]);
            let next = EdgeId::new(if first + k == last { first } else { first + k + 1 });
            let is_sliver = covers.host[own] != own;
            self.beyond.push(if is_sliver { next } else { edge });
            if is_sliver {
                self.slivers.push((edge, own));
            }
            self.weights.push(covers.weights(element, station.piece.a));
            self.reference.push(station.piece.a);
            self.next.push(next);
            self.block.push(block);
            self.side.push(SideId::new(self.sides.ends.len() - 1));
            self.node_before.push(NodeId::new(self.node_count() - 1));
            self.trace.push(station.piece.trace);
            self.partial.push(station.piece.partial);
            if let Some([_, end]) = self.sides.ends.last_mut() {
                end.edge = edge;
            }
        }
        ring(&mut self.nodes.previous, &mut self.nodes.next, first_node..self.nodes.point.len(), NodeId::new);
        ring(&mut self.sides.previous, &mut self.sides.next, first_side..self.sides.ends.len(), SideId::new);
        for side in first_side..self.sides.ends.len() {
            let (previous, next) = (self.sides.previous[side], self.sides.next[side]);
            let (last_before, first_after) = (self.sides.ends[previous][1].edge, self.sides.ends[next][0]);
            let [start, end] = &mut self.sides.ends[side];
            start.round = last_before;
            *end = SideEnd { edge: end.edge, round: first_after.edge, point: first_after.edge, ..first_after };
        }
    }
}

/// Appends the neighbours of a ring of indices.
fn ring<I>(previous: &mut Vec<I>, next: &mut Vec<I>, indices: Range<usize>, id: impl Fn(usize) -> I) {
    let Range { start, end } = indices;
    for k in indices {
        previous.push(id(if k == start { end - 1 } else { k - 1 }));
        next.push(id(if k + 1 == end { start } else { k + 1 }));
    }
}

/// Turn (rad) from one direction to the next; half a turn back is a crack tip, hence negative.
fn turn(before: &BoundaryPiece, after: &BoundaryPiece) -> f64 {
    let (d, e) = (before.b - before.a, after.b - after.a);
    let angle = libm::atan2(d.perp(&e), d.dot(&e));
    if angle.abs() > std::f64::consts::PI - BOUNDARY_ROUND_OFF { -std::f64::consts::PI } else { angle }
}

/// Pieces of a loop with their turns, corners marked, beginning at a corner.
fn stations(pieces: &[BoundaryPiece], rule: &DetectionRule) -> Vec<Station> {
    let n = pieces.len();
    let mut stations: Vec<Station> = (0..n)
        .map(|k| {
            let turn = turn(&pieces[(k + n - 1) % n], &pieces[k]);
            Station {
                piece: pieces[k],
                turn,
                node: turn.abs() > rule.kink_angle || pieces[k].nodes == NodePlaces::Kept { at_start: true },
                corner: turn.abs() > rule.corner_angle,
            }
        })
        .collect();
    let start = stations.iter().position(|s| s.corner).unwrap_or(0);
    stations.rotate_left(start);
    stations[0].corner = true;
    let mut along = 0.0;
    for station in &mut stations[1..] {
        along = if station.corner { 0.0 } else { along + station.turn };
        if along.abs() > rule.side_turn {
            station.corner = true;
            along = 0.0;
        }
    }
    for station in &mut stations {
        station.node |= station.corner;
    }
    stations
}

/// Adds nodes so that none are farther apart than `size` (m), on existing points where one is near.
fn place_nodes(stations: &mut Vec<Station>, size: f64, rule: &DetectionRule) {
    let mut placed = Vec::with_capacity(stations.len() + 8);
    let old = std::mem::take(stations);
    let mut spans = old.into_iter().peekable();
    while let Some(first) = spans.next() {
        let mut span = vec![first];
        while let Some(next) = spans.next_if(|s| !s.node) {
            span.push(next);
        }
        match span[0].piece.nodes {
            NodePlaces::Even => divide(span, size, rule.node_snap, &mut placed),
            NodePlaces::Kept { .. } => placed.append(&mut span),
        }
    }
    *stations = placed;
}

/// Divides one span between two nodes evenly: a node lies on the nearest point within a share `snap` of a part, or
/// else on a new one. The same from either end.
fn divide(mut span: Vec<Station>, size: f64, snap: f64, placed: &mut Vec<Station>) {
    let mut at = vec![0.0];
    at.extend(span.iter().scan(0.0, |sum, station| {
        *sum += (station.piece.b - station.piece.a).norm();
        Some(*sum)
    }));
    let length = at[span.len()];
    let parts = (length / size - BOUNDARY_ROUND_OFF).ceil().max(1.0) as usize;
    let step = length / parts as f64;
    let mut cuts = Vec::new();
    for target in (1..parts).map(|part| part as f64 * step) {
        let distance = |k: &usize| (at[*k] - target).abs();
        let behind = at[1..span.len()].partition_point(|&at| at < target) + 1;
        let either = [behind - 1, behind].into_iter().filter(|k| (1..span.len()).contains(k));
        let nearest = either.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        match nearest.filter(|k| distance(k) <= snap * step) {
            Some(near) => span[near].node = true,
            None => cuts.push(target),
        }
    }
    let mut cuts = cuts.into_iter().peekable();
    for (mut station, ends) in span.into_iter().zip(at.windows(2)) {
        let mut from = ends[0];
        while let Some(cut) = cuts.next_if(|&cut| cut < ends[1]) {
            let along = (cut - from) / (ends[1] - from);
            let split = station.piece.a + (station.piece.b - station.piece.a) * along;
            let rest = BoundaryPiece { a: split, ..station.piece };
            station.piece.b = split;
            placed.push(station);
            station = Station { piece: rest, turn: 0.0, node: true, corner: false };
            from = cut;
        }
        placed.push(station);
    }
}
