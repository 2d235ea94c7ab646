//! Claim: where joints cross, blocks are held by nothing but strength: they slide over level tops as the closed form
//! says, and a step catches them.

use crate::common::extent::by_extent;
use crate::common::parts::rock;
use crate::common::{run_stage, simulation, varied_rules};
use enmm::model::Simulation;
use enmm::model::tables::DetectionRule;

/// Gravity on a plane of 30° in axes along it (m/s²).
const ALONG: f64 = 4.905;
const ACROSS: f64 = 8.495709211125344;
const SIZE: f64 = 0.5;

/// A body on a base with a top at y = 0, in axes along a plane of 30°.
struct Plane {
    outline: String,
    /// Joints, each a list of points.
    joints: Vec<[[f64; 2]; 2]>,
    /// A point of each body that slides, and its area (m²).
    bodies: Vec<([f64; 2], f64)>,
    size: f64,
    young: f64,
    friction_deg: f64,
    seconds: f64,
    rule: DetectionRule,
}

impl Plane {
    /// No body yet, on stiff rock of a friction below the slope.
    fn bare() -> Self {
        let (outline, joints, bodies) = (String::new(), Vec::new(), Vec::new());
        let rule = DetectionRule::default();
        Self { outline, joints, bodies, size: SIZE, young: 10e9, friction_deg: 20.0, seconds: 0.6, rule }
    }

    /// A block 1 m high from `left` to `right` on a base of the given outline, and upright joints below `cuts`.
    fn block(base: &str, [left, right]: [f64; 2], cuts: &[f64]) -> Self {
        let mut joints = vec![[[left, 0.0], [right, 0.0]]];
        joints.extend(cuts.iter().map(|&x| [[x, 0.0], [x, -1.0]]));
        Self {
            outline: format!("{base}, [{right}, 0], [{right}, 1], [{left}, 1], [{left}, 0], [0, 0]]"),
            joints,
            bodies: vec![([0.5 * (left + right) + 0.03, 0.52], right - left)],
            ..Self::bare()
        }
    }

    /// Two blocks side by side, parted by a joint that goes on through the base, at an angle to the plane.
    fn crossing(angle_deg: f64, friction_deg: f64, size: f64) -> Self {
        let shift = 1.0 / angle_deg.to_radians().tan();
        Self {
            outline: "[[-1, -1.5], [5, -1.5], [5, 0], [2, 0], [2, 1], [0, 1], [0, 0], [-1, 0]]".into(),
            joints: vec![[[0.0, 0.0], [2.0, 0.0]], [[1.0 + shift, 1.0], [1.0 - 1.5 * shift, -1.5]]],
            bodies: vec![
                ([0.5 + 0.25 * shift, 0.45], 1.0 + 0.5 * shift),
                ([1.5 + 0.25 * shift, 0.45], 1.0 - 0.5 * shift),
            ],
            size,
            friction_deg,
            seconds: 0.5,
            ..Self::bare()
        }
    }

    /// Slide of each body, and what the closed form says for a body that nothing catches (m).
    fn slide(&self) -> (Vec<f64>, f64) {
        let mut simulation = self.at_rest();
        assert!(simulation.next_stage().expect("a stage"));
        let place = |s: &Simulation| -> Vec<f64> { (0..self.bodies.len()).map(|k| s.monitor(k).0.x).collect() };
        let (before, start) = (place(&simulation), simulation.time());
        run_stage(&mut simulation);
        let time = simulation.time() - start;
        let slides = place(&simulation).iter().zip(&before).map(|(after, before)| after - before).collect();
        (slides, 0.5 * (ALONG - ACROSS * self.friction_deg.to_radians().tan()) * time * time)
    }

    fn at_rest(&self) -> Simulation {
        let joints: String = self.joints.iter().map(|j| format!("[[joint]]\npoints = {j:?}\n")).collect();
        let monitor = |(k, (p, _)): (usize, &([f64; 2], f64))| format!("[[monitor]]\nname = \"m{k}\"\npoint = {p:?}\n");
        let monitors: String = self.bodies.iter().enumerate().map(monitor).collect();
        let floor = if self.outline.contains("-1.5") { "[[-1, -1.5], [5, -1.5]]" } else { "[[0, -1], [6, -1]]" };
        let mut simulation = simulation(&format!(
            "title = \"plane\"\n[domain]\noutline = {}\n[mesh]\nsize = {}\norigin = [0.031, 0.017]\n[gravity]\n\
             x = {ALONG}\ny = {}\n{joints}[joint_law.joint]\nfriction_deg = 45.0\n[[fix]]\n\
             edge = {}\n{monitors}{}[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 5.0\n\
             convergence = 1e-5\n[[stage]]\nname = \"slide\"\nkind = \"dynamic\"\nduration = {}\ndamping = 0.0\n\
             [[stage.law]]\nlaw = \"joint\"\nfriction_deg = {}\n",
            self.outline,
            self.size,
            -ACROSS,
            floor,
            rock(self.young, 2650.0),
            self.seconds,
            self.friction_deg,
        ))
        .with_detection(self.rule);
        let report = run_stage(&mut simulation);
        assert!(simulation.at_rest(&report), "{report:?}");
        simulation
    }
}

/// A base from x = 0 to 6 whose top goes up by `step` (m) behind a mouth of some width (m) at x = 2.5.
fn stepped(width: f64, step: f64) -> Plane {
    let far = 2.5 + width;
    let mouth = match width {
        0.0 => format!("[[0, -1], [6, -1], [6, {step}], [2.55, {step}], [2.55, 0]"),
        _ => format!(
            "[[0, -1], [6, -1], [6, {step}], [{}, {step}], [{}, -0.6], [2.55, -0.6], [2.55, 0]",
            far + 0.05,
            far + 0.05
        ),
    };
    Plane::block(&mouth, [0.5, 2.5], &[])
}

/// Joints of any angle, friction and mesh: both blocks slide as a whole as the closed form says, within 0.5 %. They
/// push each other apart as they are freed of their elastic strain, by a share of the way that grows as
/// the drive falls.
#[test]
fn blocks_slide_over_a_crossing_at_any_angle() {
    for angle in [45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0] {
        for (friction, size) in [(5.0, 0.25), (15.0, 0.5), (20.0, 0.5), (20.0, 1.0)] {
            let plane = Plane::crossing(angle, friction, size);
            let (slides, exact) = plane.slide();
            let mean = slides.iter().zip(&plane.bodies).map(|(slide, (_, area))| slide * area).sum::<f64>() / 2.0;
            println!("{angle}° {friction}° h {size}: {slides:?} of {exact}");
            assert!((mean / exact - 1.0).abs() < 5e-3, "{angle}°, {friction}°, h {size}: {slides:?} of {exact}");
            assert!(slides.iter().all(|s| (s / exact - 1.0).abs() < 0.02), "{angle}°: {slides:?} of {exact}");
        }
    }
}

/// Level tops of blocks below, wide and narrow, and of rock that yields by a step of 1e-3 of the mesh size under load.
#[test]
fn a_block_slides_over_level_tops() {
    let base = "[[0, -1], [6, -1], [6, 0]";
    let mut rows = vec![(Plane::block(base, [0.5, 1.5], &[1.4, 1.9, 2.4, 2.9]), 5e-3)];
    rows.push((Plane::block(base, [0.5, 1.5], &[1.4, 1.61, 1.82, 2.03, 2.24]), 5e-3));
    rows.push((Plane { young: 0.2e9, ..Plane::crossing(90.0, 20.0, SIZE) }, 0.05));
    for (plane, tolerance) in rows {
        let (slides, exact) = plane.slide();
        println!("{slides:?} of {exact}");
        assert!(slides.iter().all(|s| (s / exact - 1.0).abs() < tolerance), "{slides:?} of {exact}");
    }
}

/// The height from which a ledge catches is 1e-3 of the mesh size: half of that lets a block pass, twice that holds it
/// within 1e-3 m of the ledge, as does any higher step; a step down and an open mouth with level lips hold nothing.
#[test]
fn a_step_catches_and_a_ledge_does_not() {
    for (width, step, holds) in [
        (0.0, 0.5e-3 * SIZE, false),
        (0.0, 2e-3 * SIZE, true),
        (0.0, 1e-2 * SIZE, true),
        (0.0, -1e-2 * SIZE, false),
        (0.002, 0.0, false),
        (0.05, 0.0, false),
        (0.002, 1e-2 * SIZE, true),
    ] {
        let (slides, free) = stepped(width, step).slide();
        let exact = if holds { 0.05 + width } else { free };
        println!("mouth {width} step {step}: {slides:?} of {exact}");
        let tolerance = if holds { 1e-3 } else { 5e-3 * free };
        assert!((slides[0] - exact).abs() < tolerance, "mouth {width}, step {step}: {slides:?} of {exact}");
    }
}

/// The base of one block, cut by one more joint than another's, is never stronger.
#[test]
fn a_joint_more_never_bears_more() {
    let (whole, _) = Plane::block("[[0, -1], [6, -1], [6, 0]", [0.5, 1.5], &[]).slide();
    for cut in [1.45, 1.5, 1.55, 1.6] {
        let (slides, _) = Plane::block("[[0, -1], [6, -1], [6, 0]", [0.5, 1.5], &[cut]).slide();
        assert!(slides[0] > 0.99 * whole[0], "a joint at {cut}: {slides:?} of {whole:?}");
    }
}

/// Half or twice any constant of contact: blocks slide over crossings and level tops, and steps hold them.
#[test]
fn long_no_constant_decides_what_holds() {
    let base = "[[0, -1], [6, -1], [6, 0]";
    for (name, rule) in varied_rules().into_iter().step_by(by_extent([7, 3, 1])) {
        let angles = by_extent([&[135.0][..], &[60.0, 90.0, 135.0], &[60.0, 90.0, 135.0]]);
        let mut planes: Vec<Plane> = angles.iter().map(|&angle| Plane::crossing(angle, 20.0, SIZE)).collect();
        planes.push(Plane::block(base, [0.5, 1.5], &[1.4, 1.61, 1.82, 2.03, 2.24]));
        planes.push(stepped(0.002, 0.0));
        for plane in planes {
            let (slides, exact) = Plane { rule, ..plane }.slide();
            println!("{name}: {slides:?} of {exact}");
            assert!(slides.iter().all(|slide| (slide / exact - 1.0).abs() < 0.02), "{name}: {slides:?} of {exact}");
        }
        let (slides, _) = Plane { rule, ..stepped(0.002, 1e-2 * SIZE) }.slide();
        assert!((slides[0] - 0.052).abs() < 1e-3, "{name}: {slides:?} of 0.052");
    }
}
