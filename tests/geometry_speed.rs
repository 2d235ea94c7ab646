//! Claim: the arrangement grows about linearly; ten thousand joints take a fraction of a second, mesh or not.

use std::time::Instant;

use enmm::geometry::{Label, MeshEdgeId, Point, Segment, TraceId, arrange};
use enmm_verification::random::Random;

fn square(side: f64) -> Vec<Segment> {
    let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(x, y)| Point::new(x, y));
    (0..4).map(|k| Segment { a: corners[k], b: corners[(k + 1) % 4], label: Label::OUTLINE }).collect()
}

fn joints(count: usize, length: f64, random: &mut Random) -> Vec<Segment> {
    (0..count)
        .map(|k| {
            let middle = Point::new(100.0 * random.unit(), 100.0 * random.unit());
            let (sine, cosine) = (std::f64::consts::PI * random.unit()).sin_cos();
            let half = Point::new(cosine, sine) * (length * 0.5);
            Segment { a: middle - half, b: middle + half, label: Label::trace(TraceId::new(k)) }
        })
        .collect()
}

fn mesh(size: f64) -> Vec<Segment> {
    let height = size * 0.75f64.sqrt();
    let node = |i: i64, j: i64| Point::new((i as f64 + 0.5 * (j & 1) as f64) * size, j as f64 * height);
    let (columns, rows) = ((102.0 / size) as i64, (102.0 / height) as i64);
    let mut edges = Vec::new();
    for j in -2..rows {
        for i in -2..columns {
            let up = i + (j & 1);
            for (a, b) in
                [(node(i, j), node(i + 1, j)), (node(i, j), node(up, j + 1)), (node(i, j), node(up - 1, j + 1))]
            {
                edges.push(Segment { a, b, label: Label::mesh(MeshEdgeId::new(edges.len())) });
            }
        }
    }
    edges
}

/// Faces without the unbounded one, and seconds (best of three).
fn faces(segments: &[Segment]) -> (usize, f64) {
    (0..3).fold((0, f64::INFINITY), |best, _| {
        let start = Instant::now();
        let arrangement = arrange(segments, 1e-4).expect("arranges");
        (arrangement.faces.len() - 1, start.elapsed().as_secs_f64().min(best.1))
    })
}

#[test]
fn ten_thousand_joints_take_a_fraction_of_a_second() {
    let mut random = Random::from_word(1);
    let mut segments = square(100.0);
    segments.extend(joints(10_000, 4.7, &mut random));
    let (count, alone) = faces(&segments);
    println!("{} segments: {count} faces in {alone:.3} s", segments.len());
    segments.extend(mesh(0.5));
    let (count_mesh, with_mesh) = faces(&segments);
    println!("{} segments: {count_mesh} faces in {with_mesh:.3} s", segments.len());
    assert!(count_mesh > count && count > 10_000);
    // Ten times what an idle machine needs: this fails on quadratic growth (minutes), not on a busy machine.
    assert!(cfg!(debug_assertions) || (alone < 3.0 && with_mesh < 10.0), "{alone} s, {with_mesh} s");
}
