//! The dashpot of contacts shrank with the step, so that short steps let sliding blocks vibrate: at a quarter of the
//! default step a block of 12 by 6 m slid 21 times as far as Coulomb friction lets it.

use crate::common::parts::{dynamic, rock};
use crate::common::{simulation, step};

const SLOPE: f64 = 35.0;
const FRICTION: f64 = 40.0;
const GRAVITY: f64 = 9.81;

/// An elastic block on a plane at 35°, drawn with the plane along x, at rest under its own weight.
fn case(dt_max: f64) -> String {
    let slope = SLOPE.to_radians();
    let (along, down) = (GRAVITY * slope.sin(), -GRAVITY * slope.cos());
    format!(
        "title = \"slide\"\n[gravity]\nx = {along}\ny = {down}\n[domain]\n\
         outline = [[0, 0], [40, 0], [40, 4], [16, 4], [16, 10], [4, 10], [4, 4], [0, 4]]\n\
         [mesh]\nsize = 3.0\nangle_deg = 7.0\norigin = [0.13, 0.29]\n\
         [[joint]]\npoints = [[4, 4], [16, 4]]\n[joint_law.plane]\nfriction_deg = {FRICTION}\n\
         [[fix]]\nblock = [1.0, 1.0]\n[solver]\ndt_max = {dt_max:e}\n\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-6\n{}{}",
        rock(5e9, 2600.0),
        dynamic("slide", 100.0, 0.05)
    )
}

/// Distance (m) that the block slides from a velocity (m/s) until it rests.
fn distance(dt_max: f64, velocity: f64) -> f64 {
    let mut simulation = simulation(&case(dt_max));
    simulation.run_stage().unwrap_or_else(|e| panic!("{e}"));
    simulation.next_stage().unwrap_or_else(|e| panic!("{e}"));
    let block = simulation.block_states().iter().position(|block| !block.fixed).expect("a free block");
    let start = simulation.block_states()[block].displacement.x;
    let first = &simulation.model().covers.block_ranges.covers;
    let covers = first[block] as usize..first[block + 1] as usize;
    let mut state = simulation.state().clone();
    state.velocity[covers].iter_mut().for_each(|v| v.x += velocity);
    simulation.restore(state);
    let steps = simulation.steps_in(3.0);
    step(&mut simulation, steps);
    simulation.block_states()[block].displacement.x - start
}

/// v²/2a with the deceleration a = g(cos ψ·tan φ − sin ψ).
#[test]
fn a_block_slides_as_far_as_friction_lets_it_at_any_step() {
    let [slope, friction] = [SLOPE, FRICTION].map(f64::to_radians);
    let exact = 0.5 / (GRAVITY * (slope.cos() * friction.tan() - slope.sin()));
    for dt_max in [1e-2, 5e-4, 2.5e-4] {
        let ratio = distance(dt_max, 1.0) / exact;
        assert!((ratio - 1.0).abs() < 0.02, "dt_max {dt_max} s: {ratio} times the exact distance");
    }
}
