//! Half-edges, cycles, faces and winding of a set of edges that meet in common vertices only.
//!
//! Every decision rests on exact signs; nothing here knows a tolerance.

use super::grid::{CellGrid, Groups};
use super::planar_map::{Arrangement, Edge, Face, FaceId, HalfEdgeId, NodingReport, VertexId};
use super::{GeometryError, Point, orientation};

/// Walks round the faces of edges that cross nowhere and have no dead ends, and floods the winding from outside.
pub(super) fn build(points: Vec<Point>, edges: Vec<Edge>, report: NodingReport) -> Result<Arrangement, GeometryError> {
    // The next of each half-edge and its face are filled in below.
    let next = vec![HalfEdgeId::default(); 2 * edges.len()];
    let face = vec![FaceId::UNBOUNDED; 2 * edges.len()];
    let faces = vec![Face { outer: None, inner: Vec::new(), winding: 0 }];
    let mut arrangement = Arrangement { points, edges, next, face, faces, report };
    let fans = fans(&arrangement);
    link(&mut arrangement, &fans);
    let outers = outer_cycles(&arrangement, &fans);
    mark_faces(&mut arrangement, &outers);
    place_outer_cycles(&mut arrangement, &outers);
    flood(&mut arrangement);
    check_winding(&arrangement)?;
    Ok(arrangement)
}

/// Groups the half-edges by origin, counter-clockwise from the direction of x.
fn fans(arrangement: &Arrangement) -> Groups<HalfEdgeId> {
    let points = &arrangement.points;
    let mut fans = Groups::build(points.len(), |put| {
        for h in arrangement.half_edges() {
            put(arrangement.origin(h).index(), h);
        }
    });
    let mut fan = Vec::new();
    for (vertex, &origin) in points.iter().enumerate() {
        let group = fans.get_mut(vertex);
        fan.clear();
        fan.extend(group.iter().map(|&h| {
            let target = points[arrangement.target(h)];
            let lower = target.y < origin.y || (target.y == origin.y && target.x < origin.x);
            (lower, target, h)
        }));
        fan.sort_unstable_by(|p, q| {
            let turn = || 0.0f64.total_cmp(&(orientation(origin, p.1, q.1) + 0.0));
            p.0.cmp(&q.0).then_with(turn).then(p.2.cmp(&q.2))
        });
        for (slot, entry) in group.iter_mut().zip(&fan) {
            *slot = entry.2;
        }
    }
    fans
}

/// Sets `next`: from the twin of a half-edge, one step clockwise round its vertex.
fn link(arrangement: &mut Arrangement, fans: &Groups<HalfEdgeId>) {
    for vertex in 0..arrangement.points.len() {
        let fan = fans.get(vertex);
        for (k, &h) in fan.iter().enumerate() {
            let before = fan[(k + fan.len() - 1) % fan.len()];
            arrangement.next[h.twin()] = before;
        }
    }
}

/// The outer cycle of one connected component.
struct OuterCycle {
    /// A half-edge of it, starting at the leftmost vertex.
    half_edge: HalfEdgeId,
    /// Leftmost vertex of the component, lowest among equals.
    leftmost: VertexId,
}

/// Finds the outer cycle of each component, ordered by leftmost vertex.
fn outer_cycles(arrangement: &Arrangement, fans: &Groups<HalfEdgeId>) -> Vec<OuterCycle> {
    let points = &arrangement.points;
    let order = |i: VertexId, j: VertexId| {
        let (p, q) = (points[i], points[j]);
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(i.cmp(&j))
    };
    let mut reached = vec![false; points.len()];
    let (mut outers, mut stack) = (Vec::new(), Vec::<VertexId>::new());
    for start in VertexId::all(points.len()) {
        if std::mem::replace(&mut reached[start], true) {
            continue;
        }
        let mut leftmost = start;
        stack.push(start);
        while let Some(vertex) = stack.pop() {
            leftmost = std::cmp::min_by(leftmost, vertex, |&i, &j| order(i, j));
            for &h in fans.get(vertex.index()) {
                let target = arrangement.target(h);
                if !std::mem::replace(&mut reached[target], true) {
                    stack.push(target);
                }
            }
        }
        outers.extend(most_upward(arrangement, fans, leftmost).map(|half_edge| OuterCycle { half_edge, leftmost }));
    }
    outers.sort_unstable_by(|p, q| order(p.leftmost, q.leftmost));
    outers
}

/// Returns the half-edge from a leftmost vertex that turns furthest to the left; what lies left of it is outside.
fn most_upward(arrangement: &Arrangement, fans: &Groups<HalfEdgeId>, leftmost: VertexId) -> Option<HalfEdgeId> {
    let origin = arrangement.points[leftmost];
    let target = |h: HalfEdgeId| arrangement.points[arrangement.target(h)];
    let later = |best: HalfEdgeId, h: HalfEdgeId| orientation(origin, target(best), target(h)) > 0.0;
    let fan = fans.get(leftmost.index()).iter().copied();
    fan.reduce(|best, h| if later(best, h) { h } else { best })
}

/// Makes a face of every cycle that is not an outer one.
fn mark_faces(arrangement: &mut Arrangement, outers: &[OuterCycle]) {
    let mut marked = vec![false; arrangement.face.len()];
    for h in outers.iter().flat_map(|outer| arrangement.cycle(outer.half_edge)) {
        marked[h] = true;
    }
    for h in HalfEdgeId::all(marked.len()) {
        if marked[h] {
            continue;
        }
        let face = FaceId::new(arrangement.faces.len());
        arrangement.faces.push(Face { outer: Some(h), inner: Vec::new(), winding: 0 });
        let mut at = h;
        while !std::mem::replace(&mut marked[at], true) {
            arrangement.face[at] = face;
            at = arrangement.next[at];
        }
    }
}

/// Puts each outer cycle into the face that holds its component.
fn place_outer_cycles(arrangement: &mut Arrangement, outers: &[OuterCycle]) {
    let search = (outers.len() > 1).then(|| LeftSearch::new(arrangement));
    for outer in outers {
        let holder = search.as_ref().and_then(|search| search.half_edge_left_of(arrangement, outer.leftmost));
        let face = holder.map_or(FaceId::UNBOUNDED, |h| arrangement.face[h]);
        let mut h = outer.half_edge;
        loop {
            arrangement.face[h] = face;
            h = arrangement.next[h];
            if h == outer.half_edge {
                break;
            }
        }
        arrangement.faces[face].inner.push(outer.half_edge);
    }
}

/// Finds the edge that a ray to the left meets first.
struct LeftSearch {
    grid: CellGrid,
    cells: Groups,
}

impl LeftSearch {
    fn new(arrangement: &Arrangement) -> Self {
        let points = &arrangement.points;
        let ends = arrangement.edges.iter().map(|edge| (points[edge.a], points[edge.b]));
        let radius = arrangement.report.tolerance;
        let grid = CellGrid::for_edges(ends.clone(), 4.0 * radius);
        let cells = Groups::of_edges(&grid, ends, radius);
        Self { grid, cells }
    }

    /// Returns the half-edge next to the left of a vertex, with the vertex on its left; ordinates are half-open.
    fn half_edge_left_of(&self, arrangement: &Arrangement, vertex: VertexId) -> Option<HalfEdgeId> {
        let p = arrangement.points[vertex];
        let row = self.grid.row(p.y);
        let mut nearest: Option<(Point, Point, HalfEdgeId)> = None;
        for column in (0..=self.grid.column(p.x)).rev() {
            for &edge in self.cells.get(self.grid.cell(column, row)) {
                let Some((low, high, down)) = rising(arrangement, edge as usize, p.y) else { continue };
                let nearer = |&(l, h, _): &(Point, Point, HalfEdgeId)| right_of((low, high), (l, h));
                if orientation(low, high, p) < 0.0 && nearest.as_ref().is_none_or(nearer) {
                    nearest = Some((low, high, down));
                }
            }
            // Edges that the ray meets further right have all been seen; those further left cannot be nearer.
            if nearest.is_some_and(|(low, high, _)| self.grid.column(abscissa(low, high, p.y)) >= column) {
                break;
            }
        }
        nearest.map(|(_, _, down)| down)
    }
}

/// Returns lower end, upper end and downward half-edge of an edge that spans an ordinate, lower end included.
fn rising(arrangement: &Arrangement, edge: usize, y: f64) -> Option<(Point, Point, HalfEdgeId)> {
    let Edge { a, b, .. } = arrangement.edges[edge];
    let (a, b) = (arrangement.points[a], arrangement.points[b]);
    let [along, against] = HalfEdgeId::both(edge);
    if a.y <= y && y < b.y {
        Some((a, b, against))
    } else if b.y <= y && y < a.y {
        Some((b, a, along))
    } else {
        None
    }
}

/// Whether, of two rising edges that do not cross, the first lies to the right where both exist.
fn right_of(e: (Point, Point), f: (Point, Point)) -> bool {
    let (side, turned) =
        if e.0.y >= f.0.y { (orientation(f.0, f.1, e.0), 1.0) } else { (orientation(e.0, e.1, f.0), -1.0) };
    if side != 0.0 {
        return side * turned < 0.0;
    }
    orientation(f.0, f.1, e.1) < 0.0
}

fn abscissa(low: Point, high: Point, y: f64) -> f64 {
    low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y))
}

/// Carries the winding from the unbounded face across every edge.
fn flood(arrangement: &mut Arrangement) {
    let mut reached = vec![false; arrangement.faces.len()];
    reached[FaceId::UNBOUNDED] = true;
    let mut stack = vec![FaceId::UNBOUNDED];
    while let Some(face) = stack.pop() {
        let winding = arrangement.faces[face].winding;
        let starts: Vec<HalfEdgeId> = arrangement.face_loops(face).collect();
        for start in starts {
            let mut h = start;
            loop {
                let other = arrangement.face[h.twin()];
                if !std::mem::replace(&mut reached[other], true) {
                    arrangement.faces[other].winding = winding - i32::from(arrangement.label_of(h).outline);
                    stack.push(other);
                }
                h = arrangement.next[h];
                if h == start {
                    break;
                }
            }
        }
    }
}

/// Refuses outlines whose winding depends on the way from outside.
fn check_winding(arrangement: &Arrangement) -> Result<(), GeometryError> {
    let winding = |h: HalfEdgeId| arrangement.faces[arrangement.face[h]].winding;
    for (k, edge) in arrangement.edges.iter().enumerate() {
        let [along, against] = HalfEdgeId::both(k);
        let found = winding(along) - winding(against);
        let expected = i32::from(edge.label.outline);
        if found != expected {
            let middle = (arrangement.points[edge.a] + arrangement.points[edge.b]) * 0.5;
            return Err(GeometryError::OpenOutline { x: middle.x, y: middle.y, found, expected });
        }
    }
    Ok(())
}
