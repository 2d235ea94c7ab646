//! Squares that fall on a floor at all angles, without damping: every bounce keeps the energy.

use enmm_patch::{Hardening, Rule, Vector};

use super::parts::{is_long, rectangle, turned_about};
use super::rigid::World;

const DENSITY: f64 = 2600.0;

struct Bounces {
    count: usize,
    worst: f64,
}

/// Change of energy (over that of the fall) from flight to flight.
fn bounces(angle: f64, stiffness: f64, corner: f64, hardens: f64, time: f64) -> Bounces {
    let mut world = World::new(stiffness, 0.0, 2e-5, 0.0);
    (world.rule, world.hardening) = (Rule { reach: 0.4, corner, ..Rule::default() }, Hardening { depth: hardens });
    world.add(&rectangle([-40.0, -2.0], [40.0, 0.0]), DENSITY, true);
    let square = turned_about(&rectangle([0.0, 0.0], [1.0, 1.0]), angle, Vector::default());
    let square: Vec<Vector> = square.into_iter().map(|point| point + Vector::new(0.0, 0.5)).collect();
    world.add(&square, DENSITY, false);
    // Velocities belong to half steps: the first kick is half a step.
    world.rigid[1].velocity.y = 0.5 * world.dt * 9.81;
    let fall = DENSITY * 9.81 * 0.5;
    let (mut last, mut was_flying, mut found) = (None, true, Bounces { count: 0, worst: 0.0 });
    for _ in 0..(time / world.dt) as usize {
        let (before, height) = ((world.rigid[1].velocity, world.rigid[1].spin), world.rigid[1].centre.y);
        world.step();
        let body = &world.rigid[1];
        let mean = body.kinetic((before.0 + body.velocity) * 0.5, 0.5 * (before.1 + body.spin));
        let energy = mean + body.mass * 9.81 * height;
        let is_flying = world.contacts.rows.is_empty();
        if is_flying {
            if let Some(last) = last.filter(|_| !was_flying) {
                found.count += 1;
                found.worst = found.worst.max(f64::abs(energy - last) / fall);
            }
            last = Some(energy);
        }
        was_flying = is_flying;
    }
    found
}

/// 22 angles and two stiffnesses, with and without corner springs, linear and hardened; a second and a half of each, 12
/// seconds in the long form.
#[test]
fn long_bounces_keep_the_energy() {
    let time = if is_long() { 12.0 } else { 1.5 };
    for (corner, hardens) in [(0.0, f64::INFINITY), (0.3, f64::INFINITY), (0.3, 0.01)] {
        let (mut count, mut worst, mut over) = (0, 0.0f64, 0);
        for stiffness in [1e8, 1e9] {
            for angle in (1..44).step_by(2) {
                let found = bounces(f64::from(angle), stiffness, corner, hardens, time);
                assert!(found.count > 0);
                (count, worst) = (count + found.count, worst.max(found.worst));
                over += usize::from(found.worst > 1e-4);
            }
        }
        println!(
            "drops, corner {corner}, hardens {hardens}: {count} bounces, worst {worst:.1e}, {over} falls over 1e-4"
        );
        assert!(over == 0, "{worst:e}");
    }
}
