//! Blocks that slide, with friction that follows the pressure of the last milliseconds (Eq. 84): at every mesh, step
//! and base they go as far as rigid ones.

use enmm::geometry::Vector;

use crate::common::extent::by_extent;
use crate::common::parts::{dynamic, rock};
use crate::common::{simulation, step};

const SLOPE: f64 = 35.0;
const FRICTION: f64 = 40.0;
const GRAVITY: f64 = 9.81;

/// Rock below the block, by what becomes of its waves.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Base {
    Rigid,
    Quiet,
    FixedEdges,
}

/// Beds of blocks on a plane at 35°, drawn with the plane along x, which come to rest before they are let go.
#[derive(Debug, Clone, Copy)]
struct Stack {
    columns: u32,
    rows: u32,
    width: f64,
    height: f64,
    base: Base,
    mesh: f64,
    dt_max: f64,
    delay: Option<f64>,
}

const BLOCK: Stack =
    Stack { columns: 1, rows: 1, width: 12.0, height: 6.0, base: Base::Rigid, mesh: 3.0, dt_max: 1e-2, delay: None };

impl Stack {
    fn case(&self) -> String {
        let Self { columns, rows, width, height, base, mesh, dt_max, delay } = *self;
        let slope = SLOPE.to_radians();
        let (along, down) = (GRAVITY * slope.sin(), -GRAVITY * slope.cos());
        let depth = if base == Base::Rigid { 4.0 } else { 12.0 };
        let (left, right) = (12.0, 12.0 + f64::from(columns) * width);
        let (end, top) = (right + 12.0 + width, depth + f64::from(rows) * height);
        let mut joints = String::new();
        for row in 0..rows {
            let y = depth + f64::from(row) * height;
            joints += &format!("[[joint]]\npoints = [[{left}, {y}], [{right}, {y}]]\n");
        }
        for column in 1..columns {
            let x = left + f64::from(column) * width;
            joints += &format!("[[joint]]\npoints = [[{x}, {depth}], [{x}, {top}]]\n");
        }
        let edges = [[0.0, 0.0, end, 0.0], [0.0, 0.0, 0.0, depth], [end, 0.0, end, depth]];
        let edge = |kind: &str, [a, b, c, d]: [f64; 4]| format!("[[{kind}]]\nedge = [[{a}, {b}], [{c}, {d}]]\n");
        let below = match base {
            Base::Rigid => "[[fix]]\nblock = [1.0, 1.0]\n".to_owned(),
            Base::Quiet => edges.map(|e| edge("quiet", e)).concat(),
            Base::FixedEdges => edges.map(|e| edge("fix", e)).concat(),
        };
        let delay = delay.map_or(String::new(), |delay| format!("friction_delay = {delay:e}\n"));
        format!(
            "title = \"slide\"\n[gravity]\nx = {along}\ny = {down}\n[domain]\njoint_law = \"plane\"\n\
             outline = [[0, 0], [{end}, 0], [{end}, {depth}], [{right}, {depth}], [{right}, {top}], [{left}, {top}], \
             [{left}, {depth}], [0, {depth}]]\n[mesh]\nsize = {mesh}\nangle_deg = 7.0\norigin = [0.13, 0.29]\n\
             {joints}[joint_law.plane]\nfriction_deg = {FRICTION}\n{below}[solver]\ndt_max = {dt_max:e}\n\
             {delay}[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-6\n{}{}",
            rock(5e9, 2600.0),
            dynamic("slide", 100.0, 0.05)
        )
    }

    /// Distances (m) that the blocks slide from 1 m/s until they rest, over what Coulomb friction makes of rigid ones:
    /// v²/2a with the deceleration a = g(cos ψ·tan φ − sin ψ).
    fn ratios(&self) -> Vec<f64> {
        let mut simulation = simulation(&self.case());
        simulation.run_stage().unwrap_or_else(|e| panic!("{e}"));
        simulation.next_stage().unwrap_or_else(|e| panic!("{e}"));
        let base = simulation.block_states().iter().position(|block| block.area > 100.0).unwrap_or(0);
        let start = simulation.block_states();
        let first = &simulation.model().covers.block_ranges.covers;
        let mut state = simulation.state().clone();
        for block in (0..start.len()).filter(|&block| block != base) {
            let covers = first[block] as usize..first[block + 1] as usize;
            state.velocity[covers].iter_mut().for_each(|v| v.x += 1.0);
        }
        simulation.restore(state);
        let steps = simulation.steps_in(1.5);
        step(&mut simulation, steps);
        let [slope, friction] = [SLOPE, FRICTION].map(f64::to_radians);
        let exact = 0.5 / (GRAVITY * (slope.cos() * friction.tan() - slope.sin()));
        let end = simulation.block_states();
        let pairs = start.iter().zip(&end).enumerate().filter(|(block, _)| *block != base);
        pairs.map(|(_, (start, end))| (end.displacement.x - start.displacement.x) / exact).collect()
    }
}

/// Ratios of both ends of the range that a stack may have.
fn assert_near(stack: &Stack, tolerance: f64) {
    for ratio in stack.ratios() {
        assert!((ratio - 1.0).abs() < tolerance, "{stack:?}: {ratio} times the distance of a rigid block");
    }
}

/// The dashpot of contacts once shrank with the step, so that short steps let sliding blocks vibrate: at a quarter of
/// the default step a block slid 21 times as far as Coulomb friction lets it.
#[test]
fn long_a_block_slides_as_far_as_a_rigid_one_on_any_base_mesh_and_step() {
    let meshes = by_extent([vec![3.0, 1.5], vec![3.0, 1.5], vec![3.0, 1.5, 0.75]]);
    for (base, tolerance) in [(Base::Rigid, 0.02), (Base::Quiet, 0.02), (Base::FixedEdges, 0.03)] {
        for &mesh in &meshes {
            assert_near(&Stack { base, mesh, ..BLOCK }, tolerance);
            // A half and a quarter of the default step.
            let shorter: &[f64] = if base == Base::Rigid { &[5e-4, 2.5e-4] } else { &[2.5e-4] };
            for dt_max in shorter.iter().map(|dt| dt * mesh / 3.0) {
                assert_near(&Stack { base, mesh, dt_max, ..BLOCK }, tolerance);
            }
        }
    }
}

#[test]
fn long_beds_of_blocks_slide_as_far_as_rigid_ones() {
    let meshes = by_extent([vec![3.0], vec![3.0], vec![3.0, 1.5, 0.75]]);
    for mesh in meshes {
        let stack = Stack { columns: 6, rows: 2, width: 6.0, height: 2.0, base: Base::Quiet, mesh, ..BLOCK };
        assert_near(&stack, 0.02);
    }
}

/// Coulomb friction at once flutters on a ringing base: the delay is what cures it.
#[test]
fn friction_at_once_lets_blocks_flutter() {
    let at_once = Stack { base: Base::FixedEdges, mesh: 1.5, delay: Some(0.0), ..BLOCK };
    let ratio = at_once.ratios()[0];
    assert!(ratio > 1.2, "it slides {ratio} times as far as a rigid block");
}

/// A block of 12 by 6 m on a joint, and a sine of 2 Hz that shakes it for 5 s from below.
#[derive(Debug, Clone, Copy)]
struct Shaken {
    slope_deg: f64,
    friction_deg: f64,
    dilation_deg: f64,
    /// Stiffness of the joint, in moduli of the rock per mesh size.
    stiffness: f64,
    /// Greatest acceleration (m/s²), and whether the shaking swells and fades.
    peak: f64,
    tapered: bool,
    mesh: f64,
}

const ON_SLOPE: Shaken = Shaken {
    slope_deg: 35.0,
    friction_deg: FRICTION,
    dilation_deg: 0.0,
    stiffness: 0.6,
    peak: 1.5,
    tapered: false,
    mesh: 3.0,
};

/// Slip (m) of the block. The heat of friction must never fall.
fn shaken(setting: Shaken) -> Vector {
    let Shaken { slope_deg, friction_deg, dilation_deg, stiffness, peak, tapered, mesh } = setting;
    let slope = slope_deg.to_radians();
    let (along, down) = (GRAVITY * slope.sin(), -GRAVITY * slope.cos());
    let record: Vec<String> = (0..=1000)
        .map(|k| {
            let t = 5e-3 * f64::from(k);
            let swell = if tapered { (std::f64::consts::PI * t / 5.0).sin().powi(2) } else { 1.0 };
            format!("[{t:?}, {:?}]", swell * peak * (std::f64::consts::TAU * 2.0 * t).sin())
        })
        .collect();
    let case = format!(
        "title = \"shaken\"\n[gravity]\nx = {along}\ny = {down}\n[domain]\n\
         outline = [[0, 0], [40, 0], [40, 4], [22, 4], [22, 10], [10, 10], [10, 4], [0, 4]]\n\
         [mesh]\nsize = {mesh}\nangle_deg = 7.0\norigin = [0.13, 0.29]\n[solver]\ncontact_stiffness = {stiffness}\n\
         [[joint]]\npoints = [[10, 4], [22, 4]]\n[joint_law.plane]\nfriction_deg = {friction_deg}\n\
         dilation_deg = {dilation_deg}\n[[fix]]\nblock = [1.0, 1.0]\n\
         [[base_motion]]\nkind = \"acceleration\"\naxis = \"x\"\nstage = \"shake\"\ntable = [{}]\n\
         [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20.0\nconvergence = 1e-6\n\
         [[stage]]\nname = \"shake\"\nkind = \"dynamic\"\nduration = 7.0\n{}",
        record.join(", "),
        rock(5e9, 2600.0)
    );
    let mut simulation = simulation(&case);
    simulation.run_stage().unwrap_or_else(|e| panic!("{e}"));
    simulation.next_stage().unwrap_or_else(|e| panic!("{e}"));
    let block = simulation.block_states().iter().position(|block| !block.fixed).expect("a free block");
    let start = simulation.block_states()[block].displacement;
    let mut heat = simulation.state().ledger.friction;
    for _ in 0..simulation.steps_in(7.0) {
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        let now = simulation.state().ledger.friction;
        assert!(now >= heat, "friction made {} J/m in a step", heat - now);
        heat = now;
    }
    simulation.block_states()[block].displacement - start
}

/// Way (m) of a rigid block by Newmark's method (1965).
fn newmark(slope_deg: f64, friction_deg: f64, peak: f64) -> f64 {
    let (slope, friction) = (slope_deg.to_radians(), friction_deg.to_radians());
    let (drive, resist) = (GRAVITY * slope.sin(), GRAVITY * slope.cos() * friction.tan());
    let (mut v, mut x, dt) = (0.0f64, 0.0, 1e-5);
    for k in 0..700_000 {
        let t = f64::from(k) * dt;
        let shaking = if t < 5.0 { peak * (std::f64::consts::TAU * 2.0 * t).sin() } else { 0.0 };
        let pull = drive - shaking;
        let acceleration = if v > 0.0 { pull - resist } else { (pull - resist).max(0.0) };
        v = (v + acceleration * dt).max(0.0);
        x += v * dt;
    }
    x
}

#[test]
fn long_a_shaken_block_goes_as_far_as_newmarks() {
    let exact = newmark(35.0, FRICTION, 1.5);
    for mesh in by_extent([vec![3.0], vec![3.0], vec![3.0, 2.0, 1.5, 1.0, 0.75]]) {
        let way = shaken(Shaken { mesh, ..ON_SLOPE }).x;
        println!("mesh {mesh} m: {way} m, Newmark {exact} m");
        let tolerance = if mesh < 1.0 { 0.2 } else { 0.15 };
        assert!((way / exact - 1.0).abs() < tolerance, "mesh {mesh} m: {way} m instead of {exact} m");
    }
}

/// Dilation counted slip to and fro alike, and lifted a block by 67 mm. Lifting stiff joints under little pressure took
/// more work than friction gave.
#[test]
fn a_block_shaken_on_level_ground_comes_down_again() {
    for stiffness in [0.6, 1.8] {
        let level = Shaken { slope_deg: 0.0, friction_deg: 20.0, dilation_deg: 10.0, stiffness, ..ON_SLOPE };
        let moved = shaken(Shaken { peak: 6.0, tapered: true, ..level });
        assert!(moved.y.abs() < 1e-3, "stiffness {stiffness}: it rose by {} m", moved.y);
    }
}
