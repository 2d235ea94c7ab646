//! Claim: a run stops with block, place and speed when rock outruns its waves, and not because a cover that a grain has
//! cut does, whose star lies far from the grain's rock and turns with it.

use crate::common::claims::block_at;
use crate::common::parts::{dynamic, rock};
use crate::common::{simulation, step};
use enmm::internals::step::Failure;
use enmm::model::Simulation;

const YOUNG: f64 = 1e9;
const DENSITY: f64 = 2500.0;
const SIZE: f64 = 1.0;

/// One free block with an initial motion, over a held one.
fn case(block: &str, motion: &str) -> Simulation {
    simulation(&format!(
        "title = \"runaway\"\n[domain]\noutline = [[0, -1], [4, -1], [4, 0], [0, 0]]\nislands = [{block}]\n\
         [mesh]\nsize = {SIZE}\norigin = [0.137, 0.071]\n[joint_law.joint]\nfriction_deg = 20.0\n\
         [[fix]]\nblock = [0.1, -0.9]\n[gravity]\ny = 0.0\n[[initial_velocity]]\n{motion}\n{}{}",
        rock(YOUNG, DENSITY),
        dynamic("fly", 1.0, 0.1)
    ))
}

/// Speed (m/s) of pressure waves, for ν = 0.25: M = 1.2 E.
fn wave_speed() -> f64 {
    (1.2 * YOUNG / DENSITY).sqrt()
}

#[test]
fn a_grain_spins_freely() {
    let grain = "[[2.0, 3.0], [2.05, 3.0], [2.0, 3.05]]";
    let spin = 1.5 * wave_speed() / SIZE;
    let mut simulation = case(grain, &format!("block = [2.01, 3.01]\nangular_velocity = {spin}"));
    let fastest = simulation.state().velocity.iter().map(|v| v.norm()).fold(0.0, f64::max);
    assert!(fastest > wave_speed(), "some cover outruns the waves: {fastest} m/s");
    step(&mut simulation, 50);
    let now = simulation.motion_of(block_at(&simulation, [2.01, 3.01])).angular_velocity;
    assert!((now / spin - 1.0).abs() < 0.01, "{now} of {spin} rad/s");
}

#[test]
fn rock_that_outruns_its_waves_stops_the_run() {
    let block = "[[1.0, 3.0], [3.0, 3.0], [3.0, 5.0], [1.0, 5.0]]";
    let speed = 1.1 * wave_speed();
    let mut simulation = case(block, &format!("block = [2, 4]\nvelocity = [0, {speed}]"));
    let failed = simulation.advance(false).expect_err("a runaway");
    assert_eq!(failed.block, block_at(&simulation, [2.0, 4.0]).number());
    assert!(failed.position.x > 0.9 && failed.position.x < 3.1 && failed.position.y > 2.9, "{failed}");
    let Failure::Runaway { speed: found, limit } = failed.failure else { panic!("{failed}") };
    assert!((found / speed - 1.0).abs() < 0.01 && (limit / wave_speed() - 1.0).abs() < 1e-9, "{failed}");
}
