//! Jointed slopes that settle, fail and run out on a floor: they gain no energy, settle every step and stay shallow.

use enmm_patch::{Hardening, Rule, Vector};

use super::parts::{Random, area_and_centre, cut, is_long, points, rectangle, turned};
use super::rigid::World;

const DENSITY: f64 = 2650.0;

/// Two sets of joints: dips (degrees), spacings (m); friction angle (degrees) at which the slope fails.
#[derive(Debug, Clone, Copy)]
struct Joints {
    dips: [f64; 2],
    spacings: [f64; 2],
    friction: f64,
}

/// A slope of 15 m at 60°, cut by both sets, on a base along the first set that the second one cuts as well.
fn slope(joints: &Joints, dt: f64) -> (World, usize) {
    let mut world = World::new(7.2e9, 50f64.to_radians().tan(), dt, 4.0);
    world.rule = Rule { reach: 0.1, beside: 0.1, ledge: 1e-3, ..Rule::default() };
    world.hardening = Hardening { depth: 0.003 };
    let along = |degrees: f64| turned(Vector::new(1.0, 0.0), degrees);
    let (base, across) = (along(joints.dips[0]).left(), -along(joints.dips[1]).left());
    let face = along(60.0).left();
    let [rise, way] = joints.spacings;
    let everything = rectangle([-60.0, -60.0], [60.0, 60.0]);
    let strip = |shape: &[Vector], normal: Vector, from: f64, to: f64| cut(&cut(shape, -normal, -from), normal, to);
    let column =
        |shape: &[Vector], j: i32| strip(shape, across, f64::from(j) * way + 0.37, f64::from(j + 1) * way + 0.37);
    let mut loose = Vec::new();
    for j in -14..26 {
        for i in 0..14 {
            let shape = column(&strip(&everything, base, f64::from(i) * rise, f64::from(i + 1) * rise), j);
            let shape = cut(&cut(&shape, face, 0.0), Vector::new(0.0, 1.0), 15.0);
            loose.push(cut(&shape, Vector::new(1.0, 0.0), 22.0));
        }
        let held = column(&strip(&everything, base, -3.0, 0.0), j);
        let held = cut(&cut(&held, Vector::new(1.0, 0.0), 30.0), Vector::new(-1.0, 0.0), 12.0);
        if held.len() > 2 && area_and_centre(&held).0 > 1e-6 {
            world.add(&held, DENSITY, true);
        }
    }
    world.add(&rectangle([-40.0, -10.0], [22.0, -9.0]), DENSITY, true);
    world.add(&rectangle([22.0, -9.0], [23.0, 30.0]), DENSITY, true);
    let held = world.rigid.len();
    for shape in loose.iter().filter(|shape| shape.len() > 2 && area_and_centre(shape).0 > 0.05) {
        world.add(shape, DENSITY, false);
    }
    (world, held)
}

/// Settles and fails; fails the test where energy is gained, a step is unsettled or a corner is deep.
fn fail(joints: &Joints, time: f64) {
    let (mut world, held) = slope(joints, 2e-4);
    world.damping = 20.0;
    world.run(if is_long() { 1.6 } else { 0.8 });
    let (rest, rest_deep) = (world.kinetic() / world.mass(), world.contacts.deepest);
    (world.damping, world.friction) = (0.0, joints.friction.to_radians().tan());
    world.stop();
    let start = world.potential();
    let (mut low, mut gained) = (world.energy(), 0.0f64);
    let (mut deepest, mut fastest, sweeps) = (0.0f64, 0.0f64, world.sweeps);
    let steps = (time / world.dt) as usize;
    for _ in 0..steps {
        world.step();
        let energy = world.energy();
        (gained, low) = (gained.max(energy - low), low.min(energy));
        deepest = deepest.max(world.contacts.deepest);
        fastest = world.rigid[held..].iter().map(|body| body.velocity.norm()).fold(fastest, f64::max);
    }
    let released = start - world.potential();
    println!(
        "slope {:.0}°/{:.0}°: {} blocks, at rest {rest:.0e} J/kg and {:.2} mm; fails at {:.0}°: {:.1} MJ, up to \
         {fastest:.1} m/s, deepest {:.1} mm, gained {:.1e}, {} steps unsettled, {:.1} sweeps",
        joints.dips[0],
        joints.dips[1],
        world.rigid.len() - held,
        rest_deep * 1e3,
        joints.friction,
        released / 1e6,
        deepest * 1e3,
        gained / released,
        world.unsettled,
        (world.sweeps - sweeps) as f64 / steps as f64,
    );
    assert!(rest < 1e-8 && released > 1e6);
    assert!(gained < 1e-4 * released, "{:e}", gained / released);
    assert!(world.unsettled == 0 && deepest < 0.02);
}

/// The three slopes of the study and random ones: three of them for half a second, fourteen for two and a half in the
/// long form.
#[test]
fn long_slopes_fail_without_gain() {
    let mut all = vec![
        Joints { dips: [35.0, 110.0], spacings: [1.8, 2.2], friction: 15.0 },
        Joints { dips: [30.0, 100.0], spacings: [1.5, 1.7], friction: 10.0 },
        Joints { dips: [40.0, 130.0], spacings: [2.0, 1.6], friction: 15.0 },
    ];
    let (count, time) = if is_long() { (14, 2.5) } else { (1, 1.0) };
    if !is_long() {
        all.drain(1..);
    }
    let mut random = Random::new(987_654_321);
    for _ in 0..count {
        let dip = random.between(25.0, 45.0);
        all.push(Joints {
            dips: [dip, dip + random.between(55.0, 100.0)],
            spacings: [random.between(1.3, 2.3), random.between(1.3, 2.3)],
            friction: random.between(8.0, 16.0),
        });
    }
    all.iter().for_each(|joints| fail(joints, time));
}

/// A slope has blocks, and none of them overlaps another one at the start: sums of areas.
#[test]
fn slopes_are_cut_without_overlap() {
    let joints = Joints { dips: [35.0, 110.0], spacings: [1.8, 2.2], friction: 15.0 };
    let (world, held) = slope(&joints, 1e-4);
    let blocks: f64 = (held..world.rigid.len()).map(|k| area_and_centre(&world.outline(k)).0).sum();
    let base = turned(Vector::new(1.0, 0.0), 35.0);
    let toe =
        points(&[[0.0, 0.0], [22.0, 22.0 * base.y / base.x], [22.0, 15.0], [15.0 / 60f64.to_radians().tan(), 15.0]]);
    let (whole, _) = area_and_centre(&cut(&toe, Vector::new(0.0, 1.0), 15.0));
    assert!((blocks / whole - 1.0).abs() < 0.01, "{blocks} of {whole}");
}
