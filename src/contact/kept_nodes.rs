//! Nodes of a boundary that stay where they are when more cuts part the rock, so that contacts on its faces go on.

use crate::cover::BoundaryPiece;
use crate::geometry::TraceId;

use super::boundary::{Boundary, EdgeId, Station};

/// A boundary of the same rock before more cuts.
#[derive(Debug)]
pub struct KeptNodes<'a> {
    before: &'a Boundary,
    /// Distance (m) within which two points are one.
    tolerance: f64,
    /// Its edges by trace and by the x of their middles (m).
    order: Vec<(Option<TraceId>, f64, EdgeId)>,
    /// Half of the largest extent of an edge along x (m).
    reach: f64,
}

impl<'a> KeptNodes<'a> {
    /// The nodes of a boundary before more cuts; points within `tolerance` (m) are one.
    pub fn new(before: &'a Boundary, tolerance: f64) -> Self {
        let ends = |edge: EdgeId| [before.reference[edge].x, before.reference[before.after(edge)].x];
        let place = |edge: EdgeId| (before.trace[edge], (ends(edge)[0] + ends(edge)[1]) * 0.5, edge);
        let mut order: Vec<_> = before.edges().map(place).collect();
        order.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let reach = before.edges().map(|edge| (ends(edge)[0] - ends(edge)[1]).abs() * 0.5).fold(0.0, f64::max);
        Self { before, tolerance, order, reach }
    }

    /// Marks the stations of a loop that lie on faces from before, and those of them that were nodes; makes more where
    /// nodes were on new points.
    pub(super) fn mark(&self, stations: Vec<Station>) -> Vec<Station> {
        let mut marked = Vec::with_capacity(stations.len());
        for mut station in stations {
            let edges = self.along(&station.piece);
            station.kept = !edges.is_empty();
            let BoundaryPiece { a, b, .. } = station.piece;
            let length = (b - a).norm();
            let is_node = |edge: EdgeId| self.before.nodes.point[self.before.node_before[edge]] == edge;
            for (place, _) in edges.into_iter().filter(|(_, edge)| is_node(*edge)) {
                if place.abs() <= self.tolerance {
                    station.node = true;
                } else if place > 0.0 && length - place > self.tolerance {
                    let (first, rest) = station.split(a + (b - a) * (place / length));
                    marked.push(first);
                    station = rest;
                }
            }
            marked.push(station);
        }
        marked
    }

    /// Edges from before that lie along a piece, in their order, with the place of their start on it (m).
    fn along(&self, piece: &BoundaryPiece) -> Vec<(f64, EdgeId)> {
        let length = (piece.b - piece.a).norm();
        let way = (piece.b - piece.a) / length;
        let middle = (piece.a.x + piece.b.x) * 0.5;
        let reach = (piece.b.x - piece.a.x).abs() * 0.5 + self.reach + self.tolerance;
        let first = self.order.partition_point(|(trace, x, _)| (*trace, *x) < (piece.trace, middle - reach));
        let near = self.order[first..].iter().take_while(|(t, x, _)| *t == piece.trace && *x <= middle + reach);
        let mut on: Vec<(f64, EdgeId)> = near
            .filter_map(|&(_, _, edge)| {
                let [start, end] = [edge, self.before.after(edge)].map(|point| self.before.reference[point] - piece.a);
                let is_on_line = [start, end].iter().all(|from| way.perp(from).abs() <= self.tolerance);
                let shared = end.dot(&way).min(length) - start.dot(&way).max(0.0);
                (is_on_line && shared > self.tolerance).then_some((start.dot(&way), edge))
            })
            .collect();
        on.sort_by(|a, b| a.0.total_cmp(&b.0));
        on
    }
}
