//! Claim: a model settles alike however it lies: mirrored, turned, shifted or with its points and joints listed in
//! another order, the mesh going with it.

use crate::common::extent::by_extent;
use crate::common::{run_stage, simulation};

type Place = [f64; 2];

/// How a model lies: mirrored at the y axis, then turned (degrees), then shifted (m).
#[derive(Clone, Copy)]
struct Lie {
    name: &'static str,
    mirrored: bool,
    turn_deg: f64,
    shift: Place,
    /// Whether its outline begins at another point and its joints are listed from the last to the first.
    renumbered: bool,
}

const UPRIGHT: Lie = Lie { name: "upright", mirrored: false, turn_deg: 0.0, shift: [0.0; 2], renumbered: false };

const OTHERS: [Lie; 5] = [
    Lie { name: "mirrored", mirrored: true, ..UPRIGHT },
    Lie { name: "turned", turn_deg: 37.0, ..UPRIGHT },
    Lie { name: "renumbered", renumbered: true, ..UPRIGHT },
    Lie { name: "shifted", shift: [13.7, -4.1], ..UPRIGHT },
    Lie { name: "all of it", mirrored: true, turn_deg: -71.0, shift: [-3.3, 8.9], renumbered: true },
];

impl Lie {
    fn vector(&self, [x, y]: Place) -> Place {
        let x = if self.mirrored { -x } else { x };
        let (sin, cos) = self.turn_deg.to_radians().sin_cos();
        [cos * x - sin * y, sin * x + cos * y]
    }

    fn point(&self, p: Place) -> Place {
        let [x, y] = self.vector(p);
        [x + self.shift[0], y + self.shift[1]]
    }

    /// The vector that lies so, as it was upright.
    fn upright(&self, [x, y]: Place) -> Place {
        let (sin, cos) = self.turn_deg.to_radians().sin_cos();
        let [x, y] = [cos * x + sin * y, cos * y - sin * x];
        [if self.mirrored { -x } else { x }, y]
    }
}

/// A model that stands on one edge under its weight.
struct Model {
    outline: Vec<Place>,
    joints: Vec<[Place; 2]>,
    foot: [Place; 2],
    law: &'static str,
    size: f64,
    angle_deg: f64,
    /// Where displacements are compared.
    monitors: Vec<Place>,
}

/// Tolerance of contacts and convergence.
const FINE: [f64; 2] = [1e-6, 1e-9];
const COARSE: [f64; 2] = [1e-2, 1e-7];

const GLUED: &str = "friction_deg = 30\ncohesion = 1e9\ntension = 1e9";
const ROUGH: &str = "friction_deg = 40";

impl Model {
    fn case(&self, lie: &Lie, [tolerance, convergence]: [f64; 2]) -> String {
        let list = |points: &[Place]| {
            let points: Vec<String> = points.iter().map(|&p| format!("{:?}", lie.point(p))).collect();
            format!("[{}]", points.join(", "))
        };
        let (mut outline, mut joints) = (self.outline.clone(), self.joints.clone());
        if lie.renumbered {
            outline.rotate_left(1);
            joints.reverse();
        }
        let joints: String = joints.iter().map(|points| format!("[[joint]]\npoints = {}\n", list(points))).collect();
        let monitor = |(k, &p): (usize, &Place)| format!("[[monitor]]\nname = \"{k}\"\npoint = {:?}\n", lie.point(p));
        let monitors: String = self.monitors.iter().enumerate().map(monitor).collect();
        let [gx, gy] = lie.vector([0.0, -9.81]);
        let angle_deg = lie.turn_deg + if lie.mirrored { -self.angle_deg } else { self.angle_deg };
        format!(
            "title = \"lies {}\"\n[domain]\noutline = {}\n[mesh]\nsize = {}\nangle_deg = {angle_deg:?}\norigin = {:?}\n\
             {joints}[rock.rock]\ndensity = 2600\nyoung = 5e9\npoisson = 0.25\n[joint_law.joint]\n{}\n[gravity]\n\
             x = {gx:?}\ny = {gy:?}\n[solver]\ncontact_tolerance = {tolerance:e}\n[[fix]]\nedge = {}\n[[stage]]\n\
             name = \"settle\"\nkind = \"static\"\nduration = 20.0\nramp = 1.0\nconvergence = {convergence:e}\n\
             {monitors}",
            lie.name,
            list(&outline),
            self.size,
            lie.point([0.0137, 0.0071]),
            self.law,
            list(&self.foot)
        )
    }

    /// Settled displacements of the monitors (m), turned upright.
    fn settle(&self, lie: &Lie, accuracy: [f64; 2]) -> Vec<Place> {
        let mut simulation = simulation(&self.case(lie, accuracy));
        let report = run_stage(&mut simulation);
        assert!(simulation.at_rest(&report), "{}: {report:?}", lie.name);
        let displacement = |k: usize| simulation.monitor(k).0;
        (0..self.monitors.len()).map(displacement).map(|u| lie.upright([u.x, u.y])).collect()
    }

    /// The model settles alike in all `lies` up to a share `most` of its largest displacement.
    fn settles_alike(&self, name: &str, lies: &[Lie], accuracy: [f64; 2], most: f64) {
        let upright = self.settle(&UPRIGHT, accuracy);
        let largest = upright.iter().flatten().fold(0.0f64, |a, b| a.max(b.abs()));
        for lie in lies {
            let other = self.settle(lie, accuracy);
            let differences = upright.iter().flatten().zip(other.iter().flatten()).map(|(a, b)| (a - b).abs());
            let difference = differences.fold(0.0, f64::max) / largest;
            println!("{name}, mesh {}°, {}: {difference:.1e} of {largest:.3e} m", self.angle_deg, lie.name);
            assert!(difference < most, "{name}, {} {}°: {difference} of {largest} m", lie.name, lie.turn_deg);
        }
    }
}

/// Lies of a model; the last of them is all of the others together.
fn others() -> &'static [Lie] {
    by_extent([&OTHERS[4..], &OTHERS, &OTHERS])
}

/// One block on another.
fn block(law: &'static str, angle_deg: f64) -> Model {
    Model {
        outline: vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.2], [2.2, 1.2], [2.2, 2.4], [0.7, 2.2], [0.7, 1.2], [0.0, 1.2]],
        joints: vec![[[0.7, 1.2], [2.2, 1.2]]],
        foot: [[0.0, 0.0], [3.0, 0.0]],
        law,
        size: 0.5,
        angle_deg,
        monitors: vec![[0.9, 2.0], [2.0, 2.1], [1.5, 0.6]],
    }
}

/// Two blocks on two others, over a crossing.
fn crossing(law: &'static str, angle_deg: f64) -> Model {
    Model {
        outline: vec![[0.0, 0.0], [3.0, 0.0], [3.0, 1.2], [2.5, 1.2], [2.5, 2.3], [0.5, 2.3], [0.5, 1.2], [0.0, 1.2]],
        joints: vec![[[0.5, 1.2], [2.5, 1.2]], [[1.3, 2.3], [1.75, 0.0]]],
        foot: [[0.0, 0.0], [3.0, 0.0]],
        law,
        size: 0.5,
        angle_deg,
        monitors: vec![[0.8, 2.0], [2.1, 2.1], [0.7, 0.6], [2.3, 0.6]],
    }
}

/// A wall of three times three blocks on a slab.
fn wall(law: &'static str, angle_deg: f64) -> Model {
    let level = |y: f64| [[0.0, y], [3.0, y]];
    let upright = |x: f64| [[x, 0.0], [x, 3.0]];
    Model {
        outline: vec![[0.0, -0.6], [3.0, -0.6], [3.0, 3.0], [0.0, 3.0]],
        joints: vec![level(0.0), level(1.0), level(2.0), upright(1.0), upright(2.0)],
        foot: [[0.0, -0.6], [3.0, -0.6]],
        law,
        size: 0.6,
        angle_deg,
        monitors: (0..9).map(|k| [0.45 + f64::from(k % 3), 0.55 + f64::from(k / 3)]).collect(),
    }
}

/// A slope of 16 m cut by two sets of joints at uneven distances.
fn slope(law: &'static str, angle_deg: f64) -> Model {
    let set = |dip_deg: f64, offsets: &[f64]| -> Vec<[Place; 2]> {
        let (sin, cos) = dip_deg.to_radians().sin_cos();
        let line = |offset: &f64| [-60.0, 60.0].map(|s| [16.0 + s * cos - offset * sin, 8.0 + s * sin + offset * cos]);
        offsets.iter().map(line).collect()
    };
    let mut joints = set(-17.0, &[-6.2, -1.1, 3.4, 6.9]);
    joints.extend(set(72.0, &[-12.3, -7.9, -4.2, 0.6, 4.4, 8.7]));
    Model {
        outline: vec![[0.0, -4.0], [32.0, -4.0], [32.0, 16.0], [16.0, 16.0], [8.0, 0.0], [0.0, 0.0]],
        joints,
        foot: [[0.0, -4.0], [32.0, -4.0]],
        law,
        size: 2.0,
        angle_deg,
        monitors: vec![[17.0, 15.0], [22.0, 14.0], [29.0, 15.0], [14.0, 8.0], [20.0, 6.0], [10.0, 2.0]],
    }
}

/// Angles (degrees) of the mesh.
fn angles() -> &'static [f64] {
    by_extent([&[17.0], &[17.0], &[0.0, 17.0]])
}

#[test]
fn long_blocks_settle_alike_however_they_lie() {
    for &angle_deg in angles() {
        for (name, law) in [("glued", GLUED), ("rough", ROUGH)] {
            block(law, angle_deg).settles_alike(&format!("block, {name}"), others(), FINE, 1e-7);
            crossing(law, angle_deg).settles_alike(&format!("crossing, {name}"), others(), FINE, 1e-7);
            wall(law, angle_deg).settles_alike(&format!("wall, {name}"), others(), FINE, 1e-7);
        }
    }
}

/// Friction keeps what the order of the sweeps left at the default tolerance.
#[test]
fn long_slopes_settle_alike_however_they_lie() {
    for &angle_deg in angles() {
        wall(ROUGH, angle_deg).settles_alike("wall, rough", others(), COARSE, 1e-4);
        for (name, law) in [("glued", GLUED), ("rough", ROUGH)] {
            slope(law, angle_deg).settles_alike(&format!("slope, {name}"), others(), COARSE, 5e-3);
        }
    }
}

/// Edges on slivers move as their ends do, whichever of two edges a node at rest faces by a hair.
#[test]
fn long_a_glued_wall_settles_alike_at_every_angle() {
    let every: Vec<f64> = (-18..=18).map(|k| 5.0 * f64::from(k)).collect();
    let turns = by_extent([&[-17.0, 37.0][..], &[-17.0, 37.0, 52.0, 90.0], &every]);
    let lies: Vec<Lie> = turns.iter().map(|&turn_deg| Lie { name: "turned", turn_deg, ..UPRIGHT }).collect();
    wall(GLUED, 17.0).settles_alike("wall, glued", &lies, FINE, 1e-7);
}
