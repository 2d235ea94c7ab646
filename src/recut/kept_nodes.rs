//! Nodes of the boundary that stay where they are when more cuts part the rock, so that contacts on its faces go on.

use std::borrow::Cow;

use crate::contact::{Boundary, EdgeId};
use crate::cover::{BoundaryPiece, NodePlaces, Outlines};
use crate::geometry::TraceId;

/// Outlines of the rock after more cuts. Faces of a boundary `before` them keep its nodes: there pieces are divided
/// where it has one between their ends. Points within `tolerance` (m) are one.
pub fn keep_nodes<'a>(outlines: &'a Outlines, before: Option<&Boundary>, tolerance: f64) -> Cow<'a, Outlines> {
    let Some(before) = before else { return Cow::Borrowed(outlines) };
    let edges = Edges::new(before, tolerance);
    let mut kept = Outlines { loop_start: vec![0], loop_block: outlines.loop_block.clone(), ..Outlines::default() };
    for k in 0..outlines.len() {
        outlines.of_loop(k).iter().for_each(|piece| edges.divide(*piece, &mut kept.pieces));
        kept.loop_start.push(kept.pieces.len() as u32);
    }
    Cow::Owned(kept)
}

/// Edges of a boundary by their places.
struct Edges<'a> {
    boundary: &'a Boundary,
    tolerance: f64,
    /// By trace and by the x of their middles (m).
    order: Vec<(Option<TraceId>, f64, EdgeId)>,
    /// Half of the largest extent of an edge along x (m).
    reach: f64,
}

impl<'a> Edges<'a> {
    fn new(boundary: &'a Boundary, tolerance: f64) -> Self {
        let ends = |edge: EdgeId| [edge, boundary.after(edge)].map(|point| boundary.reference[point].x);
        let place = |edge: EdgeId| (boundary.trace[edge], ends(edge).iter().sum::<f64>() * 0.5, edge);
        let mut order: Vec<_> = boundary.edges().map(place).collect();
        order.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let extent = |edge: EdgeId| (ends(edge)[1] - ends(edge)[0]).abs();
        Self { boundary, tolerance, order, reach: boundary.edges().map(extent).fold(0.0, f64::max) * 0.5 }
    }

    /// Appends the parts of a piece between the nodes on it.
    fn divide(&self, mut piece: BoundaryPiece, parts: &mut Vec<BoundaryPiece>) {
        let edges = self.along(&piece);
        if !edges.is_empty() {
            piece.nodes = NodePlaces::Kept { at_start: false };
        }
        let (start, length) = (piece.a, (piece.b - piece.a).norm());
        let is_node = |edge: EdgeId| self.boundary.nodes.point[self.boundary.node_before[edge]] == edge;
        for (place, _) in edges.into_iter().filter(|(_, edge)| is_node(*edge)) {
            if place > self.tolerance && length - place > self.tolerance {
                let at = start + (piece.b - start) * (place / length);
                parts.push(BoundaryPiece { b: at, ..piece });
                piece = BoundaryPiece { a: at, nodes: NodePlaces::Kept { at_start: true }, ..piece };
            } else if place.abs() <= self.tolerance {
                piece.nodes = NodePlaces::Kept { at_start: true };
            }
        }
        parts.push(piece);
    }

    /// Edges that lie along a piece, in their order, with the place (m) of their start on it.
    fn along(&self, piece: &BoundaryPiece) -> Vec<(f64, EdgeId)> {
        let length = (piece.b - piece.a).norm();
        let way = (piece.b - piece.a) / length;
        let middle = (piece.a.x + piece.b.x) * 0.5;
        let reach = (piece.b.x - piece.a.x).abs() * 0.5 + self.reach + self.tolerance;
        let first = self.order.partition_point(|(trace, x, _)| (*trace, *x) < (piece.trace, middle - reach));
        let near = self.order[first..].iter().take_while(|(t, x, _)| *t == piece.trace && *x <= middle + reach);
        let along = |edge: EdgeId| {
            let ends = [edge, self.boundary.after(edge)].map(|point| self.boundary.reference[point] - piece.a);
            let is_on_line = ends.iter().all(|from| way.perp(from).abs() <= self.tolerance);
            let [from, to] = ends.map(|from| from.dot(&way));
            (is_on_line && to.min(length) - from.max(0.0) > self.tolerance).then_some((from, edge))
        };
        let mut edges: Vec<(f64, EdgeId)> = near.filter_map(|&(_, _, edge)| along(edge)).collect();
        edges.sort_by(|a, b| a.0.total_cmp(&b.0));
        edges
    }
}
