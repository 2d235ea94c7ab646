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

/// The estimates before cutting are made of samples; the edges of the arrangement are counted. No model that fits by
/// its edges is refused by an estimate, however its joints lie: in 3600 networks an estimate was at most 1.1 times the
/// count. Floods are seen: half of the estimates are above a sixteenth of the count.
#[test]
fn no_network_that_fits_when_it_is_cut_is_refused_by_an_estimate() {
    let mut numbers = Numbers(3);
    let (mut most, mut floods) = (0.0f64, 0);
    for round in 0..300 {
        let traces: Vec<(Vec<Point>, LawId)> =
            (0..1 + round % 4).flat_map(|_| numbers.joints()).map(|points| (points, LawId::new(0))).collect();
        let (size, rock) = (0.5 + 2.0 * numbers.next(), outline(round % 3));
        let (low, high) = (Point::zeros(), Point::repeat(SIDE));
        let mesh = RegularMesh::new(size, numbers.next(), Point::zeros(), low, high);
        let mut segments: Vec<Segment> =
            polygon::sides(&rock).map(|(a, b)| Segment { a, b, label: Label::OUTLINE }).collect();
        for (k, (points, _)) in traces.iter().enumerate() {
            segments.extend(points.windows(2).map(|p| Segment {
                a: p[0],
                b: p[1],
                label: Label::trace(TraceId::new(k)),
            }));
        }
        segments.extend(mesh.segments(low, high));
        let arrangement = arrange(&segments, TOLERANCE).expect("an arrangement");
        let at = |memory: f64, act: &dyn Fn(&Demand) -> bool| {
            let case = case(size, memory);
            act(&Demand { case: &case, low, high })
        };
        let is_rock = |p: Point| polygon::contains(&rock, p);
        let estimated = |demand: &Demand| {
            demand.check_dense(&traces, TOLERANCE, is_rock).is_ok()
                && demand.check_crossings(&traces, TOLERANCE, is_rock).is_ok()
        };
        let case = case(size, 1.0);
        let demand = Demand { case: &case, low, high };
        let counted = demand.cut(&arrangement);
        let bytes = demand.bytes_of(&counted);
        assert!(at(bytes + 1.0, &|demand| demand.check_edges(&arrangement).is_ok()));
        assert!(at(bytes + 1.0, &estimated), "round {round}: an estimate refuses {counted:?}");
        assert!(!at(bytes - 1.0, &|demand| demand.check_edges(&arrangement).is_ok()));
        let estimate = demand.dense(&traces, TOLERANCE, is_rock).pairs;
        let estimate = estimate.max(demand.crossed(&traces, TOLERANCE, is_rock).pairs);
        most = most.max(estimate / counted.pairs);
        floods += usize::from(FLOOD * FLOOD * estimate > counted.pairs);
    }
    assert!(most < FLOOD, "{most} times the count");
    assert!(floods > 150, "the estimates see too few floods: {floods} of 300");
}
