//! D5: a mass that drops on a spring.

use enmm::geometry::Point;
use enmm::model::Simulation;

use super::block::G;
use crate::{Outcome, Parameter, Plot, Problem, Row, Setup, Tolerance, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "D5",
    title: "Drop on a spring",
    source: "A mass m falls by H on a spring k: it arrives with √(2gH), sinks in by mg/k + √((mg/k)² + 2mgH/k) and, \
             undamped, comes back to H. The spring is a joint's own stiffness, which the open–close iteration takes \
             centred in time (theory, Eqs. 52 and 53), so that it keeps its energy at any step that resolves it. \
             Catches contacts that gain or lose energy, stick, or are entered late.",
    parameters: &[
        Parameter::new("m", "kg/m", 2500.0, [100.0, 1e5], "mass"),
        Parameter::new("k", "N/m²", 1e9, [1e6, 1e11], "stiffness of the spring"),
        Parameter::new("H", "m", 0.5, [0.05, 5.0], "height of the fall"),
        Parameter::new("omega_dt", "", 1e-3, [5e-4, 2e-3], "smallest ω·dt of the three"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Young's modulus of the mass over the stiffness of the spring (1/m).
const RIGIDITY: f64 = 1e4;

/// Record of a drop.
#[derive(Clone, Debug)]
struct Drop {
    /// Speed at contact (m/s).
    speed: f64,
    /// Deepest penetration (m).
    depth: f64,
    /// Share of the height that the mass did not come back to.
    lost: f64,
    /// Time (s) and height (m) of the underside.
    path: Vec<[f64; 2]>,
    ledger: Row,
}

/// The case: a mass of 1 m × 1 m above a held one.
fn case(setup: &Setup, solver: &str) -> String {
    let [mass, stiffness, height] = ["m", "k", "H"].map(|name| setup.get(name));
    format!(
        "title = \"Drop on a spring\"\n[domain]\noutline = [[0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.0, 0.0]]\n\
         islands = [[[0.0, {height}], [1.0, {height}], [1.0, {high}], [0.0, {high}]]]\n[mesh]\nsize = 1.1\n\
         origin = [0.03, 0.02]\n[joint_law.spring]\nfriction_deg = 0.0\nnormal_stiffness = {stiffness:e}\n[[fix]]\n\
         block = [0.1, -0.9]\n[rock.rock]\ndensity = {mass:e}\nyoung = {young:e}\npoisson = 0.25\n[[stage]]\n\
         name = \"fall\"\nkind = \"dynamic\"\nduration = {duration:e}\ndamping = 0.0\n{solver}",
        high = height + 1.0,
        young = RIGIDITY * stiffness,
        duration = 4.0 * (2.0 * height / G).sqrt(),
    )
}

/// Height (m) and velocity (m/s) of the mass.
fn motion(simulation: &Simulation, height: f64) -> Result<(f64, f64), Trouble> {
    let slope = simulation.model();
    let element = slope.covers.element_at(Point::new(0.51, height + 0.48));
    let block = slope.covers.element_block[element.ok_or_else(|| Trouble("D5: there is no mass".to_owned()))?];
    let (centre, velocity, ..) = simulation.rigid_motion_of(block);
    Ok((centre.y - height - 0.5, velocity.y))
}

fn drop(setup: &mut Setup, name: &str, solver: &str) -> Result<Drop, Trouble> {
    let height = setup.get("H");
    let mut simulation = setup.simulation(name, case(setup, solver))?;
    let fall = (2.0 * height / G).sqrt();
    let ledger = Row::ledger(&simulation.report());
    let mut drop = Drop { speed: 0.0, depth: 0.0, lost: 1.0, path: Vec::new(), ledger };
    let (mut touched, mut rebound) = (false, false);
    while !simulation.stage_is_over(None) {
        let near = drop.path.last().is_none_or(|p| p[1] < 0.05 * height) || simulation.time() > 0.95 * fall;
        let report = simulation.advance(near && !rebound)?;
        let (place, velocity) = motion(&simulation, height)?;
        if drop.path.last().is_none_or(|p| simulation.time() > p[0] + 0.02 * fall) {
            drop.path.push([simulation.time(), place + height]);
        }
        touched |= report.penetration_max > 0.0;
        if !touched {
            drop.speed = -velocity;
        }
        if report.penetration_max > drop.depth {
            drop.depth = report.penetration_max;
            drop.ledger = Row::ledger(&report);
        }
        rebound |= touched && velocity > 0.0;
        if rebound && velocity < 0.0 {
            drop.lost = -place / height;
            return Ok(drop);
        }
    }
    Err(Trouble(format!("D5: the mass has not come back by {:.3} s", simulation.time())))
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let [mass, stiffness, height] = ["m", "k", "H"].map(|name| setup.get(name));
    let omega = (stiffness / mass).sqrt();
    let steps = [4.0, 2.0, 1.0].map(|factor| factor * setup.get("omega_dt"));
    let mut drops = Vec::new();
    for step in steps {
        let dt = step / omega;
        let solver = format!("[solver]\ncommunication_step = {:e}\ndt_max = {dt:e}\n", 10.0 * dt);
        drops.push((format!("ω·dt = {step:e}"), drop(setup, &format!("omega_dt_{step:e}"), &solver)?));
    }
    drops.push(("the default step".to_owned(), drop(setup, "default_step", "")?));
    let mut rows = Vec::new();
    for (name, drop) in &drops {
        rows.extend(self::rows(name, drop, &Exact::new(mass, stiffness, height), height));
    }
    Ok(Outcome { rows, plots: vec![path_plot(&drops[2].1, height)] })
}

/// The closed forms.
struct Exact {
    speed: f64,
    depth: f64,
}

impl Exact {
    fn new(mass: f64, stiffness: f64, height: f64) -> Self {
        let sag = mass * G / stiffness;
        Self { speed: (2.0 * G * height).sqrt(), depth: sag + (sag * sag + 2.0 * sag * height).sqrt() }
    }
}

fn rows(name: &str, drop: &Drop, exact: &Exact, height: f64) -> [Row; 4] {
    let within = Tolerance::Relative(1e-3);
    let series = "the mass's own spring in series, 1e-4 of the joint's compliance, and the waves that it takes along";
    [
        Row::new(format!("speed at contact, {name}"), "m/s", drop.speed, exact.speed)
            .within(within, "the last step before contact, g·dt, and half a step of the leapfrog"),
        Row::new(format!("deepest penetration, {name}"), "m", drop.depth, exact.depth).within(within, series),
        Row::new(format!("height of the rebound, {name}"), "m", height * (1.0 - drop.lost), height)
            .within(within, "the waves that the mass takes along: the spring itself keeps its energy"),
        drop.ledger.clone(),
    ]
}

fn path_plot(fine: &Drop, height: f64) -> Plot {
    let fall = (2.0 * height / G).sqrt();
    let exact = |i: i32| {
        let time = 2.0 * fall * f64::from(i) / 100.0;
        let since = if time < fall { time } else { 2.0 * fall - time };
        [time, height - 0.5 * G * since * since]
    };
    Plot::new("Height of the mass over the spring", ["time [s]", "height [m]"])
        .line("exact, without the time of contact", (0..=100).map(exact).collect())
        .marks("computed, smallest step", fine.path.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_give_the_published_numbers() {
        let exact = Exact::new(2500.0, 1e9, 0.5);
        assert!((exact.speed - 3.132_092).abs() < 1e-6);
        assert!((exact.depth - 4.976_858e-3).abs() < 1e-9);
    }
}
