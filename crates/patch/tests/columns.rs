//! Columns that topple and slide: the slope of R. E. Goodman and J. W. Bray (1976).

use enmm_patch::{Rule, Vector};

use super::parts::{is_long, rectangle};
use super::rigid::World;

/// Sixteen columns of 10 m on steps of 1 m, on an incline of 30°: limit by formula tan φ = 0.7855.
fn slope(stiffness: f64, corner: f64) -> World {
    let (sine, cosine) = 30f64.to_radians().sin_cos();
    let density = 25e3 / 9.81;
    let mut world = World::new(stiffness, 1.0, 1e-3, 4.0);
    world.rule = Rule { reach: 0.2, beside: 0.2, ledge: 1e-2, corner, ..Rule::default() };
    world.gravity = Vector::new(-9.81 * sine, -9.81 * cosine);
    let mut height = 0.0;
    for k in 0..16 {
        let (x, y) = (10.0 * f64::from(k), f64::from(k));
        let from = x - if k == 0 { 30.0 } else { 0.0 };
        let to = x + 10.0 + if k == 15 { 30.0 } else { 0.0 };
        world.add(&rectangle([from, y - 30.0], [to, y]), density, true);
    }
    for k in 0..16 {
        let (x, y) = (10.0 * f64::from(k), f64::from(k));
        height += if k < 10 { 4.0 } else { -6.0 };
        world.add(&rectangle([x, y], [x + 10.0, y + height]), density, false);
    }
    world
}

/// Whether it comes to rest within a time (s), before a column has moved by 0.4 m.
fn rests(world: &mut World, friction: f64, time: f64) -> bool {
    world.friction = friction;
    let (starts, mass) = (world.rigid.iter().map(|body| body.centre).collect::<Vec<_>>(), world.mass());
    let mut calm = 0;
    for k in 0..(time / world.dt) as usize {
        world.step();
        if k % 50 == 0 {
            let way = |(body, start): (&super::rigid::Rigid, &Vector)| (body.centre - *start).norm();
            if world.rigid.iter().zip(&starts).map(way).fold(0.0, f64::max) > 0.4 {
                return false;
            }
            calm = if world.kinetic() / mass < 1e-12 { calm + 1 } else { 0 };
            if calm > 20 {
                return true;
            }
        }
    }
    world.kinetic() / mass < 1e-8
}

fn limit(settled: &World, [mut low, mut high]: [f64; 2], steps: usize) -> f64 {
    for _ in 0..steps {
        let friction = 0.5 * (low + high);
        if rests(&mut settled.clone(), friction, 25.0) { high = friction } else { low = friction }
    }
    0.5 * (low + high)
}

/// Faces alone have the limit of the formula; corner springs find a rest somewhat below it.
#[test]
fn columns_rest_near_the_limit_of_the_formula() {
    let lengths = if is_long() { vec![0.0, 0.5, 2.0] } else { vec![0.0, 2.0] };
    for corner in lengths {
        let mut world = slope(1.44e10, corner);
        world.damping = 5.0;
        assert!(rests(&mut world, 1.0, 10.0));
        world.damping = 1.0;
        let limit = limit(&world, [0.76, 0.81], if is_long() { 6 } else { 4 });
        println!("Goodman and Bray, corner springs of {corner} m: tan φ = {limit:.4} (0.7855)");
    }
}
