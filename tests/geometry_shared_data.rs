//! Claim: real traces, slopes and cover cases give the block counts, areas and element counts on which independent
//! noders agree. The data stay outside the repository; the tests say so and skip when the folder is absent.

mod common;

use std::path::{Path, PathBuf};

use common::shared::shared;

use enmm::geometry::{Arrangement, FaceId, Label, MeshEdgeId, Point, Segment, TraceId, arrange};
use serde_json::Value;

fn read(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("readable")).expect("valid JSON")
}

fn points(list: &Value) -> Vec<Point> {
    let number = |p: &Value, k: usize| p[k].as_f64().expect("a number");
    list.as_array().expect("a list").iter().map(|p| Point::new(number(p, 0), number(p, 1))).collect()
}

fn cross(a: Point, b: Point) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Outline, counter-clockwise, and joints of a file.
fn segments(case: &Value) -> Vec<Segment> {
    let mut outline = points(&case["outline"]);
    outline.dedup();
    if outline.first() == outline.last() {
        outline.pop();
    }
    let n = outline.len();
    let area: f64 = (0..n).map(|k| cross(outline[k] - outline[0], outline[(k + 1) % n] - outline[0])).sum();
    if area < 0.0 {
        outline.reverse();
    }
    let mut all: Vec<Segment> =
        (0..n).map(|k| Segment { a: outline[k], b: outline[(k + 1) % n], label: Label::OUTLINE }).collect();
    for (trace, joint) in case["joints"].as_array().expect("a list").iter().enumerate() {
        let line = points(joint);
        let label = Label::trace(TraceId::new(trace));
        all.extend(line.windows(2).map(|piece| Segment { a: piece[0], b: piece[1], label }));
    }
    all
}

/// Adds the edges of the equilateral lattice over the box of the outline.
fn add_mesh(mesh: &Value, all: &mut Vec<Segment>) {
    let size = mesh["h"].as_f64().expect("a number");
    let angle = mesh["angle_deg"].as_f64().expect("a number").to_radians();
    let third = std::f64::consts::FRAC_PI_3;
    let a1 = size * Point::new(angle.cos(), angle.sin());
    let a2 = size * Point::new((angle + third).cos(), (angle + third).sin());
    let origin = points(&serde_json::json!([mesh["origin"]]))[0];
    let outline: Vec<Point> = all.iter().filter(|s| s.label.outline != 0).map(|s| s.a).collect();
    let reach = outline.iter().map(|p| ((p - origin).norm() / size) as i32 + 2).max().expect("an outline");
    let low = outline.iter().fold(outline[0], |low, p| low.inf(p)) - Point::repeat(1.1 * size);
    let high = outline.iter().fold(outline[0], |high, p| high.sup(p)) + Point::repeat(1.1 * size);
    let node = |i: i32, j: i32| origin + f64::from(i) * a1 + f64::from(j) * a2;
    let inside = |p: Point| p.x > low.x && p.y > low.y && p.x < high.x && p.y < high.y;
    let mut count = 0;
    for i in -2 * reach..=2 * reach {
        for j in -2 * reach..=2 * reach {
            // Edges of up triangles only: they hold every edge once. Triangles are taken whole: nothing dangles.
            let corners = [node(i, j), node(i + 1, j), node(i, j + 1)];
            if !corners.iter().any(|&p| inside(p)) {
                continue;
            }
            for k in 0..3 {
                all.push(Segment {
                    a: corners[k],
                    b: corners[(k + 1) % 3],
                    label: Label::mesh(MeshEdgeId::new(count)),
                });
                count += 1;
            }
        }
    }
}

/// Number and total area of the faces of rock.
fn rock(arrangement: &Arrangement) -> (usize, f64) {
    let faces: Vec<FaceId> = FaceId::all(arrangement.faces.len())
        .filter(|&face| {
            let winding = arrangement.faces[face].winding;
            assert!(winding == 0 || winding == 1, "winding {winding}");
            winding == 1
        })
        .collect();
    (faces.len(), faces.iter().map(|&face| arrangement.face_area(face)).sum())
}

#[test]
fn blocks_and_areas_agree_with_independent_noders() {
    let Some(data) = shared() else { return };
    let expected = read(&data.join("EXPECTED.json"));
    for (file, expected) in expected.as_object().expect("an object") {
        let case = read(&data.join(file));
        let tolerance = expected["snap_tol"].as_f64().expect("a number");
        let segments = segments(&case);
        let arrangement = arrange(&segments, tolerance).expect(file);
        let (blocks, area) = rock(&arrangement);
        eprintln!("{file}: {blocks} blocks, {area:.6} m², {:?} passes", arrangement.report.passes);
        assert_eq!(blocks as u64, expected["blocks"].as_u64().expect("a number"), "{file}: blocks");
        // Areas are given to 1e-6 m²; vertices move by up to 1.5 tolerances along an outline of up to about 2 km.
        let perimeter: f64 = segments.iter().filter(|s| s.label.outline != 0).map(|s| (s.b - s.a).norm()).sum();
        let off = (area - expected["total_area"].as_f64().expect("a number")).abs();
        assert!(off <= 1e-6 + 1.5 * tolerance * perimeter, "{file}: area {area} is off by {off}");
    }
}

#[test]
fn cover_cases_have_the_expected_elements_and_blocks() {
    let Some(data) = shared() else { return };
    let mut files: Vec<PathBuf> = std::fs::read_dir(data.join("cover_cases"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    assert!(!files.is_empty(), "the folder of cover cases is empty");
    for path in files {
        let case = read(&path);
        let mut segments = segments(&case);
        add_mesh(&case["mesh"], &mut segments);
        let arrangement = arrange(&segments, case["snap_tol"].as_f64().expect("a number")).expect("arranges");
        let (elements, area) = rock(&arrangement);
        let expected = &case["expected"];
        assert_eq!(elements as u64, expected["n_elements"].as_u64().expect("a number"), "{path:?}: elements");
        assert_eq!(blocks(&arrangement) as u64, expected["n_blocks"].as_u64().expect("a number"), "{path:?}: blocks");
        let total = expected["total_area"].as_f64().expect("a number");
        // Cutting adds up the same area in another order: round-off only, except that vertices snap by up to 1.5e-6 m.
        assert!((area - total).abs() < 1e-6 * total, "{path:?}: area {area} against {total}");
    }
}

/// Number of connected parts of the rock when mesh-only edges do not separate.
fn blocks(arrangement: &Arrangement) -> usize {
    let mut seen: Vec<bool> = arrangement.faces.iter().map(|face| face.winding != 1).collect();
    let mut count = 0;
    for start in FaceId::all(seen.len()) {
        if seen[start] {
            continue;
        }
        count += 1;
        seen[start] = true;
        let mut stack = vec![start];
        while let Some(face) = stack.pop() {
            for half_edge in arrangement.face_loops(face).flat_map(|h| arrangement.cycle(h)) {
                let label = arrangement.label_of(half_edge);
                let other = arrangement.face[half_edge.twin()];
                if label.outline == 0 && label.trace.is_none() && !std::mem::replace(&mut seen[other], true) {
                    stack.push(other);
                }
            }
        }
    }
    count
}
