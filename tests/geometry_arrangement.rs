//! Claim: the arrangement is a valid planar subdivision for every input, closes what lies within the tolerance, trims
//! dead ends and finds islands.

use crate::common::geometry::{face_at, ring, rock_areas, sanity_check, square, trace};
use crate::common::random::Random;
use enmm::geometry::{Arrangement, FaceId, GeometryError, Label, MeshEdgeId, Point, Segment, TraceId, arrange};

fn checked(segments: &[Segment], tolerance: f64) -> Arrangement {
    let arrangement = arrange(segments, tolerance).expect("arranges");
    sanity_check(&arrangement);
    arrangement
}

fn reversed(segments: Vec<Segment>) -> Vec<Segment> {
    segments.into_iter().map(|s| Segment { a: s.b, b: s.a, label: s.label }).collect()
}

#[test]
fn nothing_gives_the_unbounded_face_alone() {
    let arrangement = checked(&[], 1e-6);
    assert_eq!((arrangement.faces.len(), arrangement.points.len()), (1, 0));
    let arrangement = checked(&[trace(0, [0.0, 0.0], [1.0, 0.0]), trace(1, [2.0, 2.0], [2.0, 2.0])], 1e-6);
    assert_eq!(arrangement.faces.len(), 1);
    assert_eq!(arrangement.report.trimmed_edges, 1);
}

#[test]
fn two_joints_across_a_square_make_four_blocks() {
    let mut segments = square(0.0, 0.0, 2.0, Label::OUTLINE);
    segments.extend([trace(0, [-1.0, 1.0], [3.0, 1.0]), trace(1, [0.5, -1.0], [0.5, 3.0])]);
    let arrangement = checked(&segments, 1e-6);
    assert_eq!(rock_areas(&arrangement), [0.5, 0.5, 1.5, 1.5]);
    let traces = &arrangement.report.traces;
    assert_eq!((traces[0].kept, traces[0].in_rock), (2.0, 2.0)); // the ends outside are trimmed
    assert_eq!((traces[1].noded, arrangement.report.trimmed_edges, arrangement.report.trimmed_length), (4.0, 4, 4.0));
}

#[test]
fn undershooting_ends_close() {
    // Real traces stop up to 1e-8 m short of their neighbour: both joints do, on the outline and on each other.
    let mut segments = square(0.0, 0.0, 2.0, Label::OUTLINE);
    segments.extend([trace(0, [1e-8, 1.0], [2.0 - 1e-8, 1.0]), trace(1, [0.5, 1.0 + 1e-8], [0.5, 2.0 - 1e-8])]);
    let arrangement = checked(&segments, 1e-6);
    let areas = rock_areas(&arrangement);
    assert_eq!(areas.len(), 3);
    // The corners move by the gap of 1e-8 m, the areas by about as many m².
    assert!(areas.iter().zip([0.5, 1.5, 2.0]).all(|(a, b)| (a - b).abs() < 1e-7), "{areas:?}");
    assert_eq!(arrangement.report.trimmed_edges, 0);
    let open = checked(&segments, 1e-10);
    assert_eq!(rock_areas(&open).len(), 1, "below the gap the ends stay open");
}

#[test]
fn dangling_tip_is_trimmed_to_the_mesh_edge() {
    // Two triangles of a mesh share the diagonal; the joint ends inside the second.
    let mut segments = square(0.0, 0.0, 1.0, Label::OUTLINE);
    segments.extend(square(0.0, 0.0, 1.0, Label::mesh(MeshEdgeId::new(0))));
    let diagonal = Segment { a: Point::new(0.0, 0.0), b: Point::new(1.0, 1.0), label: Label::mesh(MeshEdgeId::new(4)) };
    segments.extend([diagonal, trace(0, [-0.5, 0.5], [0.75, 0.5])]);
    for (k, mesh) in segments.iter_mut().filter(|s| s.label.mesh.is_some()).enumerate() {
        mesh.label.mesh = Some(MeshEdgeId::new(k));
    }
    let arrangement = checked(&segments, 1e-6);
    assert_eq!(rock_areas(&arrangement), [0.125, 0.375, 0.5]);
    assert_eq!(arrangement.report.traces[0].kept, 0.5);
    assert_eq!(arrangement.report.traces[0].in_rock, 0.5);
    assert!(
        arrangement.edges.iter().filter(|edge| edge.label.mesh == Some(MeshEdgeId::new(4))).count() == 2,
        "the diagonal is split"
    );
    let border = arrangement.edges.iter().filter(|edge| edge.label.outline != 0);
    assert!(border.clone().count() == 5 && border.clone().all(|edge| edge.label.mesh.is_some()));
}

#[test]
fn mesh_direction_survives_merging_with_an_opposite_outline() {
    let mut segments = square(0.0, 0.0, 1.0, Label::OUTLINE);
    let backwards = reversed(square(0.0, 0.0, 1.0, Label::mesh(MeshEdgeId::new(0))));
    segments.extend(MeshEdgeId::all(4).zip(backwards).map(|(k, s)| Segment { label: Label::mesh(k), ..s }));
    let arrangement = checked(&segments, 1e-6);
    assert_eq!(arrangement.half_edges().len(), 8);
    for h in arrangement.half_edges() {
        let label = arrangement.label_of(h);
        let mesh = segments[4 + label.mesh.expect("a mesh edge").index()];
        let runs_with = (arrangement.points[arrangement.target(h)] - arrangement.points[arrangement.origin(h)])
            .dot(&(mesh.b - mesh.a))
            > 0.0;
        assert_eq!(label.mesh_reversed, !runs_with);
        assert_eq!(label.outline == 1, arrangement.face[h] != FaceId::UNBOUNDED);
    }
}

#[test]
fn closed_trace_inside_is_an_island_of_its_face() {
    let mut segments = square(0.0, 0.0, 4.0, Label::OUTLINE);
    segments.extend(square(1.0, 1.0, 1.0, Label::trace(TraceId::new(0))));
    segments.extend(square(1.25, 1.25, 0.5, Label::trace(TraceId::new(1))));
    segments.push(trace(2, [-1.0, 3.0], [5.0, 3.0]));
    let arrangement = checked(&segments, 1e-6);
    assert_eq!(rock_areas(&arrangement), [0.25, 0.75, 4.0, 11.0]);
    let holder = face_at(&arrangement, Point::new(0.5, 0.5));
    assert_eq!(arrangement.faces[holder].inner.len(), 1);
}

#[test]
fn holes_and_islands_wind_right() {
    let mut segments = square(0.0, 0.0, 10.0, Label::OUTLINE);
    segments.extend(reversed(square(2.0, 2.0, 6.0, Label::OUTLINE))); // a hole
    segments.extend(square(4.0, 4.0, 2.0, Label::OUTLINE)); // an island in it
    segments.extend(square(12.0, 0.0, 1.0, Label::OUTLINE)); // and one beside
    let arrangement = checked(&segments, 1e-6);
    assert_eq!(rock_areas(&arrangement), [1.0, 4.0, 64.0]);
    assert_eq!(arrangement.faces[0].inner.len(), 2);
    // The whole outline inside one mesh triangle.
    segments.extend(ring(&[[-50.0, -50.0], [90.0, -50.0], [10.0, 90.0]], Label::mesh(MeshEdgeId::new(0))));
    let arrangement = checked(&segments, 1e-6);
    assert_eq!(rock_areas(&arrangement), [1.0, 4.0, 64.0]);
    assert_eq!(arrangement.faces[0].inner.len(), 1);
}

#[test]
fn coincident_edges_share_their_labels() {
    let mut segments = square(0.0, 0.0, 1.0, Label::OUTLINE);
    segments.extend(square(1.0, 0.0, 1.0, Label::OUTLINE)); // leans on the first
    let fused = checked(&segments, 1e-6);
    assert_eq!(rock_areas(&fused), [2.0]);
    assert_eq!(fused.report.fused_outline_length, 1.0);
    segments.extend([trace(3, [1.0, 0.0], [1.0, 1.0]), trace(1, [1.0, 1.5], [1.0, 0.25])]);
    let parted = checked(&segments, 1e-6);
    assert_eq!(rock_areas(&parted), [1.0, 1.0]);
    assert_eq!(parted.report.fused_outline_length, 0.0);
    assert_eq!(parted.report.overlapping_traces, [[1, 3].map(TraceId::new)]);
    assert_eq!((parted.report.traces[3].in_rock, parted.report.traces[1].in_rock), (1.0, 0.75));
}

#[test]
fn unusable_input_is_refused_with_the_reason() {
    let far = trace(0, [0.0, 0.0], [f64::NAN, 1.0]);
    assert!(matches!(arrange(&[far], 1e-6), Err(GeometryError::NotFinite { index: 0, .. })));
    let line = trace(0, [6.7e6, 0.0], [6.7e6 + 1.0, 1.0]);
    assert!(matches!(arrange(&[line], 1e-9), Err(GeometryError::Tolerance { .. })));
    assert!(matches!(arrange(&[line], f64::NAN), Err(GeometryError::Tolerance { .. })));
    let mut torn = square(0.0, 0.0, 1.0, Label::OUTLINE);
    torn[0].label = Label::trace(TraceId::new(0));
    assert!(matches!(arrange(&torn, 1e-6), Err(GeometryError::OpenOutline { .. })));
}

#[test]
fn endless_joints_cost_no_more_than_their_rock() {
    // Without cutting off far outside, two thousand lines of 2e6 m would cross two million times.
    let mut segments = square(0.0, 0.0, 100.0, Label::OUTLINE);
    for k in 0..2000 {
        let (x, tilt) = (0.05 * f64::from(k), 1e4 * (f64::from(k % 7) - 3.0));
        segments.push(trace(k as usize, [x - tilt, -1e6], [x + tilt, 1e6]));
    }
    let arrangement = arrange(&segments, 1e-4).expect("arranges");
    assert!(arrangement.report.traces.iter().all(|t| t.noded < 600.0));
    assert!((rock_areas(&arrangement).iter().sum::<f64>() - 1e4).abs() < 1e-6);
}

/// A number from a small set of places, moved by up to two tolerances: near-coincidence in every guise.
fn crowded(random: &mut Random, tolerance: f64) -> f64 {
    f64::from(random.below(5)) + random.between(-2.0, 2.0) * tolerance
}

/// Between `least` and 60 segments, of 50 traces, whose ends have random coordinates.
fn segments(random: &mut Random, least: u32, coordinate: impl Fn(&mut Random) -> f64) -> Vec<Segment> {
    let count = least + random.below(60 - least);
    let segment = |_| {
        let mut point = || Point::new(coordinate(random), coordinate(random));
        let (a, b) = (point(), point());
        Segment { a, b, label: Label::trace(TraceId::new(random.below(50) as usize)) }
    };
    (0..count).map(segment).collect()
}

fn lattice_and_outline() -> Vec<Segment> {
    let mut segments = ring(&[[0.5, 0.25], [3.5, 0.25], [3.5, 3.75], [2.0, 1.0], [0.5, 3.75]], Label::OUTLINE);
    let mut push = |a: [i32; 2], b: [i32; 2]| {
        let [a, b] = [a, b].map(|p| Point::new(f64::from(p[0]), f64::from(p[1])));
        segments.push(Segment { a, b, label: Label::mesh(MeshEdgeId::new(segments.len())) });
    };
    for i in 0..5 {
        for j in 0..4 {
            push([i, j], [i, j + 1]);
            push([j, i], [j + 1, i]);
            if i < 4 {
                push([i, j], [i + 1, j + 1]);
            }
        }
    }
    segments
}

/// Seeds of the random subdivisions.
const SEEDS: u64 = 400;

#[test]
fn random_segments_make_a_valid_subdivision() {
    for seed in 0..SEEDS {
        checked(&segments(&mut Random::new(seed), 0, |random| random.between(0.0, 4.0)), 1e-7);
    }
}

#[test]
fn near_coincident_segments_settle() {
    for seed in 0..SEEDS {
        let tolerance = [1e-2, 1e-3, 1e-6, 1e-9][(seed % 4) as usize];
        checked(&segments(&mut Random::new(seed), 1, |random| crowded(random, tolerance)), tolerance);
    }
}

#[test]
fn clusters_of_a_few_tolerances_settle() {
    for seed in 0..SEEDS {
        checked(&segments(&mut Random::new(seed), 1, |random| random.between(0.0, 0.2)), 1e-2);
    }
}

#[test]
fn outline_mesh_and_near_coincident_traces_keep_the_rock() {
    for seed in 0..SEEDS {
        let mut all = lattice_and_outline();
        all.extend(segments(&mut Random::new(seed), 0, |random| crowded(random, 1e-4)));
        let arrangement = checked(&all, 1e-4);
        // Shoelace of the outline: 10.5 − 0.5·3·2.75 = 6.375; its 16 m of sides move by at most 1.5e-4 m.
        let total: f64 = rock_areas(&arrangement).iter().sum();
        assert!((total - 6.375).abs() < 16.0 * 1.5e-4, "seed {seed}: {total}");
    }
}
