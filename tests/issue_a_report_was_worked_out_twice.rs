//! A report on a state costs a step. It is worked out once for every state, and again whenever the state, its inputs or
//! its stage have changed: nothing that is kept is ever old.

use crate::common::simulation;
use allocation_counter::measure;
use enmm::geometry::Vector;
use enmm::model::{Simulation, Wanted};

const CASE: &str = r#"
title = "two blocks"
domain.outline = [[0, 0], [4, 0], [4, 2], [0, 2]]
mesh = { size = 0.1, origin = [0.031, 0.017] }
rock.rock = { density = 2500, young = 1e8, poisson = 0.25 }
joint_law.joint.friction_deg = 30
joint = [{ points = [[-1, 1.3], [5, 0.7]] }]
fix = [{ edge = [[0, 0], [4, 0]] }]
stage = [
    { name = "rest", kind = "static", duration = 1.0 },
    { name = "free", kind = "dynamic", duration = 1.0 },
]
"#;

fn built() -> Simulation {
    simulation(CASE)
}

/// The report now is that of a copy without cached values.
fn is_of_now(simulation: &Simulation, after: &str) {
    let mut copy = simulation.clone();
    copy.restore(simulation.state().clone());
    assert_eq!(simulation.report(), copy.report(), "after {after}");
    assert_eq!(simulation.report(), copy.report(), "again after {after}");
}

#[test]
fn a_report_is_always_that_of_the_state_now() {
    let mut simulation = built();
    let start = simulation.state().clone();
    is_of_now(&simulation, "the start");
    let first = simulation.report();
    simulation.advance(false).unwrap();
    is_of_now(&simulation, "a step");
    assert_ne!(simulation.report(), first);
    simulation.advance_part(0.5 * simulation.model().dt, Wanted::Nothing).unwrap();
    is_of_now(&simulation, "a part of a step");
    let drive = simulation.drive();
    (drive.from.gravity, drive.to.gravity) = (Vector::new(1.0, -9.0), Vector::new(1.0, -9.0));
    is_of_now(&simulation, "an input");
    simulation.return_to(&start);
    is_of_now(&simulation, "a rollback");
    assert_eq!(simulation.report(), first);
    simulation.next_stage().unwrap();
    is_of_now(&simulation, "a stage");
}

/// A step beside the model needs room for another state; numbers that are kept need none.
#[test]
fn a_second_look_costs_nothing() {
    let simulation = built();
    let look = || measure(|| _ = simulation.report()).count_total;
    assert!(look() > 0, "the first look takes no step");
    assert_eq!(look(), 0, "the second look takes a step");
}
