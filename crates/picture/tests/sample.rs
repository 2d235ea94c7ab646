//! A made-up jointed slope, 100 m × 60 m, and what decorates its picture: no mechanics, only shapes and a slide.

use std::collections::{BTreeMap, BTreeSet};

use enmm::geometry::{Point, Vector};
use enmm::model::ContactState;
use enmm_observe::{BoltCondition, BondState, Boundary, JointPiece, Polygons, Snapshot};
use enmm_picture::{BoltMark, Held, HeldRow, LoadMark, ModelAnnotations, PortMark, PortPlace, SetMark};

/// Slope profile (m), counter-clockwise.
pub const PROFILE: [[f64; 2]; 6] = [[0.0, 0.0], [100.0, 0.0], [100.0, 60.0], [56.0, 60.0], [32.0, 15.0], [0.0, 15.0]];
/// The face of the slope (m).
const PROFILE_FACE: [[f64; 2]; 2] = [[56.0, 60.0], [32.0, 15.0]];
/// Directions (degrees) of the two joint sets.
const DIPS: [f64; 2] = [38.0, 112.0];

/// A slope before it moves, and what decorates its picture.
pub struct Sample {
    pub reference: Snapshot,
    pub annotations: ModelAnnotations,
    /// Position (m) of each star and the number of its physical covers.
    pub stars: Vec<(Point, u32)>,
}

pub fn profile() -> Polygons {
    let mut polygons = empty();
    push(&mut polygons, &PROFILE.map(Point::from));
    polygons
}

/// Blocks of about `spacing` (m), triangles of side `mesh` (m).
pub fn sample(spacing: f64, mesh: f64) -> Sample {
    let mut reference = Snapshot {
        elements: empty(),
        joint_laws: vec!["bedding".to_owned(), "cross joint".to_owned()],
        rocks: vec!["granite".to_owned()],
        ..Snapshot::default()
    };
    let mut covers: BTreeMap<[i64; 2], BTreeSet<u32>> = BTreeMap::new();
    let mut trace_segments = Vec::new();
    for block in blocks(spacing) {
        let id = reference.boundaries.len() as u32;
        for (nodes, triangle) in triangles(&block, mesh) {
            let element = clipped(&block, &triangle);
            if area(&element) > 1e-9 {
                push(&mut reference.elements, &element);
                reference.block.push(id);
                for node in nodes {
                    covers.entry(node).or_default().insert(id);
                }
            }
        }
        trace_segments.extend(edges(&block).filter_map(|ends| Some((ends, set_of(&ends)?))));
        let mut loops = empty();
        push(&mut loops, &block);
        let fixed = block.iter().any(|corner| corner.y < 1e-6);
        reference.boundaries.push(Boundary {
            block: id,
            fixed,
            displacement: Vector::zeros(),
            reference: loops.points.clone(),
            loops,
        });
    }
    complete(&mut reference);
    let stars: Vec<(Point, u32)> =
        covers.iter().map(|(node, blocks)| (lattice(*node, mesh), blocks.len() as u32)).collect();
    let counts = vec![
        format!("{} blocks", reference.boundaries.len()),
        format!("{} manifold elements", reference.elements.len()),
    ];
    let annotations = ModelAnnotations { counts, trace_segments, ..annotations() };
    Sample { reference, annotations, stars }
}

/// One of every mark.
fn annotations() -> ModelAnnotations {
    let places =
        [("crest", [57.0, 59.5]), ("toe", [32.5, 15.5]), ("bench", [44.0, 37.0]), ("crest back", [60.0, 59.0])];
    let row = |held, outward: [f64; 2], points: Vec<Point>| HeldRow { held, outward: Vector::from(outward), points };
    let along = |from: [f64; 2], to: [f64; 2]| {
        let [from, to] = [from, to].map(Point::from);
        (0..=50).map(|k| from + (to - from) * (f64::from(k) / 50.0)).collect()
    };
    let port = |name: &str, place| PortMark { name: name.to_owned(), place };
    let (crest, edge) = (Point::new(57.0, 59.5), [Point::new(60.0, 60.0), Point::new(80.0, 60.0)]);
    ModelAnnotations {
        title: "Rock slope with two joint sets".to_owned(),
        held: vec![
            row(Held::Pinned, [0.0, -1.0], along([0.0, 0.0], [50.0, 0.0])),
            row(Held::Quiet, [0.0, -1.0], along([50.0, 0.0], [100.0, 0.0])),
            row(Held::Roller, [-1.0, 0.0], along([0.0, 0.0], [0.0, 15.0])),
            row(Held::FreeField, [1.0, 0.0], along([100.0, 0.0], [100.0, 60.0])),
        ],
        held_boxes: vec![[85.0, 1.0, 95.0, 6.0]],
        monitors: places.map(|(name, place)| (name.to_owned(), Point::from(place))).to_vec(),
        ports: vec![
            port("crest", PortPlace::Block(crest)),
            port("top", PortPlace::Boundary(edge)),
            port("plane", PortPlace::Joint([Point::new(40.0, 20.0), Point::new(60.0, 36.0)])),
        ],
        loads: vec![
            LoadMark::Point { point: crest, force: Vector::new(3e5, -1e5), moment: 1e4, label: "push".to_owned() },
            LoadMark::Traction { edge, traction: Vector::new(0.0, -1e4), label: "10 kPa".to_owned() },
            LoadMark::Pressure { edge: PROFILE_FACE.map(Point::from), pressure: 1e4, label: "lake 10 kPa".to_owned() },
            LoadMark::Joint { edge: [Point::new(70.0, 30.0), Point::new(80.0, 38.0)], label: "40 kPa".to_owned() },
        ],
        facts: vec!["gravity (0, −9.81) m/s²".to_owned()],
        sets: vec![SetMark {
            name: "set 1".to_owned(),
            detail: "38°, every 3.4 m".to_owned(),
            direction: Vector::new(0.8, 0.6),
            place: Some(Point::new(60.0, 40.0)),
        }],
        bolts: [(BoltCondition::Elastic, 45.0), (BoltCondition::Absent, 38.0)]
            .map(|(condition, y)| BoltMark {
                name: None,
                ends: [Point::new(48.0, y), Point::new(62.0, y - 4.0)],
                force: 2.1e5,
                condition,
            })
            .to_vec(),
        water: [[0.0, 17.0], [33.0, 17.0], [100.0, 40.0]].map(Point::from).to_vec(),
        pond: true,
        ..ModelAnnotations::default()
    }
}

impl Sample {
    /// The slope after blocks above a plane through the toe slid by up to `slide` (m).
    pub fn moved(&self, time: f64, slide: f64) -> Snapshot {
        let mut moved = Snapshot { time, ..self.reference.clone() };
        for boundary in &mut moved.boundaries {
            let corners = &mut boundary.loops.points;
            let centre = corners.iter().sum::<Vector>() / corners.len() as f64;
            boundary.displacement = displacement(&centre, &centre, slide);
            corners.iter_mut().for_each(|corner| *corner += displacement(corner, &centre, slide));
            let id = boundary.block as usize;
            for k in (0..moved.elements.len()).filter(|&k| moved.block[k] as usize == id) {
                for i in moved.elements.range(k) {
                    let u = displacement(&self.reference.elements.points[i], &centre, slide);
                    moved.displacement[i] = u;
                    moved.velocity[i] = u * 0.5;
                    moved.elements.points[i] += u;
                }
            }
        }
        moved
    }

    /// A piece of joint for each piece of trace, in all states.
    pub fn joints(&self) -> Vec<JointPiece> {
        let states = [ContactState::Open, ContactState::Slip, ContactState::Lock];
        let joint = |(k, (ends, law)): (usize, &([Point; 2], u32))| {
            let along = ends[1] - ends[0];
            let normal = Vector::new(along.y, -along.x).normalize();
            JointPiece {
                ends: *ends,
                normal,
                blocks: [k as u32, k as u32 + 1],
                law: *law,
                opening: 1e-3 * k as f64,
                slip: 2e-3 * k as f64,
                force: normal * (-26e3 * (60.0 - ends[0].y) * along.norm()),
                normal_stress: -26e3 * (60.0 - ends[0].y),
                shear_stress: 8e3 * (60.0 - ends[0].y),
                state: states[k % 3],
                bond: BondState::None,
                is_joint: k % 5 > 0,
            }
        };
        self.annotations.trace_segments.iter().enumerate().map(joint).collect()
    }
}

/// Displacement (m) at `place` of a block with the given centre: slide along a plane through the toe, and some turning.
fn displacement(place: &Point, centre: &Point, slide: f64) -> Vector {
    let dip = 38.0_f64.to_radians();
    let from_toe = centre - Point::new(32.0, 15.0);
    let above = from_toe.y * dip.cos() - from_toe.x * dip.sin();
    let amount = slide * (above / 10.0).clamp(0.0, 1.0) * (0.55 + 0.45 * (centre.x * 0.9 + centre.y * 0.7).sin().abs());
    let turn = 0.03 * amount * (centre.x * 1.7).sin();
    let arm = place - centre;
    Vector::new(-dip.cos(), -dip.sin()) * amount + Vector::new(-arm.y, arm.x) * turn
}

fn complete(snapshot: &mut Snapshot) {
    let elements = &snapshot.elements;
    snapshot.displacement = vec![Vector::zeros(); elements.points.len()];
    snapshot.velocity = snapshot.displacement.clone();
    snapshot.rock = vec![0; elements.len()];
    snapshot.stress = (0..elements.len())
        .map(|k| {
            let weight = -26e3 * (60.0 - elements.get(k)[0].y);
            [0.4 * weight, weight, 0.1 * weight]
        })
        .collect();
    snapshot.stress_zz = snapshot.stress.iter().map(|[xx, yy, _]| 0.25 * (xx + yy)).collect();
}

/// Parts of the profile between the joints of both sets.
fn blocks(spacing: f64) -> Vec<Vec<Point>> {
    let [along, across] = DIPS.map(|dip| Vector::new(dip.to_radians().cos(), dip.to_radians().sin()));
    let profile = profile().points;
    let count = (140.0 / spacing) as i64;
    let jitter = |k: i64, seed: f64| spacing * (k as f64 + 0.25 * (k as f64 * 2.3 + seed).sin());
    let cells = (-count..count).flat_map(|i| (-count..count).map(move |j| (i, j)));
    let cell = |(i, j): (i64, i64)| {
        let corner = |i, j| Point::new(50.0, 30.0) + along * jitter(i, 4.0) + across * jitter(j, 1.0);
        [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
    };
    cells.map(|at| without_spikes(clipped(&profile, &cell(at)))).filter(|block| area(block) > 1e-6).collect()
}

/// Triangles of the lattice that may meet the block, with their nodes.
fn triangles(block: &[Point], mesh: f64) -> Vec<([[i64; 2]; 3], Vec<Point>)> {
    let of = |part: fn(&Point) -> f64| {
        let values: Vec<f64> = block.iter().map(part).collect();
        (values.iter().copied().fold(f64::INFINITY, f64::min), values.iter().copied().fold(f64::NEG_INFINITY, f64::max))
    };
    let ((left, right), (low, high)) = (of(|p| p.x), of(|p| p.y));
    let rise = mesh * 0.75_f64.sqrt();
    let mut found = Vec::new();
    for j in (low / rise).floor() as i64 - 1..=(high / rise).ceil() as i64 {
        let shift = j as f64 * 0.5;
        for i in (left / mesh - shift).floor() as i64 - 2..=(right / mesh - shift).ceil() as i64 + 1 {
            for nodes in [[[i, j], [i + 1, j], [i, j + 1]], [[i + 1, j], [i + 1, j + 1], [i, j + 1]]] {
                found.push((nodes, nodes.iter().map(|node| lattice(*node, mesh)).collect()));
            }
        }
    }
    found
}

fn lattice([i, j]: [i64; 2], mesh: f64) -> Point {
    Point::new((i as f64 + 0.5 * j as f64) * mesh, j as f64 * mesh * 0.75_f64.sqrt())
}

/// The part of `subject` inside the convex `clip` (Sutherland and Hodgman).
fn clipped(subject: &[Point], clip: &[Point]) -> Vec<Point> {
    edges(clip).fold(subject.to_vec(), |polygon, [a, b]| {
        let side = |p: &Point| (b - a).perp(&(p - a));
        let mut kept = Vec::new();
        for [p, q] in edges(&polygon) {
            let (at_p, at_q) = (side(&p), side(&q));
            if at_p >= 0.0 {
                kept.push(p);
            }
            if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
                kept.push(p + (q - p) * (at_p / (at_p - at_q)));
            }
        }
        kept
    })
}

/// Without corners at which the outline turns back on itself, which clipping an outline that is not convex leaves.
fn without_spikes(mut polygon: Vec<Point>) -> Vec<Point> {
    while let Some(k) = (0..polygon.len()).find(|&k| is_spike(&polygon, k)) {
        polygon.remove(k);
    }
    polygon
}

fn is_spike(polygon: &[Point], k: usize) -> bool {
    let n = polygon.len();
    let (to, from) = (polygon[k] - polygon[(k + n - 1) % n], polygon[(k + 1) % n] - polygon[k]);
    to.perp(&from).abs() <= 1e-9 && to.dot(&from) <= 0.0
}

fn edges(polygon: &[Point]) -> impl Iterator<Item = [Point; 2]> {
    (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]])
}

fn area(polygon: &[Point]) -> f64 {
    0.5 * edges(polygon).map(|[p, q]| p.perp(&q)).sum::<f64>()
}

/// The joint set along which an edge runs.
fn set_of([from, to]: &[Point; 2]) -> Option<u32> {
    let along = to - from;
    let runs = |dip: &f64| {
        let (sin, cos) = dip.to_radians().sin_cos();
        along.norm() > 1e-6 && along.perp(&Vector::new(cos, sin)).abs() < 1e-6 * along.norm()
    };
    DIPS.iter().position(runs).map(|set| set as u32)
}

fn empty() -> Polygons {
    Polygons { start: vec![0], points: Vec::new() }
}

fn push(polygons: &mut Polygons, corners: &[Point]) {
    polygons.points.extend_from_slice(corners);
    polygons.start.push(polygons.points.len() as u32);
}
