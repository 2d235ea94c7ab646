//! C3: two equal blocks on an incline, the upper pushing the lower.

use enmm::geometry::{Point, Vector};
use enmm::model::tables::{BlockId, VertexEdge};
use enmm::model::{Simulation, StepReport};

use crate::parts::turn;
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Tolerance, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "C3",
    title: "Two blocks on an incline, one pushing the other",
    source: "Newton and Coulomb per unit mass: 2a = 2g·sin a − g·cos a·(tan φ1 + tan φ2), push = a − g·(sin a − \
             cos a·tan φ1), both while the upper block is the faster one alone; catches wrong friction by joint and \
             wrong forces between moving blocks",
    parameters: &[
        Parameter::new("a_deg", "°", 30.0, [5.0, 45.0], "dip of the plane"),
        Parameter::new("phi_lower_deg", "°", 40.0, [0.0, 60.0], "friction, lower block"),
        Parameter::new("phi_upper_deg", "°", 10.0, [0.0, 60.0], "friction, upper block"),
        Parameter::new("length", "m", 1.6, [1.2, 10.0], "length of a block, 1 m high"),
        Parameter::new("young", "Pa", 50e9, [1e9, 1e12], "Young's modulus"),
        Parameter::new("mesh", "m", 0.6, [0.1, 1.0], "mesh size"),
        Parameter::new("t", "s", 0.45, [0.2, 0.6], "time of sliding"),
    ],
    quick: true,
    implicit: true,
    run,
};

const G: f64 = 9.81;
const DENSITY: f64 = 2500.0;
/// Height (m) of the step on which the lower block stands, so that each block keeps a plane of its own.
const STEP: f64 = 0.2;

/// Accelerations of lower and upper block (m/s²), and the push between them per unit mass where it is determinate.
fn exact(slope: f64, lower: f64, upper: f64) -> ([f64; 2], Option<f64>) {
    let alone = |friction: f64| G * (slope.sin() - slope.cos() * friction.tan());
    let [a, b] = [alone(lower), alone(upper)];
    if a >= b {
        return ([a.max(0.0), b.max(0.0)], Some(0.0));
    }
    let common = 0.5 * (a + b);
    if common > 0.0 { ([common; 2], Some(common - a)) } else { ([0.0; 2], None) }
}

/// Two blocks, the lower one on a step; the face between them is smooth. Both settle under more friction than the
/// slope.
fn case(setup: &Setup) -> String {
    let [slope, length] = ["a_deg", "length"].map(|name| setup.get(name));
    let end = 2.0 * length + 0.5 * G * setup.get("t").powi(2) + 1.0;
    let base = [[-1.0, -1.2], [end, -1.2], [end, -STEP]];
    let lower = [[2.0 * length, -STEP], [2.0 * length, 1.0 - STEP], [length, 1.0 - STEP]];
    let upper = [[length, 1.0], [0.0, 1.0], [0.0, 0.0], [-1.0, 0.0]];
    let outline = [&base[..], &lower, &upper].concat();
    let joint = |a: [f64; 2], b: [f64; 2], law: &str| {
        format!("[[joint]]\npoints = {:?}\nlaw = \"{law}\"\n", turn(&[a, b], -slope))
    };
    let law = |name: &str, friction: f64| format!("[joint_law.{name}]\nfriction_deg = {friction:?}\n");
    let change =
        |law: &str, name: &str| format!("[[stage.law]]\nlaw = \"{law}\"\nfriction_deg = {:?}\n", setup.get(name));
    let hold = slope + 20.0;
    [
        format!("title = \"Two blocks on an incline\"\n[domain]\noutline = {:?}\n", turn(&outline, -slope)),
        format!("joint_law = \"face\"\n[mesh]\nsize = {:?}\norigin = [0.031, 0.017]\n", setup.get("mesh")),
        joint([0.0, 0.0], [length, 0.0], "upper"),
        joint([length, -STEP], [2.0 * length, -STEP], "lower"),
        joint([length, -STEP], [length, 0.0], "face"),
        joint([length, 0.0], [length, 1.0 - STEP], "face"),
        law("face", 0.0) + &law("lower", hold) + &law("upper", hold),
        format!("[rock.rock]\ndensity = {DENSITY:?}\nyoung = {:e}\npoisson = 0.25\n", setup.get("young")),
        format!("[[fix]]\nblock = {:?}\n", turn(&[[-0.5, -0.6]], -slope)[0]),
        "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 5.0\nconvergence = 1e-6\n".into(),
        format!("[[stage]]\nname = \"slide\"\nkind = \"dynamic\"\nduration = {:?}\ndamping = 0.1\n", setup.get("t")),
        change("lower", "phi_lower_deg"),
        change("upper", "phi_upper_deg"),
    ]
    .concat()
}

/// Record of a run: places of both blocks at three times, their distance (s), mean push and curves.
struct Slide {
    places: Vec<[f64; 2]>,
    span: f64,
    push: f64,
    curves: [Vec<[f64; 2]>; 2],
    report: StepReport,
}

fn slide(setup: &Setup, simulation: &mut Simulation) -> Result<Slide, Trouble> {
    simulation.run_stage()?;
    simulation.next_stage()?;
    let (slope, length) = (setup.get("a_deg"), setup.get("length"));
    let middles = turn(&[[1.5 * length, 0.5 - STEP], [0.5 * length, 0.5]], -slope);
    let (s, c) = slope.to_radians().sin_cos();
    let covers = &simulation.model().covers;
    let block = |p: [f64; 2]| covers.element_near(Point::from(p), 0.1).map(|e| covers.element_block[e]);
    let blocks: Vec<BlockId> = middles.iter().filter_map(|p| block(*p)).collect();
    let along = |simulation: &Simulation, k: usize| {
        let motion = simulation.rigid_motion_of(blocks[k]);
        motion.0.dot(&Vector::new(c, -s))
    };
    let start = [0, 1].map(|k| along(simulation, k));
    let begin = simulation.time();
    let steps = simulation.steps_in(setup.get("t") / 3.0);
    let every = (steps / 30).max(1);
    let (mut places, mut pushes, mut report) = (Vec::new(), Vec::new(), StepReport::default());
    let mut curves = [Vec::new(), Vec::new()];
    for window in 0..3 {
        for step in 1..=steps {
            let judged = step % every == 0 || step == steps;
            let found = simulation.advance(judged)?;
            if !judged {
                continue;
            }
            report = found;
            let boundary = &simulation.model().boundary;
            let between = |c: &&VertexEdge| c.blocks(boundary).iter().all(|b| blocks.contains(b));
            let push: f64 =
                simulation.workspace().contacts.iter().filter(between).map(|c| c.history.normal_force).sum();
            if window > 0 {
                pushes.push(push / (DENSITY * length));
            }
            let time = simulation.time() - begin;
            (0..2).for_each(|k| curves[k].push([time, along(simulation, k) - start[k]]));
        }
        places.push([along(simulation, 0), along(simulation, 1)]);
    }
    let push = pushes.iter().sum::<f64>() / pushes.len().max(1) as f64;
    Ok(Slide { places, span: steps as f64 * simulation.model().dt, push, curves, report })
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [slope, lower, upper] = ["a_deg", "phi_lower_deg", "phi_upper_deg"].map(|n| setup.get(n).to_radians());
    let (accelerations, push) = exact(slope, lower, upper);
    let text = case(setup);
    let mut simulation = setup.simulation("c3", text)?;
    let slide = slide(setup, &mut simulation)?;
    let mut rows = Vec::new();
    for (k, name) in ["lower", "upper"].into_iter().enumerate() {
        let [a, b, c] = [0, 1, 2].map(|i| slide.places[i][k]);
        let found = (c - 2.0 * b + a) / (slide.span * slide.span);
        let tolerance = if accelerations[k] > 0.0 { Tolerance::Relative(1e-4) } else { Tolerance::AtMost(1e-4) };
        let reason =
            "second difference of three places, free of the elastic start; the blocks turn a little on the step";
        let row = Row::new(format!("acceleration, {name} block"), "m/s²", found, accelerations[k]);
        rows.push(row.within(tolerance, reason));
    }
    if let Some(push) = push {
        let tolerance = if push > 0.0 { Tolerance::Relative(1e-3) } else { Tolerance::AtMost(1e-2) };
        let reason = "mean over two thirds of the time of a force that swings with waves in the blocks";
        let row = Row::new("push between the blocks per unit mass", "m/s²", slide.push, push);
        rows.push(row.within(tolerance, reason));
    }
    rows.push(Row::ledger(&slide.report));
    let [low, high] = slide.curves;
    let exact: Vec<[f64; 2]> = low.iter().map(|p| [p[0], 0.5 * accelerations[0] * p[0] * p[0]]).collect();
    let plot = Plot::new("Way down the plane", ["time (s)", "way (m)"])
        .line("½·a·t², lower", exact)
        .marks("lower block", low)
        .marks("upper block", high);
    Ok(Outcome { rows, plots: vec![plot] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_numbers_come_from_the_formula() {
        for (lower, upper, acceleration, force) in [(40.0, 10.0, 0.591615, 2.815362), (30.0, 10.0, 1.703489, 1.703489)]
        {
            let [a, l, u] = [30.0, lower, upper].map(f64::to_radians);
            let (accelerations, push) = exact(a, l, u);
            assert!((accelerations[0] - acceleration).abs() < 1e-6 && accelerations[0] == accelerations[1]);
            assert!((push.expect("a push") - force).abs() < 1e-6);
        }
        let [a, l, u] = [30.0f64, 10.0, 20.0].map(f64::to_radians);
        let (accelerations, push) = exact(a, l, u);
        assert!(accelerations[0] > accelerations[1] && push == Some(0.0));
    }
}
