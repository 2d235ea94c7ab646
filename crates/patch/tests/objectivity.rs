//! A heap of blocks that is turned, mirrored or renumbered comes to rest alike.

use enmm_patch::Vector;

use super::parts::{points, rectangle, turned, turned_about};
use super::rigid::World;

struct Change {
    degrees: f64,
    is_mirrored: bool,
    order: fn(usize) -> usize,
}

/// Displacements of the blocks, as they are without the change; the number of steps that did not settle.
fn displacements(change: &Change, time: f64) -> (Vec<Vector>, u64) {
    let mut shapes = vec![
        (rectangle([-3.0, -1.0], [1.0, 0.0]), true),
        (rectangle([1.0, -1.0], [4.0, 0.0]), true),
        (rectangle([-4.0, -1.0], [-3.0, 3.0]), true),
    ];
    for block in [
        &[[-2.9, 0.01], [-1.6, 0.01], [-1.5, 0.9], [-2.8, 1.1]][..],
        &[[-1.4, 0.02], [0.2, 0.02], [0.0, 1.0], [-1.3, 0.8]],
        &[[0.5, 0.01], [1.9, 0.01], [1.7, 0.7], [0.6, 0.9]],
        &[[-2.2, 1.3], [-0.6, 1.2], [-0.9, 2.1], [-2.0, 2.2]],
        &[[-0.4, 1.2], [0.9, 1.1], [1.0, 1.9], [0.1, 2.3]],
        &[[-1.3, 2.5], [0.1, 2.5], [-0.6, 3.6]],
    ] {
        shapes.push((points(block), false));
    }
    let mut world = World::new(7.2e9, 0.6, 1e-4, 4.0);
    (world.tolerance, world.sweeps_max, world.damping, world.rule.ledge) = (1e-11, 20_000, 3.0, 5e-4);
    world.gravity = turned(Vector::new(0.0, -9.81), change.degrees);
    let count = shapes.len();
    for k in 0..count {
        let (mut shape, is_held) = shapes[(change.order)(k) % count].clone();
        if change.is_mirrored {
            shape.reverse();
            shape.iter_mut().for_each(|point| point.x = -point.x);
        }
        world.add(&turned_about(&shape, change.degrees, Vector::default()), 2650.0, is_held);
    }
    let starts: Vec<Vector> = world.rigid.iter().map(|body| body.centre).collect();
    world.run(time);
    let mut moved = vec![Vector::default(); count];
    for (k, (body, start)) in world.rigid.iter().zip(starts).enumerate() {
        let way = turned(body.centre - start, -change.degrees);
        moved[(change.order)(k) % count] = Vector::new(if change.is_mirrored { -way.x } else { way.x }, way.y);
    }
    (moved, world.unsettled)
}

/// Sweeps go on until forces change by 1e-11, since their order is not objective. A tenth of a second of fall and the
/// first impacts.
#[test]
fn heaps_do_not_depend_on_axes_or_numbers() {
    let same = Change { degrees: 0.0, is_mirrored: false, order: |k| k };
    let time = 0.35;
    let (base, unsettled) = displacements(&same, time);
    let largest = base.iter().map(|way| way.norm()).fold(0.0, f64::max);
    println!("heap: largest displacement {largest:.3} m, {unsettled} steps unsettled");
    assert!(largest > 0.1);
    for (name, change) in [
        ("turned", Change { degrees: 37.0, ..same }),
        ("mirrored", Change { is_mirrored: true, ..same }),
        ("renumbered", Change { order: |k| 8 - k, ..same }),
        ("shuffled", Change { order: |k| 4 * k + 1, ..same }),
    ] {
        let (other, _) = displacements(&change, time);
        let worst = base.iter().zip(&other).map(|(a, b)| (*a - *b).norm()).fold(0.0, f64::max) / largest;
        println!("   {name}: differs by {worst:.1e}");
        assert!(worst < 1e-9, "{name}: {worst:e}");
    }
}
