//! Blocks that slide over floors of many blocks, over steps and over open mouths, against the way of a rigid one.

use enmm_patch::{Hardening, Rule, Vector};

use super::parts::{Random, is_long, points, rectangle};
use super::rigid::World;

const DENSITY: f64 = 2650.0;
const STIFFNESS: f64 = 7.2e9;

/// A world on a plane of 30°, with friction 1 until it is at rest.
fn plane(rule: Rule) -> World {
    let (sine, cosine) = 30f64.to_radians().sin_cos();
    let mut world = World::new(STIFFNESS, 1.0, 1e-4, 4.0);
    world.gravity = Vector::new(9.81 * sine, -9.81 * cosine);
    world.rule = rule;
    world
}

/// The constants of these slides.
pub fn usual() -> Rule {
    Rule { reach: 0.05, beside: 0.05, ledge: 5e-4, ..Rule::default() }
}

/// Settles, slides for a time with 20° of friction; the way of a body (m), that of a rigid one, and the rise (m).
fn slide(world: &mut World, body: usize, time: f64) -> [f64; 3] {
    world.damping = 60.0;
    world.run(0.2);
    let start = world.rigid[body].centre;
    (world.friction, world.damping) = (20f64.to_radians().tan(), 0.0);
    world.stop();
    world.run(time);
    let way = world.rigid[body].centre - start;
    [way.x, 0.5 * (world.gravity.x + world.gravity.y * world.friction) * time * time, way.y]
}

/// A row of 22 blocks of 0.25 m with leaning sides, whose tops are off by random heights, under one or two blocks.
pub fn over_a_row(count: usize, corner: f64, off: f64, rule: Rule) -> f64 {
    let mut world = plane(rule);
    let mut random = Random::new(123 + corner as u64);
    let lean = 1.0 / corner.to_radians().tan();
    for k in 0..22 {
        let [left, right] = [0, 1].map(|j| -1.5 + 0.25 * f64::from(k + j));
        let top = off * random.share();
        let [left, right] = [left - if k == 0 { 1.0 } else { 0.0 }, right + if k == 21 { 3.0 } else { 0.0 }];
        let [from, to] = [if k == 0 { 0.0 } else { lean }, if k == 21 { 0.0 } else { lean }];
        let shape =
            [[left - 0.5 * from, -0.5], [right - 0.5 * to, -0.5], [right + to * top, top], [left + from * top, top]];
        world.add(&points(&shape), DENSITY, true);
    }
    let first = world.rigid.len();
    for k in 0..count {
        world.add(&rectangle([-0.97 + k as f64, off], [0.03 + k as f64, 1.0 + off]), DENSITY, false);
    }
    let [way, rigid, _] = slide(&mut world, first, 0.8);
    way / rigid
}

/// Level tops: the way is that of a rigid block, whatever the corners. Tops that are off by less than a ledge: within
/// one per cent.
#[test]
fn long_level_tops_let_blocks_pass() {
    let corners = if is_long() { vec![45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0] } else { vec![45.0, 90.0, 135.0] };
    for (off, limit) in [(0.0, 5e-4), (1e-6, 1e-3), (1e-5, 2.5e-3), (1e-4, 1e-2)] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for &corner in &corners {
            for count in [1, 2] {
                let share = over_a_row(count, corner, off, usual());
                range = [range[0].min(share), range[1].max(share)];
            }
        }
        println!("tops off by {off:.0e} m: {:.4} to {:.4} of the rigid way", range[0], range[1]);
        assert!(range.iter().all(|share| (share - 1.0).abs() < limit), "{off:e}: {range:?}");
    }
}

/// Two blocks of 1 m meet a step up, a step down or an open mouth after 5 cm.
pub fn over_a_step(mouth: f64, step: f64, hardens: f64, rule: Rule) -> [f64; 3] {
    let mut world = plane(rule);
    world.hardening = Hardening { depth: hardens };
    world.add(&rectangle([-2.0, -1.5], [2.05, 0.0]), DENSITY, true);
    world.add(&rectangle([2.05 + mouth, -1.5], [6.0, step]), DENSITY, true);
    for k in 0..2 {
        world.add(&rectangle([f64::from(k), 0.0], [f64::from(k + 1), 1.0]), DENSITY, false);
    }
    slide(&mut world, 3, 0.6)
}

/// Steps stop blocks and mouths do not, with corner springs and without.
#[test]
fn steps_hold_and_mouths_do_not() {
    for (corner, hardens) in [(0.25, f64::INFINITY), (0.25, 1.5e-3), (0.0, 1.5e-3)] {
        let way = |mouth: f64, step: f64| {
            let [way, rigid, _] = over_a_step(mouth, step, hardens, Rule { corner, ..usual() });
            println!("corner {corner}, hardens {hardens}, mouth {mouth}, step {step}: {way:.4} m of {rigid:.4} m");
            way / rigid
        };
        let passes = |share: f64| (share - 1.0).abs() < 0.02;
        for (mouth, step) in [(0.0, 0.0), (0.0, 2e-4), (0.0, -5e-3), (2e-3, 0.0), (0.05, 0.0)] {
            assert!(passes(way(mouth, step)), "mouth {mouth}, step {step}");
        }
        let least = if corner > 0.0 { 1e-3 } else { 5e-3 };
        for (mouth, step) in [(0.0, 1e-3), (0.0, 2e-3), (0.0, 5e-3), (0.0, 0.02), (2e-3, 5e-3)] {
            if step >= least {
                assert!(way(mouth, step) * 0.3263 < 0.055, "mouth {mouth}, step {step}");
            }
        }
    }
}

/// A corner that is pressed with 2 MN/m over a closed mouth, without friction, is not pushed along: the greatest force
/// along the floor over the load, and the greatest depth (m).
fn along_a_mouth(half: f64, tilt: f64, gap: f64, corner: f64) -> [f64; 2] {
    let (load, stiffness) = (2e6, 3.6e9);
    let mut world = World::new(stiffness, 0.0, 1e-5, 0.0);
    world.rule = Rule { reach: 0.2, beside: 0.2, corner, ..Rule::default() };
    world.add(&rectangle([-5.0, -2.0], [0.0, 0.0]), DENSITY, true);
    world.add(&rectangle([gap, -2.0], [5.0, 0.0]), DENSITY, true);
    let tangent = half.to_radians().tan();
    let shape = points(&[[0.0, 0.0], [tangent, 1.0], [0.0, 2.0], [-tangent, 1.0]]);
    let shape = super::parts::turned_about(&shape, tilt, Vector::default());
    let block = world.add(&shape, DENSITY, false);
    let start = world.rigid[block].centre;
    let (mut along, mut deepest) = (0.0f64, 0.0f64);
    for k in -100..=100 {
        let (mut low, mut high) = (0.0, 0.2);
        let mut force = Vector::default();
        for _ in 0..40 {
            let depth = 0.5 * (low + high);
            world.rigid[block].centre = start + Vector::new(f64::from(k) * 6e-4, -depth);
            world.find(0.0);
            force = world.contacts.rows.iter().fold(Vector::default(), |sum, row| {
                let sign = if row.key.viewer == block { 1.0 } else { -1.0 };
                sum + row.normal * (sign * stiffness * row.weight * row.closure)
            });
            if force.y > load { high = depth } else { low = depth }
        }
        (along, deepest) = (along.max(force.x.abs() / load), deepest.max(low));
    }
    [along, deepest]
}

/// Corners of 60°, 90° and 120°, upright and tilted by 15°, over closed mouths and mouths of 0.2 mm.
#[test]
fn loaded_corners_are_not_pushed_along_by_closed_mouths() {
    for corner in [0.0, 0.25] {
        let mut deepest = [f64::INFINITY, 0.0];
        for (half, tilt) in [(30.0, 0.0), (45.0, 0.0), (60.0, 0.0), (30.0, 15.0), (45.0, 15.0), (60.0, 15.0)] {
            for gap in [0.0, 2e-4] {
                let [along, depth] = along_a_mouth(half, tilt, gap, corner);
                println!(
                    "corner of {}° tilted by {tilt}°, spring {corner}, mouth {gap:.0e}: {along:.4}, {:.2} mm",
                    2.0 * half,
                    depth * 1e3
                );
                deepest = [deepest[0].min(depth), deepest[1].max(depth)];
                assert!(along < if tilt > 0.0 && half > 50.0 && corner > 0.0 { 0.1 } else { 0.01 }, "{along}");
            }
        }
        println!("spring {corner}: depths {:.2} to {:.2} mm", deepest[0] * 1e3, deepest[1] * 1e3);
    }
}
