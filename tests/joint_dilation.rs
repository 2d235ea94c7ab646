//! Claim: a joint that dilates lifts its block by slip times tan ψ, whatever its stiffness and the mesh (Eq. 21).

use crate::common::parts::{dynamic, rock};
use crate::common::{simulation, step_to};

const SLOPE: f64 = 35.0;
const FRICTION: f64 = 20.0;
const GRAVITY: f64 = 9.81;

/// Velocities (m/s) along and off the plane that a block of 12 by 6 m gains from 0.5 s to 1 s on a plane at 35°, drawn
/// along x; its joint has `stiffness` moduli of the rock per metre.
fn gained(mesh: f64, stiffness: f64, dilation_deg: f64) -> [f64; 2] {
    let slope = SLOPE.to_radians();
    let (along, down) = (GRAVITY * slope.sin(), -GRAVITY * slope.cos());
    let mut simulation = simulation(&format!(
        "title = \"slide\"\n[gravity]\nx = {along}\ny = {down}\n[domain]\n\
         outline = [[0, 0], [60, 0], [60, 4], [22, 4], [22, 10], [10, 10], [10, 4], [0, 4]]\n\
         [mesh]\nsize = {mesh}\nangle_deg = 7.0\norigin = [0.13, 0.29]\n[solver]\ncontact_stiffness = {stiffness}\n\
         [[joint]]\npoints = [[10, 4], [22, 4]]\n[joint_law.plane]\nfriction_deg = {FRICTION}\n\
         dilation_deg = {dilation_deg}\ndilation_slip = 100.0\n[[fix]]\nblock = [1.0, 1.0]\n{}{}",
        rock(5e9, 2600.0),
        dynamic("slide", 1.0, 0.05)
    ));
    let block = simulation.block_states().iter().position(|block| !block.fixed).expect("a free block");
    let velocity = [0.5, 1.0].map(|until| {
        step_to(&mut simulation, until);
        (simulation.time(), simulation.block_states()[block].velocity)
    });
    let [(start, before), (end, after)] = velocity;
    let gained = (after - before) * (0.5 / (end - start));
    [gained.x, gained.y]
}

/// A rigid block on a plane climbs at ψ to it: N = m(g cos α + a tan ψ), so that a (1 + tan φ tan ψ) = g (sin α −
/// tan φ cos α). Where the lift followed the step, stiff joints on coarse meshes lost most of it.
#[test]
fn a_block_climbs_its_asperities_as_it_slides() {
    let (slope, friction) = (SLOPE.to_radians(), FRICTION.to_radians().tan());
    for (mesh, stiffness) in [(3.0, 0.6), (6.0, 0.6), (6.0, 6.0)] {
        for dilation_deg in [0.0, 10.0, 20.0f64] {
            let climb = dilation_deg.to_radians().tan();
            let along = 0.5 * GRAVITY * (slope.sin() - friction * slope.cos()) / (1.0 + friction * climb);
            let found = gained(mesh, stiffness, dilation_deg);
            println!("mesh {mesh} m, stiffness {stiffness}, ψ = {dilation_deg}°: {found:?}, rigid {along}");
            let apart = (found[0] - along).hypot(found[1] - along * climb) / along;
            assert!(apart < 0.01, "mesh {mesh} m, stiffness {stiffness}, ψ = {dilation_deg}°: {found:?}, not {along}");
        }
    }
}
