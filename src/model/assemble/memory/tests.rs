use serde_json::json;

use super::*;
use crate::geometry::{Label, Segment, TraceId, arrange};

/// Side of the square that networks are laid in (m), and the snap tolerance (m).
const SIDE: f64 = 10.0;
const TOLERANCE: f64 = 1e-6 * SIDE;

/// Numbers from 0 to 1 by a simple generator.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / (1u64 << 24) as f64
    }

    fn point(&mut self, low: f64, high: f64) -> Point {
        Point::new(low + (high - low) * self.next(), low + (high - low) * self.next())
    }

    /// A line through a point at an angle (rad), for a length (m) to both sides.
    fn line(p: Point, angle: f64, length: f64) -> Vec<Point> {
        let along = Vector::new(angle.cos(), angle.sin()) * length;
        vec![p - along, p + along]
    }

    /// A few joints that lie as joints of one kind do.
    fn joints(&mut self) -> Vec<Vec<Point>> {
        let (count, angle, p) = (4 + (60.0 * self.next()) as usize, PI * self.next(), self.point(0.0, SIDE));
        let scale = 10f64.powf(-6.0 * self.next());
        let kind = (8.0 * self.next()) as usize;
        let mut one = |k: usize| match kind {
            0 => vec![self.point(-5.0, 15.0), self.point(-5.0, 15.0)],
            1 => vec![self.point(0.0, SIDE), self.point(0.0, SIDE), self.point(0.0, SIDE)],
            2 => Self::line(p + Vector::new(-angle.sin(), angle.cos()) * (scale * k as f64), angle, 12.0),
            3 => Self::line(p, PI * k as f64 / count as f64, 12.0),
            4 => Self::line(p + self.point(-1.0, 1.0) * scale, angle + self.next() * scale, 12.0 * self.next()),
            5 => Self::line(self.point(0.0, SIDE), PI * self.next(), 0.6 * self.next()),
            6 => Self::line(p + self.point(-1.0, 1.0) * scale, PI * self.next(), 6.0 * self.next()),
            _ => vec![self.point(11.0, 30.0), self.point(5.0, 40.0)],
        };
        (0..count).map(&mut one).collect()
    }
}

fn case(size: f64, memory: f64) -> Case {
    let case = json!({
        "title": "t", "domain": { "outline": [] }, "mesh": { "size": size }, "stage": [], "rock": {},
        "solver": { "memory_limit": memory as u64 },
    });
    serde_json::from_value(case).expect("a case")
}

/// The square, or what is left of it without its upper right quarter, or as two narrow legs.
fn outline(kind: usize) -> Vec<Point> {
    let leg = [SIDE, 5.0, 0.5][kind];
    let ring = [[0.0, 0.0], [SIDE, 0.0], [SIDE, leg], [leg, leg], [leg, SIDE], [0.0, SIDE]];
    let square = [ring[0], ring[1], [SIDE, SIDE], ring[5]];
    if kind == 0 { square.map(Point::from).into() } else { ring.map(Point::from).into() }
}

/// A part of the pieces, cut alone, has no more sides near each other than all of them, however they lie, so that no
/// model that fits is refused at the first look; where a bundle is drawn into one line, it has a few more.
#[test]
fn no_network_that_fits_when_it_is_cut_is_refused_at_the_first_look() {
    let mut numbers = Numbers(3);
    let mut most = 0.0f64;
    for round in 0..300 {
        let traces: Vec<Vec<Point>> = (0..1 + round % 4).flat_map(|_| numbers.joints()).collect();
        let (size, rock) = (0.5 + 2.0 * numbers.next(), outline(round % 3));
        let (low, high) = (Point::zeros(), Point::repeat(SIDE));
        let mesh = RegularMesh::new(size, numbers.next(), Point::zeros(), low, high);
        let pieces: Vec<Segment> = (traces.iter().enumerate())
            .flat_map(|(k, points)| {
                let label = Label::trace(TraceId::new(k));
                points.windows(2).map(move |p| Segment { a: p[0], b: p[1], label })
            })
            .collect();
        let cut = |step: usize| {
            let sides = polygon::sides(&rock).map(|(a, b)| Segment { a, b, label: Label::OUTLINE });
            let some = pieces.iter().step_by(step).copied();
            let segments: Vec<Segment> = sides.chain(some).chain(mesh.segments(low, high)).collect();
            arrange(&segments, TOLERANCE).expect("an arrangement")
        };
        let at = |memory: f64, act: &dyn Fn(&Demand) -> bool| {
            let case = case(size, memory);
            act(&Demand { case: &case, low, high })
        };
        let (all, some) = (cut(1), cut(2 + round % 5));
        let case = case(size, 1.0);
        let demand = Demand { case: &case, low, high };
        let [pairs, of_some] = [&all, &some].map(|arrangement| demand.near(arrangement).pairs);
        let bytes = demand.lattice_bytes() + pairs * BYTES_PER_PAIR;
        assert!(at(bytes + 1.0, &|demand| demand.check_edges(&all).is_ok()));
        assert!(!at(bytes - 1.0, &|demand| demand.check_edges(&all).is_ok()));
        most = most.max(of_some / pairs);
    }
    assert!(most < FLOOD, "{most} times the count");
}
