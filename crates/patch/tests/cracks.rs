//! A corner that slides under many times its weight over the closed mouth of a crack does not sink into it.

use enmm_patch::{Hardening, Rule, Vector};

use super::parts::{is_long, points, rectangle, turned_about};
use super::rigid::World;

/// A square of 2 m on a corner at 10 m/s over a floor, with or without a crack: the lowest place of its corner (m) and
/// its speed after 60 ms.
fn slide(gravity: f64, crack: Option<(f64, f64)>, corner: f64) -> [f64; 2] {
    let mut world = World::new(3.6e9, 5f64.to_radians().tan(), 2e-4, 4.0);
    world.gravity = Vector::new(0.0, -gravity);
    world.rule = Rule { reach: 0.2, beside: 0.2, ledge: 1e-3, corner, ..Rule::default() };
    world.hardening = Hardening { depth: 0.003 };
    if let Some((dip, mouth)) = crack {
        let foot = mouth - 4.0 / dip.to_radians().tan();
        world.add(&points(&[[-18.0, -4.0], [foot, -4.0], [mouth, 0.0], [-18.0, 0.0]]), 2650.0, true);
        world.add(&points(&[[foot, -4.0], [16.0, -4.0], [16.0, 0.0], [mouth, 0.0]]), 2650.0, true);
    } else {
        world.add(&rectangle([-18.0, -4.0], [16.0, 0.0]), 2650.0, true);
    }
    let half = 2f64.sqrt();
    let square = points(&[[0.0, 0.001], [half, half + 0.001], [0.0, 2.0 * half + 0.001], [-half, half + 0.001]]);
    let block = world.add(&square, 2650.0, false);
    world.rigid[block].velocity.x = -10.0;
    let mut lowest = f64::INFINITY;
    for _ in 0..300 {
        world.step();
        lowest = world.outline(block).iter().map(|point| point.y).fold(lowest, f64::min);
    }
    [lowest, world.rigid[block].velocity.x]
}

/// Force on a corner that lies 20 mm deep in a floor with a closed crack, over the force without one: along the
/// floor, across it, and the energy.
fn pressed(dip: f64, way: f64, corner: f64) -> [f64; 3] {
    let half = 2f64.sqrt();
    let square =
        points(&[[way, -0.02], [way + half, half - 0.02], [way, 2.0 * half - 0.02], [way - half, half - 0.02]]);
    let foot = -4.0 / dip.to_radians().tan();
    let [left, right] = [
        points(&[[-18.0, -4.0], [foot, -4.0], [0.0, 0.0], [-18.0, 0.0]]),
        points(&[[foot, -4.0], [16.0, -4.0], [16.0, 0.0], [0.0, 0.0]]),
    ];
    let [whole, cracked] = [vec![rectangle([-18.0, -4.0], [16.0, 0.0])], vec![left, right]].map(|floor| {
        let mut world = World::new(1.0, 0.0, 1e-4, 0.0);
        world.rule = Rule { reach: 0.2, beside: 0.2, corner, ..Rule::default() };
        world.hardening = Hardening { depth: 0.003 };
        for block in floor {
            world.add(&block, 2650.0, true);
        }
        let block = world.add(&square, 2650.0, false);
        world.find(0.0);
        let force = world.contacts.rows.iter().fold(Vector::default(), |sum, row| {
            let sign = if row.key.viewer == block { 1.0 } else { -1.0 };
            sum + row.normal * (sign * row.weight * row.closure)
        });
        (force, world.contacts.energy)
    });
    [cracked.0.x / whole.0.y, cracked.0.y / whole.0.y, cracked.1 / whole.1]
}

/// A corner over a closed crack lies on the floor as if there were none, at any dip and on both sides of the mouth:
/// force and energy to round-off, with corner springs and without.
#[test]
fn a_closed_crack_changes_nothing() {
    for corner in [0.0, 0.25, 0.5] {
        for dip in [20.0, 36.0, 60.0, 90.0, 120.0, 150.0] {
            for way in [-0.06, -0.02, -0.015, -0.01, -0.001, 0.001, 0.01, 0.015, 0.02, 0.03, 0.06] {
                let [along, across, energy] = pressed(dip, way, corner);
                assert!(along.abs() < 1e-12, "{corner} {dip} {way}: {along:e} along the floor");
                assert!((across - 1.0).abs() < 1e-12, "{corner} {dip} {way}: {across}");
                assert!((energy - 1.0).abs() < 1e-12, "{corner} {dip} {way}: {energy}");
            }
        }
    }
}

/// 108 cracks: three loads, six dips and six places; a third of them in the short form.
#[test]
fn long_corners_do_not_sink_into_cracks() {
    for corner in [0.0, 0.5] {
        let (mut count, mut deepest, mut slowest) = (0, 0.0f64, 0.0f64);
        for (k, gravity) in [200.0, 500.0, 2000.0].into_iter().enumerate() {
            let [low, speed] = slide(gravity, None, corner);
            for (j, dip) in [20.0, 36.0, 60.0, 90.0, 120.0, 150.0].into_iter().enumerate() {
                for (i, mouth) in [-0.05, -0.08, -0.1, -0.15, -0.2, -0.3].into_iter().enumerate() {
                    if !is_long() && (i + j + k) % 3 != 0 {
                        continue;
                    }
                    let [cracked, after] = slide(gravity, Some((dip, mouth)), corner);
                    (count, deepest) = (count + 1, deepest.max(low - cracked));
                    slowest = slowest.max((after / speed - 1.0).abs());
                }
            }
        }
        println!("{count} cracks, corner {corner}: deeper by {:.2} mm, slower by {slowest:.1e}", deepest * 1e3);
        assert!(deepest < 2e-3 && slowest < 0.03);
    }
}

/// A tilted square that slides over a closed mouth without friction keeps its speed along the floor.
#[test]
fn a_tilted_square_passes_a_mouth() {
    let mut worst = 0.0f64;
    for lean in [0.0, -0.5, 0.667] {
        for speed in [4.0, 6.0, 12.0] {
            let mut world = World::new(7.2e9, 0.0, 1e-4, 4.0);
            world.hardening = Hardening { depth: 0.003 };
            world.add(&points(&[[0.0, -1.0], [4.0 + lean, -1.0], [4.0, 0.0], [0.0, 0.0]]), 2650.0, true);
            world.add(&points(&[[4.0 + lean, -1.0], [12.0, -1.0], [12.0, 0.0], [4.0, 0.0]]), 2650.0, true);
            let square = turned_about(&rectangle([3.0, 0.001], [4.0, 1.001]), 20.0, Vector::new(3.0, 0.001));
            let block = world.add(&square, 2650.0, false);
            world.rigid[block].velocity = Vector::new(speed, -1.0);
            world.run(0.3);
            worst = worst.max((world.rigid[block].velocity.x / speed - 1.0).abs());
        }
    }
    println!("tilted square over a mouth: speed changes by {worst:.1e}");
    assert!(worst < 1e-3, "{worst:e}");
}
