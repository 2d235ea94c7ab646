//! Segments for arrangements, and the sanity check that tests run after every arrangement.

use enmm::geometry::{Arrangement, FaceId, HalfEdgeId, Label, Point, Segment, TraceId, orientation, polygon};

/// Sides of a closed polygon.
pub fn ring(points: &[[f64; 2]], label: Label) -> Vec<Segment> {
    let place = |k: usize| Point::new(points[k % points.len()][0], points[k % points.len()][1]);
    (0..points.len()).map(|k| Segment { a: place(k), b: place(k + 1), label }).collect()
}

/// Sides of a square, by its lower left corner.
pub fn square(x: f64, y: f64, side: f64, label: Label) -> Vec<Segment> {
    ring(&[[x, y], [x + side, y], [x + side, y + side], [x, y + side]], label)
}

/// A straight trace.
pub fn trace(index: usize, a: [f64; 2], b: [f64; 2]) -> Segment {
    Segment { a: Point::new(a[0], a[1]), b: Point::new(b[0], b[1]), label: Label::trace(TraceId::new(index)) }
}

/// Areas of the faces in the rock, the least first.
pub fn rock_areas(arrangement: &Arrangement) -> Vec<f64> {
    let rock = FaceId::all(arrangement.faces.len()).filter(|&face| arrangement.faces[face].winding == 1);
    let mut areas: Vec<f64> = rock.map(|face| arrangement.face_area(face)).collect();
    areas.sort_by(f64::total_cmp);
    areas
}

/// Asserts what holds for every arrangement: twins, cycles, faces, labels, winding, areas, Euler's formula, and edges
/// that meet in common vertices only (the last by testing every pair: for small inputs).
pub fn sanity_check(arrangement: &Arrangement) {
    let half_edges = arrangement.half_edges();
    assert_eq!((arrangement.next.len(), arrangement.face.len()), (half_edges.len(), half_edges.len()));
    let mut previous = vec![None; half_edges.len()];
    for h in half_edges {
        let next = arrangement.next[h];
        assert_eq!(arrangement.target(h), arrangement.origin(next), "next starts where its predecessor ends");
        assert_eq!(previous[next].replace(h), None, "next is a permutation");
        assert_ne!(next, h.twin(), "no dead ends");
        assert_eq!(arrangement.face[h], arrangement.face[next], "a cycle bounds one face");
        let (label, back) = (arrangement.label_of(h), arrangement.label_of(h.twin()));
        assert_eq!((label.outline, label.trace, label.mesh), (-back.outline, back.trace, back.mesh));
        assert!(label.outline != 0 || label.trace.is_some() || label.mesh.is_some(), "every edge comes from somewhere");
        let winding = |h: HalfEdgeId| arrangement.faces[arrangement.face[h]].winding;
        assert_eq!(winding(h) - winding(h.twin()), i32::from(label.outline));
    }
    check_faces(arrangement);
    check_crossings(arrangement);
}

/// Asserts that faces partition the half-edges and that V − E + F = 1 + C.
fn check_faces(arrangement: &Arrangement) {
    let mut seen = vec![false; arrangement.face.len()];
    let mut cycles = 0;
    let mut total = 0.0;
    for face in FaceId::all(arrangement.faces.len()) {
        for start in arrangement.face_loops(face) {
            cycles += 1;
            for h in arrangement.cycle(start) {
                assert_eq!(arrangement.face[h], face);
                assert!(!std::mem::replace(&mut seen[h], true), "one loop for each half-edge");
            }
        }
        let area = arrangement.face_area(face);
        assert!(face == FaceId::UNBOUNDED || area > 0.0, "face {face} has area {area}");
        total += area;
    }
    assert!(seen.iter().all(|&seen| seen), "every half-edge is in a loop of its face");
    assert_eq!((arrangement.faces[0].outer, arrangement.faces[0].winding), (None, 0));
    let extent = arrangement.points.iter().map(|p| p.amax()).fold(1.0, f64::max);
    // Every half-edge adds its area once forth and once back: round-off remains.
    assert!(total.abs() < 1e-13 * extent * extent * (1 + seen.len()) as f64, "areas sum to {total}");
    let components = cycles - (arrangement.faces.len() - 1);
    let (v, e, f) = (arrangement.points.len(), arrangement.edges.len(), arrangement.faces.len());
    assert_eq!(v + f, e + 1 + components, "Euler");
    assert_eq!(components, connected_parts(arrangement), "one outer cycle for each component");
}

fn connected_parts(arrangement: &Arrangement) -> usize {
    let mut parent: Vec<usize> = (0..arrangement.points.len()).collect();
    fn root(parent: &mut [usize], mut v: usize) -> usize {
        while parent[v] != v {
            parent[v] = parent[parent[v]];
            v = parent[v];
        }
        v
    }
    let mut count = parent.len();
    for edge in &arrangement.edges {
        let (a, b) = (root(&mut parent, edge.a.index()), root(&mut parent, edge.b.index()));
        if a != b {
            parent[a] = b;
            count -= 1;
        }
    }
    count
}

fn check_crossings(arrangement: &Arrangement) {
    let ends = |k: usize| [arrangement.edges[k].a, arrangement.edges[k].b].map(|v| arrangement.points[v]);
    for i in 0..arrangement.edges.len() {
        let [a, b] = ends(i);
        for j in 0..i {
            let [c, d] = ends(j);
            let crosses = |a: Point, b: Point, c: Point, d: Point| orientation(a, b, c) * orientation(a, b, d) < 0.0;
            assert!(!(crosses(a, b, c, d) && crosses(c, d, a, b)), "edges {i} and {j} cross");
        }
    }
}

/// Returns the face that holds a point which lies on no edge, by looking at every face.
pub fn face_at(arrangement: &Arrangement, p: Point) -> FaceId {
    let inside = |h: HalfEdgeId| polygon::contains(&arrangement.loop_points(h), p);
    FaceId::range(1..arrangement.faces.len())
        .find(|&face| arrangement.face_loops(face).filter(|&h| inside(h)).count() % 2 == 1)
        .unwrap_or(FaceId::UNBOUNDED)
}
