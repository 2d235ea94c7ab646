//! Claim C9, water: a table from the crack's water down to the toe presses on crack and sliding plane with
//! V = ½γw·zw² and U = ½γw·zw·A, a joint load with the same pressures does as much, and a host shifts the table.

mod common;

use common::claims::{advance, block_at};
use enmm::geometry::Vector;
use enmm::model::Simulation;

const GRAVITY: f64 = 9.81;

/// A slope of height H with a vertical tension crack of depth z, a face and a daylighting plane (degrees).
struct Slope {
    height: f64,
    crack: f64,
    face: f64,
    plane: f64,
}

impl Slope {
    /// Foot of the crack (m); the toe is the origin.
    fn foot(&self) -> [f64; 2] {
        let rise = self.height - self.crack;
        [rise / self.plane.to_radians().tan(), rise]
    }

    fn build(&self, more: &str) -> Simulation {
        let ([x, y], crest) = (self.foot(), self.height / self.face.to_radians().tan());
        let (h, right) = (self.height, x + 20.0);
        let outline = [[-20.0, -20.0], [right, -20.0], [right, h], [crest, h], [0.0, 0.0], [-20.0, 0.0]];
        common::simulation(&format!(
            "title = \"plane slide\"\n[domain]\noutline = {outline:?}\n[mesh]\nsize = 7.0\norigin = [0.13, 0.07]\n\
             [[joint]]\npoints = [[0.0, 0.0], [{x:?}, {y:?}], [{x:?}, {h:?}]]\n[joint_law.joint]\nfriction_deg = 35.0\n\
             [rock.rock]\ndensity = 2700.0\nyoung = 1e10\npoisson = 0.25\n[[fix]]\nblock = [-10.0, -10.0]\n{more}\
             [[stage]]\nname = \"one\"\nkind = \"dynamic\"\nduration = 1.0\n"
        ))
    }

    /// What V and U come to, and their moment about the toe, for water in the crack that is `depth` (m) deep.
    fn water(&self, depth: f64) -> (Vector, f64) {
        let (s, c) = self.plane.to_radians().sin_cos();
        let [x, y] = self.foot();
        let (weight, area) = (1000.0 * GRAVITY, (self.height - self.crack) / s);
        let thrust = Vector::new(-0.5 * weight * depth * depth, 0.0);
        let uplift = Vector::new(-s, c) * (0.5 * weight * depth * area);
        let at = Vector::new(c, s) * (area * 2.0 / 3.0);
        (thrust + uplift, Vector::new(x, y + depth / 3.0).perp(&thrust) + at.perp(&uplift))
    }
}

/// Resultant and moment about the origin of what loads and water push the sliding block with in the first step.
fn pushed(simulation: &mut Simulation) -> (Vector, f64) {
    let block = block_at(simulation, [40.0, 45.0]);
    advance(simulation, 1);
    let (mut force, mut moment) = (Vector::zeros(), 0.0);
    for i in simulation.model().covers.covers_of(block) {
        force += simulation.workspace().load_force[i];
        moment += simulation.model().covers.star_position[i].perp(&simulation.workspace().load_force[i]);
    }
    (force, moment)
}

fn assert_close(found: (Vector, f64), exact: (Vector, f64)) {
    // Sums of a few hundred terms: rounding alone.
    let scale = exact.0.norm().max(1.0);
    assert!((found.0 - exact.0).norm() < 1e-10 * scale, "{} of {}", found.0, exact.0);
    assert!((found.1 - exact.1).abs() < 1e-8 * scale, "{} of {}", found.1, exact.1);
}

#[test]
fn crack_and_plane_bear_the_water_of_hoek_and_bray() {
    let book = Slope { height: 60.0, crack: 14.0, face: 50.0, plane: 35.0 };
    for (slope, depth) in
        [(&book, 7.0), (&book, 14.0), (&Slope { height: 55.0, crack: 9.5, face: 57.0, plane: 31.0 }, 6.2)]
    {
        let [x, y] = slope.foot();
        let table = format!("[water]\ntable = [[0.0, 0.0], [{x:?}, {:?}]]\nfaces = []\n", y + depth);
        assert_close(pushed(&mut slope.build(&table)), slope.water(depth));
        // The same as two loads in the joints; the upper one ends at the water in the crack.
        let wet = y + depth;
        let most = 1000.0 * GRAVITY * depth;
        let load = |from: [f64; 2], to: [f64; 2], p: f64, q: f64| {
            format!("[[load]]\nkind = \"joint\"\nedge = [{from:?}, {to:?}]\npressure = {p:?}\npressure_end = {q:?}\n")
        };
        let loads = load([0.0, 0.0], [x, y], 0.0, most) + &load([x, y], [x, wet], most, 0.0);
        assert_close(pushed(&mut slope.build(&loads)), slope.water(depth));
    }
}

#[test]
fn a_host_shifts_the_table_by_what_it_moves_the_level() {
    let slope = Slope { height: 60.0, crack: 14.0, face: 50.0, plane: 35.0 };
    let [x, y] = slope.foot();
    let table = |rise: f64| format!("[water]\ntable = [[0.0, {rise:?}], [{x:?}, {:?}]]\nfaces = []\n", y + 7.0 + rise);
    let mut moved = slope.build(&table(0.0));
    assert_eq!(moved.model().water.as_ref().expect("water").level, y + 7.0);
    moved.drive().to.water_level += 2.5;
    moved.drive().arrive();
    assert_close(pushed(&mut moved), pushed(&mut slope.build(&table(2.5))));
}

#[test]
fn both_faces_of_a_joint_bear_opposite_forces_by_its_table_of_time() {
    let slope = Slope { height: 60.0, crack: 14.0, face: 50.0, plane: 35.0 };
    let [x, y] = slope.foot();
    let load = format!(
        "[[load]]\nkind = \"joint\"\nedge = [[0.0, 0.0], [{x:?}, {y:?}]]\npressure = 1e5\ntable = [[0.0, 0.5], [1.0, \
        1.0]]\n"
    );
    let mut simulation = slope.build(&load);
    let (force, _) = pushed(&mut simulation);
    let total: Vector = simulation.workspace().load_force.iter().sum();
    assert!(total.norm() < 1e-6 && (force - Vector::new(-y, x) * 5e4).norm() < 1e-4, "{force} {total}");
}
