//! E2: a masonry wall and a row of stacks at rest.

use enmm::geometry::Vector;
use enmm::model::Simulation;

use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "E2",
    title: "Masonry wall and block stack at rest",
    source: "What stands stays: no drift, no kinetic energy, thin overlaps. Catches creep, false slip, contacts that \
             feed energy, and bodies that sink into each other",
    parameters: &[
        Parameter::new("columns", "", 20.0, [2.0, 30.0], "bricks in a course"),
        Parameter::new("courses", "", 20.0, [2.0, 30.0], "courses"),
        Parameter::new("seconds", "s", 12.0, [1.0, 60.0], "time at rest"),
        Parameter::new("friction_deg", "°", 35.0, [10.0, 60.0], "friction angle"),
        Parameter::new("young", "Pa", 1e9, [1e8, 1e11], "Young's modulus"),
    ],
    quick: true,
    implicit: true,
    run,
};

/// Density of the bricks (kg/m³).
const DENSITY: f64 = 2500.0;

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let (columns, courses, seconds) = match setup.quick {
        true => (4, 4, 2.0),
        false => (setup.get("columns") as usize, setup.get("courses") as usize, setup.get("seconds")),
    };
    let mut outcome = Outcome::default();
    for (name, columns, courses, bond) in [("wall", columns, courses, true), ("stacks", columns.min(4), courses, false)]
    {
        rest(setup, &mut outcome, name, text(setup, columns, courses, bond, seconds), seconds)?;
    }
    Ok(outcome)
}

fn text(setup: &Setup, columns: usize, courses: usize, bond: bool, seconds: f64) -> String {
    let (width, height) = (columns as f64, courses as f64 * 0.5);
    let mut joints = String::new();
    for course in 0..courses {
        let (low, high) = (course as f64 * 0.5, (course + 1) as f64 * 0.5);
        joints += &format!("[[joint]]\npoints = [[0.0, {low:?}], [{width:?}, {low:?}]]\n");
        let shift = if bond && course % 2 == 1 { 0.5 } else { 0.0 };
        for x in (0..=columns).map(|k| k as f64 + shift).filter(|&x| x > 0.0 && x < width) {
            joints += &format!("[[joint]]\npoints = [[{x:?}, {low:?}], [{x:?}, {high:?}]]\n");
        }
    }
    format!(
        "title = \"Masonry at rest\"\n[domain]\noutline = [[-1.0, -0.6], [{right:?}, -0.6], [{right:?}, 0.0], \
         [{width:?}, 0.0], [{width:?}, {height:?}], [0.0, {height:?}], [0.0, 0.0], [-1.0, 0.0]]\n[mesh]\nsize = 1.0\n\
         origin = [0.137, 0.071]\n{joints}[joint_law.mortar]\nfriction_deg = {:e}\n\
         [rock.brick]\ndensity = {DENSITY:e}\n\
         young = {:e}\npoisson = 0.25\n[[fix]]\nblock = [-0.9, -0.5]\n[[stage]]\nname = \"settle\"\nkind = \"static\"\n\
         duration = 60.0\nconvergence = 1e-8\n[[stage]]\nname = \"rest\"\nkind = \"dynamic\"\nduration = {seconds:e}\n\
         damping = 0.1\n",
        setup.get("friction_deg"),
        setup.get("young"),
        right = width + 1.0,
    )
}

/// Settles masonry, lets it rest, and judges the second half of the rest.
fn rest(setup: &mut Setup, outcome: &mut Outcome, name: &str, text: String, seconds: f64) -> Result<(), Trouble> {
    let mut simulation = setup.simulation(&format!("e2_{name}"), text)?;
    let report = simulation.run_stage()?;
    if !simulation.at_rest(&report) {
        return Err(Trouble(format!("e2, {name}: has not come to rest in its time")));
    }
    simulation.next_stage()?;
    let mass: f64 = simulation.model().mass_matrix.total.iter().sum();
    let steps = simulation.steps_in(seconds);
    let (mut before, mut energy, mut last) = (Vec::new(), Vec::new(), None);
    for step in 0..steps {
        if step == steps / 3 {
            before = simulation.state().displacement.clone();
        }
        let report = simulation.advance(step % (steps / 100).max(1) == 0 || step + 1 == steps)?;
        if report.dt > 0.0 {
            energy.push([report.time, report.ledger.kinetic.max(1e-40)]);
            last = Some(report);
        }
    }
    let Some(report) = last else { return Err(Trouble("e2: no step was taken".into())) };
    let row = |what: &str, unit, value, most, why: &str| {
        Row::new(format!("{name}: {what}"), unit, value, 0.0).at_most(most, why)
    };
    let drift = drift(&simulation, &before);
    outcome.rows.extend([
        row("drift over the last two thirds", "m", drift, 0.5e-6, "1e-6 of a brick's height"),
        row(
            "kinetic energy over that of 1 m/s",
            "",
            report.ledger.kinetic / (0.5 * mass),
            1e-12,
            "round-off of forces",
        ),
        row("penetration over the mesh size", "", report.penetration_max, 1e-3, "σh/0.5Ec is 4e-4 under 20 courses"),
    ]);
    let ledger = Row::ledger(&report);
    outcome.rows.push(Row { quantity: format!("{name}: {}", ledger.quantity), ..ledger });
    let plot = Plot::new(format!("E2: kinetic energy of the {name}"), ["time [s]", "kinetic energy [J/m]"]);
    outcome.plots.push(plot.line("computed", energy).logarithmic([false, true]));
    Ok(())
}

fn drift(simulation: &Simulation, before: &[Vector]) -> f64 {
    simulation.state().displacement.iter().zip(before).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}
