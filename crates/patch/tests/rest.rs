//! Blocks at rest: they do not creep, shear springs return, wedges and stacks carry the forces of equilibrium.

use enmm_patch::{Hardening, Rule, Vector};

use super::parts::{points, rectangle};
use super::rigid::World;

const DENSITY: f64 = 2650.0;

fn on_a_row_of_blocks() -> World {
    let (sine, cosine) = 30f64.to_radians().sin_cos();
    let mut world = World::new(7.2e9, 35f64.to_radians().tan(), 1e-4, 4.0);
    world.gravity = Vector::new(9.81 * sine, -9.81 * cosine);
    world.rule.ledge = 5e-4;
    for k in 0..4 {
        let left = -1.5 + f64::from(k);
        world.add(&rectangle([left, -1.0], [left + 1.0, 0.0]), DENSITY, true);
    }
    world.add(&rectangle([-0.7, 0.0], [0.3, 1.0]), DENSITY, false);
    world
}

/// At 30°, with 35° of friction: less than a micrometre in two seconds.
#[test]
fn a_block_at_rest_does_not_creep() {
    let mut world = on_a_row_of_blocks();
    world.damping = 100.0;
    world.run(0.3);
    world.damping = 0.0;
    let start = world.rigid[4].centre;
    world.run(2.0);
    let creep = (world.rigid[4].centre - start).norm();
    println!("creep in two seconds: {creep:.1e} m, {:.1e} m/s", world.rigid[4].velocity.norm());
    assert!(creep < 1e-6);
}

/// Faces alone: a block that is pushed to and fro at 0.8 of the limit moves by force over stiffness and returns.
#[test]
fn shear_springs_return() {
    let (normal, shear) = (1e9, 5e8);
    let mut world = World::new(normal, 0.5, 1e-4, 1.0);
    (world.stiffness[1], world.rule.corner) = (shear, 0.0);
    world.add(&rectangle([-4.0, -1.0], [4.0, 0.0]), DENSITY, true);
    world.add(&rectangle([-0.5, 0.0], [0.5, 0.1]), DENSITY, false);
    world.damping = 200.0;
    world.run(0.3);
    let (start, weight) = (world.rigid[1].centre.x, world.rigid[1].mass * 9.81);
    let mut from = 0.0;
    for target in [0.4, -0.4, 0.4, 0.0] {
        for k in 0..4000 {
            world.gravity.x = 9.81 * (from + (target - from) * f64::from(k) / 4000.0);
            world.step();
        }
        world.run(0.05);
        let (way, elastic) = (world.rigid[1].centre.x - start, target * weight / shear);
        println!("pushed with {target} of the weight: {way:.3e} m, elastic {elastic:.3e} m");
        assert!((way - elastic).abs() < 0.02 * 0.4 * weight / shear);
        from = target;
    }
}

/// A frictionless wedge between two walls: N = W/(2 sin α) on each flank, damping included. At 45° the corners of the
/// walls lie on the middle line of the tip, where both flanks are as near: their springs change sides and the wedge
/// trembles, within 3 %.
#[test]
fn wedges_press_on_both_walls() {
    for degrees in [5.0f64, 15.0, 30.0, 45.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let mut world = World::new(7.2e9, 0.0, 1e-4, 1.0);
        world.damping = 50.0;
        let top = [3.0 * sine, 3.0 * cosine];
        world.add(&points(&[[0.0, 0.0], [3.0, 0.0], [3.0 + top[0], top[1]], top]), DENSITY, true);
        world.add(&points(&[[0.0, 0.0], [-top[0], top[1]], [-3.0 - top[0], top[1]], [-3.0, 0.0]]), DENSITY, true);
        let wedge = [[0.0, 0.0], [sine / cosine, 1.0], [-sine / cosine, 1.0]];
        let block = world.add(&points(&wedge), DENSITY, false);
        world.run(2.0);
        let rows = world.contacts.rows.iter().zip(&world.forces);
        let normal: f64 = rows.filter(|(row, _)| row.normal.y.abs() < 0.99).map(|(_, force)| force[0]).sum();
        // Gravity acts before the damping of the step.
        let weight = world.rigid[block].mass * 9.81 / (1.0 + world.damping * world.dt);
        let share = normal / (weight / sine);
        println!("wedge of {degrees}°: {share:.6} of the normal force, sideways {:.1e} m", world.rigid[block].centre.x);
        let limit = if degrees > 40.0 { 3e-2 } else { 1e-4 };
        assert!((share - 1.0).abs() < limit && world.rigid[block].centre.x.abs() < 1e-6);
    }
}

/// A stack of ten blocks sinks by its weights over faces and corner springs.
#[test]
fn a_stack_sinks_by_its_weights() {
    for corner in [0.0, 0.25] {
        let mut world = World::new(7.2e9, 0.5, 1e-4, 4.0);
        (world.rule, world.damping) = (Rule { corner, ..Rule::default() }, 40.0);
        world.add(&rectangle([-3.0, -1.0], [3.0, 0.0]), DENSITY, true);
        for k in 0..10 {
            world.add(&rectangle([-0.5, f64::from(k)], [0.5, f64::from(k + 1)]), DENSITY, false);
        }
        let start = world.rigid[10].centre.y;
        world.run(3.0);
        let weight = DENSITY * 9.81 / (1.0 + world.damping * world.dt);
        // Corners that lie on corners are at the side as well, where they have no depth: only those on the floor count.
        let joint = |k: u32, corners: f64| f64::from(k) * weight / (7.2e9 * (1.0 + corners * corner));
        let expected: f64 = joint(10, 2.0) + (1..10).map(|k| joint(k, 0.0)).sum::<f64>();
        let sinks = start - world.rigid[10].centre.y;
        println!("stack, corner springs of {corner} m: sinks {sinks:.5e} m, by hand {expected:.5e} m");
        assert!((sinks / expected - 1.0).abs() < 1e-3);
        assert!(world.rigid[10].centre.x.abs() < 1e-9);
    }
}

/// A sharp wedge that is driven at 10 m/s into a mouth of 2 mm between two loose blocks opens it and stays shallow.
#[test]
fn a_driven_wedge_stays_in_its_mouth() {
    for shift in [0.0, 4e-4, -7e-4] {
        for hardens in [0.003, f64::INFINITY] {
            let mut world = World::new(7.2e9, 20f64.to_radians().tan(), 2e-5, 4.0);
            world.rule = Rule { reach: 0.2, beside: 0.2, ..Rule::default() };
            world.hardening = Hardening { depth: hardens };
            world.add(&rectangle([0.0, -1.0], [10.0, 0.0]), DENSITY, true);
            world.add(&rectangle([4.0, 0.001], [5.0, 2.0]), DENSITY, false);
            world.add(&rectangle([5.002, 0.001], [6.002, 2.0]), DENSITY, false);
            let wedge = world.add(&points(&[[5.001 + shift, 2.005], [5.201, 3.5], [4.801, 3.5]]), DENSITY, false);
            world.rigid[wedge].velocity.y = -10.0;
            let mut deepest = 0.0f64;
            for _ in 0..5000 {
                world.step();
                deepest = deepest.max(world.contacts.deepest);
            }
            let opened = world.rigid[2].centre.x - world.rigid[1].centre.x - 1.0;
            let tip = world.outline(wedge).iter().map(|point| point.y).fold(f64::INFINITY, f64::min);
            println!(
                "driven wedge, off by {shift} m, hardens {hardens}: opens {opened:.3} m, deepest {:.2} mm",
                deepest * 1e3
            );
            assert!(opened > 0.1 && tip < 1.6 && deepest < 5e-3);
        }
    }
}
