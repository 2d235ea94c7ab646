//! Claim: in small displacements contacts stay those of the step that found them, with their normals, lengths and
//! places, and only their gaps follow the motion. So a block slides on by the formula where its way would bring it
//! against a wall, one that stays settles as it does in full, and a restored state ends it.

use crate::common::claims::{advance, block_at};
use crate::common::{run_stage, simulation};
use enmm::geometry::Vector;
use enmm::model::Simulation;

/// A block of 3 m by 2 m on a plane under 30° (gravity is turned, not the plane), and a wall 20 mm before it.
const BLOCK: &str = r#"
title = "block before a wall"
domain.outline = [[-2, -2], [8, -2], [8, 0.5], [3.02, 0.5], [3.02, 0], [3, 0], [3, 2], [0, 2], [0, 0], [-2, 0]]
mesh = { size = 0.9, origin = [0.031, 0.017] }
gravity = { x = 4.905, y = -8.495709211125344 }
joint = [{ points = [[0, 0], [3, 0]] }]
rock.rock = { density = 2500, young = 5e9, poisson = 0.25 }
joint_law.joint.friction_deg = 40
fix = [{ block = [-1, -1] }]
stage = [
    { name = "settle", kind = "static", duration = 5 },
    { name = "slide", kind = "dynamic", duration = 2, damping = 0.1, law = [{ law = "joint", friction_deg = 20 }] },
]
"#;

/// The block as it begins to slide.
fn on_its_way() -> Simulation {
    let mut simulation = simulation(BLOCK);
    run_stage(&mut simulation);
    assert!(simulation.next_stage().expect("a stage"));
    simulation
}

/// Displacement of the block (m).
fn displacement(simulation: &Simulation) -> Vector {
    simulation.motion_of(block_at(simulation, [1.5, 1.0])).displacement
}

/// Way (m) of the block in a second.
fn way(simulation: &mut Simulation) -> f64 {
    let before = displacement(simulation).x;
    advance(simulation, simulation.steps_in(1.0));
    displacement(simulation).x - before
}

#[test]
fn a_block_slides_on_by_the_formula_where_a_wall_would_catch_it() {
    let mut simulation = on_its_way();
    let start = simulation.state().clone();
    let exact = 0.5 * (4.905 - 20f64.to_radians().tan() * 8.495709211125344);
    simulation.assume_small_displacements();
    let small = way(&mut simulation);
    assert!((small / exact - 1.0).abs() < 5e-3, "{small} of {exact} m");
    simulation.restore(start);
    let large = way(&mut simulation);
    assert!((0.015..0.03).contains(&large), "{large} m: the wall is 20 mm away");
    let mut other = on_its_way();
    assert_eq!(way(&mut other).to_bits(), large.to_bits(), "nothing is left of small displacements");
}

/// It settles by some hundredths of a millimetre, of which the turn of its faces is a thousandth.
#[test]
fn a_block_that_stays_settles_as_it_does_in_full() {
    let [small, full] = [true, false].map(|is_small| {
        let mut simulation = simulation(BLOCK);
        if is_small {
            simulation.assume_small_displacements();
        }
        run_stage(&mut simulation);
        displacement(&simulation)
    });
    println!("{small:?} {full:?}");
    assert!((small - full).norm() < 1e-4 * full.norm(), "{small:?} {full:?}");
}
