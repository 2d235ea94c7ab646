//! A joint that carries shear by cohesion and no normal force was swept to the limit, and its steps halved: forces were
//! measured against the normal force alone.

use crate::common::parts::{dynamic, rock};
use crate::common::{simulation, step};

/// Two blocks, one held, joined by cohesion, one pulled along the joint: no step is halved or left unsettled, and a
/// step takes few sweeps.
#[test]
fn shear_without_normal_force_settles() {
    let mut simulation = simulation(&format!(
        "title = \"shear\"\n[domain]\noutline = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]\n[mesh]\nsize = 0.55\n\
         origin = [0.03, 0.02]\n[[joint]]\npoints = [[-1.0, 1.0], [3.0, 1.0]]\n{}[joint_law.joint]\n\
         friction_deg = 0.0\n\
         cohesion = 1e9\ntension = 1e9\nshear_stiffness = 1e13\nnormal_stiffness = 1e13\n[gravity]\ny = 0.0\n[[fix]]\n\
         block = [1.0, 0.5]\n[[fix]]\nbox = [-1.0, 0.5, 3.0, 3.0]\naxes = \"y\"\n[[load]]\nkind = \"body\"\n\
         acceleration = [1.0, 0.0]\ntable = [[0.0, 0.0], [0.01, 1.0]]\n{}",
        rock(1e9, 2500.0),
        dynamic("pull", 0.05, 0.1)
    ));
    let steps = simulation.steps_in(0.05);
    step(&mut simulation, steps);
    let counters = simulation.state().counters;
    println!("{counters:?}");
    assert_eq!([counters.halved, counters.unsettled], [0, 0]);
    assert!(counters.sweeps < 20 * counters.substeps, "{counters:?}");
}
