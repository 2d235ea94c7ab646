//! Half-edges, cycles, faces and winding of a set of edges that meet in common vertices only.
//!
//! Every decision rests on exact signs; nothing here knows a tolerance.

use super::arrangement::{Arrangement, Edge, Face, NONE, NodingReport};
use super::grid::{CellGrid, Groups};
use super::{GeometryError, Point, orientation};

/// Walks round the faces of edges that cross nowhere and have no dead ends, and floods the winding from outside.
pub(super) fn build(points: Vec<Point>, edges: Vec<Edge>, report: NodingReport) -> Result<Arrangement, GeometryError> {
    let next = vec![NONE; 2 * edges.len()];
    let face = vec![NONE; 2 * edges.len()];
    let faces = vec![Face { outer: NONE, inner: Vec::new(), winding: 0 }];
    let mut arrangement = Arrangement { points, edges, next, face, faces, report };
    let fans = fans(&arrangement);
    link(&mut arrangement, &fans);
    let outers = outer_cycles(&arrangement, &fans);
    mark_outer_cycles(&mut arrangement, &outers);
    mark_faces(&mut arrangement);
    place_outer_cycles(&mut arrangement, &outers);
    flood(&mut arrangement);
    check_winding(&arrangement)?;
    Ok(arrangement)
}

/// Groups the half-edges by origin, counter-clockwise from the direction of x.
fn fans(arrangement: &Arrangement) -> Groups {
    let points = &arrangement.points;
    let mut fans = Groups::build(points.len(), |put| {
        for h in 0..2 * arrangement.edges.len() as u32 {
            put(arrangement.origin(h) as usize, h);
        }
    });
    let mut fan = Vec::new();
    for (vertex, &origin) in points.iter().enumerate() {
        let group = fans.get_mut(vertex);
        fan.clear();
        fan.extend(group.iter().map(|&h| {
            let target = points[arrangement.target(h) as usize];
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
fn link(arrangement: &mut Arrangement, fans: &Groups) {
    for vertex in 0..arrangement.points.len() {
        let fan = fans.get(vertex);
        for (k, &h) in fan.iter().enumerate() {
            let before = fan[(k + fan.len() - 1) % fan.len()];
            arrangement.next[(h ^ 1) as usize] = before;
        }
    }
}

/// The outer cycle of one connected component.
struct OuterCycle {
    /// A half-edge of it, starting at the leftmost vertex.
    half_edge: u32,
    /// Leftmost vertex of the component, lowest among equals.
    leftmost: u32,
}

/// Finds the outer cycle of each component, ordered by leftmost vertex.
fn outer_cycles(arrangement: &Arrangement, fans: &Groups) -> Vec<OuterCycle> {
    let points = &arrangement.points;
    let mut sorted: Vec<u32> = (0..points.len() as u32).collect();
    sorted.sort_unstable_by(|&i, &j| {
        let (p, q) = (points[i as usize], points[j as usize]);
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(i.cmp(&j))
    });
    let mut reached = vec![false; points.len()];
    let (mut outers, mut stack) = (Vec::new(), Vec::new());
    for &leftmost in &sorted {
        if reached[leftmost as usize] {
            continue;
        }
        outers.push(OuterCycle { half_edge: most_upward(arrangement, fans, leftmost), leftmost });
        reached[leftmost as usize] = true;
        stack.push(leftmost);
        while let Some(vertex) = stack.pop() {
            for &h in fans.get(vertex as usize) {
                let target = arrangement.target(h);
                if !std::mem::replace(&mut reached[target as usize], true) {
                    stack.push(target);
                }
            }
        }
    }
    outers
}

/// Returns the half-edge from a leftmost vertex that turns furthest to the left; what lies left of it is outside.
fn most_upward(arrangement: &Arrangement, fans: &Groups, leftmost: u32) -> u32 {
    let origin = arrangement.points[leftmost as usize];
    let target = |h: u32| arrangement.points[arrangement.target(h) as usize];
    let fan = fans.get(leftmost as usize);
    let later = |&best: &u32, &h: &u32| orientation(origin, target(best), target(h)) > 0.0;
    fan.iter().copied().reduce(|best, h| if later(&best, &h) { h } else { best }).unwrap_or(NONE)
}

/// Gives the half-edges of outer cycles provisional face numbers counted down from the top.
fn mark_outer_cycles(arrangement: &mut Arrangement, outers: &[OuterCycle]) {
    for (k, outer) in outers.iter().enumerate() {
        mark_cycle(arrangement, outer.half_edge, provisional(k));
    }
}

/// Provisional face number of the outside of component `k`; [`NONE`] itself means unmarked.
const fn provisional(k: usize) -> u32 {
    NONE - 1 - k as u32
}

fn mark_cycle(arrangement: &mut Arrangement, start: u32, face: u32) {
    let mut h = start;
    loop {
        arrangement.face[h as usize] = face;
        h = arrangement.next[h as usize];
        if h == start {
            return;
        }
    }
}

/// Makes a face of every cycle that is not an outer one.
fn mark_faces(arrangement: &mut Arrangement) {
    for h in 0..arrangement.face.len() as u32 {
        if arrangement.face[h as usize] == NONE {
            let face = arrangement.faces.len() as u32;
            arrangement.faces.push(Face { outer: h, inner: Vec::new(), winding: 0 });
            mark_cycle(arrangement, h, face);
        }
    }
}

/// Puts each outer cycle into the face that holds its component.
fn place_outer_cycles(arrangement: &mut Arrangement, outers: &[OuterCycle]) {
    let search = (outers.len() > 1).then(|| LeftSearch::new(arrangement));
    for outer in outers {
        let holder = search.as_ref().and_then(|search| search.half_edge_left_of(arrangement, outer.leftmost));
        let face = holder.map_or(0, |h| arrangement.face[h as usize]);
        mark_cycle(arrangement, outer.half_edge, face);
        arrangement.faces[face as usize].inner.push(outer.half_edge);
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
        let ends = arrangement.edges.iter().map(|edge| (points[edge.a as usize], points[edge.b as usize]));
        let radius = arrangement.report.tolerance;
        let grid = CellGrid::for_edges(ends.clone(), 4.0 * radius);
        let cells = Groups::of_edges(&grid, ends, radius);
        Self { grid, cells }
    }

    /// Returns the half-edge next to the left of a vertex, with the vertex on its left; ordinates are half-open.
    fn half_edge_left_of(&self, arrangement: &Arrangement, vertex: u32) -> Option<u32> {
        let p = arrangement.points[vertex as usize];
        let row = self.grid.row(p.y);
        let mut nearest: Option<(Point, Point, u32)> = None;
        for column in (0..=self.grid.column(p.x)).rev() {
            for &edge in self.cells.get(self.grid.cell(column, row)) {
                let Some((low, high, down)) = rising(arrangement, edge, p.y) else { continue };
                let nearer = |&(l, h, _): &(Point, Point, u32)| right_of((low, high), (l, h));
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
fn rising(arrangement: &Arrangement, edge: u32, y: f64) -> Option<(Point, Point, u32)> {
    let Edge { a, b, .. } = arrangement.edges[edge as usize];
    let (a, b) = (arrangement.points[a as usize], arrangement.points[b as usize]);
    if a.y <= y && y < b.y {
        Some((a, b, 2 * edge + 1))
    } else if b.y <= y && y < a.y {
        Some((b, a, 2 * edge))
    } else {
        None
    }
}

/// Tells whether, of two rising edges that do not cross, the first lies to the right where both exist.
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
    reached[0] = true;
    let mut stack = vec![0u32];
    while let Some(face) = stack.pop() {
        let winding = arrangement.faces[face as usize].winding;
        let starts: Vec<u32> = arrangement.face_loops(face).collect();
        for start in starts {
            let mut h = start;
            loop {
                let other = arrangement.face[(h ^ 1) as usize] as usize;
                if !std::mem::replace(&mut reached[other], true) {
                    arrangement.faces[other].winding = winding - i32::from(arrangement.label_of(h).outline);
                    stack.push(other as u32);
                }
                h = arrangement.next[h as usize];
                if h == start {
                    break;
                }
            }
        }
    }
}

/// Refuses outlines whose winding depends on the way from outside.
fn check_winding(arrangement: &Arrangement) -> Result<(), GeometryError> {
    let winding = |h: usize| arrangement.faces[arrangement.face[h] as usize].winding;
    for (k, edge) in arrangement.edges.iter().enumerate() {
        let found = winding(2 * k) - winding(2 * k + 1);
        let expected = i32::from(edge.label.outline);
        if found != expected {
            let middle = (arrangement.points[edge.a as usize] + arrangement.points[edge.b as usize]) * 0.5;
            return Err(GeometryError::OpenOutline { x: middle.x, y: middle.y, found, expected });
        }
    }
    Ok(())
}
