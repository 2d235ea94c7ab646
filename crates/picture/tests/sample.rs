//! A jointed slope, 100 m × 60 m, and what decorates its picture: no mechanics, only shapes and a slide.

use enmm::geometry::{Point, Vector};
use enmm::model::{ContactState, Simulation};
use enmm_observe::{BoltCondition, BondState, JointPiece, Snapshot};
use enmm_picture::{
    BoltMark, Held, HeldRow, LoadMark, ModelAnnotations, PortMark, PortPlace, SetMark, model_annotations, stars,
};

/// Slope profile (m), counter-clockwise.
pub const PROFILE: [[f64; 2]; 6] = [[0.0, 0.0], [100.0, 0.0], [100.0, 60.0], [56.0, 60.0], [32.0, 15.0], [0.0, 15.0]];
/// The face of the slope (m).
const PROFILE_FACE: [[f64; 2]; 2] = [[56.0, 60.0], [32.0, 15.0]];
/// A slope before it moves, and what decorates its picture.
pub struct Sample {
    pub reference: Snapshot,
    pub annotations: ModelAnnotations,
    /// Position (m) of each star and the number of its physical covers.
    pub stars: Vec<(Point, u32)>,
}

/// Blocks of about `spacing` (m), triangles of side `mesh` (m); stresses by weight.
pub fn sample(spacing: f64, mesh: f64) -> Sample {
    let text = format!(
        r#"
title = "Rock slope with two joint sets"
domain.outline = {PROFILE:?}
mesh = {{ size = {mesh:?}, least_block = 0 }}
joint_set = [
    {{ angle_deg = 38, spacing = {spacing:?}, spacing_sd = {sd:?}, seed = 1, law = "bedding" }},
    {{ angle_deg = 112, spacing = {spacing:?}, spacing_sd = {sd:?}, seed = 2, law = "cross joint" }},
]
rock.granite = {{ density = 2650, young = 5e9, poisson = 0.25 }}
joint_law = {{ bedding = {{ friction_deg = 30 }}, "cross joint" = {{ friction_deg = 30 }} }}
fix = [{{ block = [50, 1] }}]
stage = [{{ name = "rest", kind = "static", duration = 1 }}]
"#,
        sd = 0.2 * spacing
    );
    let case = enmm_io::parse_case(&text, "slope.toml", "".as_ref()).unwrap_or_else(|e| panic!("{e}")).case;
    let simulation = Simulation::new(case).unwrap_or_else(|e| panic!("{e}"));
    let mut reference = Snapshot::of(&simulation);
    let elements = &reference.elements;
    let stress = |k: usize| {
        let weight = -26e3 * (60.0 - elements.get(k)[0].y);
        [0.4 * weight, weight, 0.1 * weight]
    };
    reference.stress = (0..elements.len()).map(stress).collect();
    reference.stress_zz = reference.stress.iter().map(|[xx, yy, _]| 0.25 * (xx + yy)).collect();
    let ModelAnnotations { trace_segments, counts, .. } = model_annotations(&simulation);
    Sample {
        reference,
        annotations: ModelAnnotations { trace_segments, counts, ..annotations() },
        stars: stars(&simulation),
    }
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
