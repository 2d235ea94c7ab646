//! Pairs of faces that lie on each other in the reference geometry: the joints of a model as it was built.

use std::collections::BTreeMap;

use crate::geometry::{Point, TraceId, segment};

use super::{Boundary, EdgeId, LawId};

/// Overlap of two faces, relative to the shorter edge, below which they do not lie on each other.
const SLIVER: f64 = 1e-6;

/// A piece of joint at the start: two edges of the boundary, and the share of the way along each where it begins and
/// ends. The second edge runs back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facing {
    /// Both edges.
    pub edges: [EdgeId; 2],
    /// Shares of the way along each edge, at the start and at the end of the piece.
    pub spans: [[f64; 2]; 2],
    /// Reference points (m) that bound it: an end of one of the edges each.
    pub ends: [Point; 2],
    /// Face that the piece is part of: pieces of the same two blocks one after the other.
    pub face: usize,
}

/// All pieces of joint of a model.
#[derive(Debug, Clone, Default)]
pub struct Facings {
    /// Pieces, those of a face one after the other.
    pub pieces: Vec<Facing>,
    /// Number of faces.
    pub faces: usize,
    /// Reference points (m) that are one point but for round-off: ends of edges at the same place of a joint, and both
    /// ends of overlaps too short for a piece.
    pub same: Vec<[Point; 2]>,
}

impl Facings {
    /// Finds the faces that lie on each other, from the boundary and the joint traces with their laws.
    pub fn of(boundary: &Boundary, traces: &[(Vec<Point>, LawId)]) -> Self {
        // Edges by trace and by the side of its polyline on which they lie.
        let mut lines: BTreeMap<(TraceId, usize), [Vec<Stretch>; 2]> = BTreeMap::new();
        for edge in boundary.edges() {
            let Some((trace, points)) =
                boundary.trace[edge].and_then(|trace| Some((trace, traces.get(trace.index())?)))
            else {
                continue;
            };
            let (side, stretch) = Stretch::of(&points.0, boundary, edge);
            lines.entry((trace, side)).or_default()[usize::from(stretch.is_back)].push(stretch);
        }
        let mut found = Self::default();
        for [forth, back] in lines.values_mut() {
            for line in [&mut *forth, &mut *back] {
                line.sort_by(|a, b| a.ends[0].total_cmp(&b.ends[0]).then(a.edge.cmp(&b.edge)));
            }
            found.pair(boundary, forth, back);
        }
        found
    }

    /// Appends the pieces where two rows of edges along one line overlap.
    fn pair(&mut self, boundary: &Boundary, forth: &[Stretch], back: &[Stretch]) {
        let mut blocks = None;
        let (mut i, mut j) = (0, 0);
        while let (Some(a), Some(b)) = (forth.get(i), back.get(j)) {
            let [from, to] = [a.ends[0].max(b.ends[0]), a.ends[1].min(b.ends[1])];
            let shortest = SLIVER * (a.ends[1] - a.ends[0]).min(b.ends[1] - b.ends[0]);
            let ends = [a.bounds(b, 0, boundary), a.bounds(b, 1, boundary)];
            if to - from > shortest {
                let here = Some([boundary.block[a.edge], boundary.block[b.edge]]);
                self.faces += usize::from(here != blocks);
                blocks = here;
                let spans = [[a.share(from), a.share(to)], [b.share(from), b.share(to)]];
                self.pieces.push(Facing { edges: [a.edge, b.edge], spans, ends, face: self.faces - 1 });
                for end in [0, 1].into_iter().filter(|&end| (a.ends[end] - b.ends[end]).abs() <= shortest) {
                    self.note_same([a.point(end, boundary), b.point(end, boundary)]);
                }
            } else if to >= from {
                self.note_same(ends);
            }
            if a.ends[1] < b.ends[1] { i += 1 } else { j += 1 }
        }
    }

    fn note_same(&mut self, points: [Point; 2]) {
        if points[0] != points[1] {
            self.same.push(points);
        }
    }
}

/// An edge along a straight line: from and to, as distances (m) along it.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    edge: EdgeId,
    ends: [f64; 2],
    is_back: bool,
}

impl Stretch {
    /// The side of a polyline on which an edge lies, and the edge along it.
    fn of(points: &[Point], boundary: &Boundary, edge: EdgeId) -> (usize, Self) {
        let [a, b] = [boundary.reference[edge], boundary.reference[boundary.after(edge)]];
        let middle = (a + b) * 0.5;
        let distance = |k: usize| segment::distance(middle, points[k], points[k + 1]);
        let sides = 0..points.len().saturating_sub(1);
        let side = sides.min_by(|&i, &j| distance(i).total_cmp(&distance(j))).unwrap_or_default();
        let [from, to] = [points[side], points[(side + 1).min(points.len() - 1)]];
        let along = (to - from) / (to - from).norm();
        let [s, t] = [a, b].map(|p| (p - from).dot(&along));
        (side, Self { edge, ends: [s.min(t), s.max(t)], is_back: t < s })
    }

    /// Share of the way along the edge at a distance (m) along the line.
    fn share(&self, distance: f64) -> f64 {
        let share = (distance - self.ends[0]) / (self.ends[1] - self.ends[0]);
        if self.is_back { 1.0 - share } else { share }
    }

    /// Reference point (m) of its first or second end along the line.
    fn point(&self, end: usize, boundary: &Boundary) -> Point {
        let is_start = (end == 0) != self.is_back;
        boundary.reference[if is_start { self.edge } else { boundary.after(self.edge) }]
    }

    /// Reference point (m) that bounds the overlap with another edge at its first or second end along the line.
    fn bounds(&self, other: &Self, end: usize, boundary: &Boundary) -> Point {
        let [own, others] = [self.ends[end], other.ends[end]];
        let is_own = if end == 0 { own >= others } else { own <= others };
        if is_own { self.point(end, boundary) } else { other.point(end, boundary) }
    }
}
