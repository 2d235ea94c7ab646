//! Claim: a host shifts the water table by what it moves the level, and pressure in a joint pushes both of its faces
//! with opposite forces, by its table of time. The pressures themselves are checked by verification problem C9.

use crate::common::claims::{advance, block_at};
use crate::common::parts::{dynamic, rock};
use enmm::geometry::Vector;
use enmm::model::Simulation;

/// Foot (m) of a tension crack 14 m deep, behind a face 60 m high of 50° over a plane of 35°; the toe is the origin.
fn foot() -> [f64; 2] {
    [46.0 / 35f64.to_radians().tan(), 46.0]
}

/// The slope with its plane and crack, and `more`.
fn slope(more: &str) -> Simulation {
    let ([x, y], crest) = (foot(), 60.0 / 50f64.to_radians().tan());
    let right = x + 20.0;
    let outline = [[-20.0, -20.0], [right, -20.0], [right, 60.0], [crest, 60.0], [0.0, 0.0], [-20.0, 0.0]];
    crate::common::simulation(&format!(
        "title = \"plane slide\"\n[domain]\noutline = {outline:?}\n[mesh]\nsize = 7.0\norigin = [0.13, 0.07]\n\
         [[joint]]\npoints = [[0.0, 0.0], [{x:?}, {y:?}], [{x:?}, 60.0]]\n[joint_law.joint]\nfriction_deg = 35.0\n\
         {}[[fix]]\nblock = [-10.0, -10.0]\n{more}{}",
        rock(1e10, 2700.0),
        dynamic("one", 1.0, 0.1)
    ))
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

#[test]
fn a_host_shifts_the_table_by_what_it_moves_the_level() {
    let [x, y] = foot();
    let table = |rise: f64| format!("[water]\ntable = [[0.0, {rise:?}], [{x:?}, {:?}]]\nfaces = []\n", y + 7.0 + rise);
    let mut moved = slope(&table(0.0));
    assert_eq!(moved.model().water.as_ref().expect("water").surfaces[0].level, y + 7.0);
    moved.drive().to.water_level += 2.5;
    moved.drive().arrive();
    let (found, exact) = (pushed(&mut moved), pushed(&mut slope(&table(2.5))));
    // Sums of a few hundred terms: rounding alone.
    let scale = exact.0.norm();
    assert!(scale > 1e6 && (found.0 - exact.0).norm() < 1e-10 * scale, "{} of {}", found.0, exact.0);
    assert!((found.1 - exact.1).abs() < 1e-8 * scale, "{} of {}", found.1, exact.1);
}

#[test]
fn both_faces_of_a_joint_bear_opposite_forces_by_its_table_of_time() {
    let [x, y] = foot();
    let load = format!(
        "[[load]]\nkind = \"joint\"\nedge = [[0.0, 0.0], [{x:?}, {y:?}]]\npressure = 1e5\ntable = [[0.0, 0.5], [1.0, \
        1.0]]\n"
    );
    let mut simulation = slope(&load);
    let (force, _) = pushed(&mut simulation);
    let total: Vector = simulation.workspace().load_force.iter().sum();
    assert!(total.norm() < 1e-6 && (force - Vector::new(-y, x) * 5e4).norm() < 1e-4, "{force} {total}");
}
