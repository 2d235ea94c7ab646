//! D5: a mass that drops on a spring.

use std::f64::consts::PI;

use enmm::geometry::Point;
use enmm::model::Simulation;
use enmm::step::block_motion;

use super::block::G;
use crate::{Outcome, Parameter, Plot, Problem, Row, Series, Setup, Tolerance, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "D5",
    title: "Drop on a spring",
    source: "A mass m falls by H on a spring k: it arrives with √(2gH), sinks in by mg/k + √((mg/k)² + 2mgH/k) and, \
             undamped, comes back to H. The contact spring is implicit (backward Euler, contact_theta = 1), so that it \
             sets no limit on the step; the price is a damping ratio of ½·ω·dt, ω = √(k/m), which takes the share \
             π·ω·dt of the energy in the half swing of the contact. The loss must fall with the step, order 1, to \
             nothing. Catches contacts that gain energy, stick, or are entered late.",
    parameters: &[
        Parameter { name: "m", unit: "kg/m", default: 2500.0, range: [100.0, 1e5], doc: "mass" },
        Parameter { name: "k", unit: "N/m²", default: 1e9, range: [1e6, 1e11], doc: "stiffness of the spring" },
        Parameter { name: "H", unit: "m", default: 0.5, range: [0.05, 5.0], doc: "height of the fall" },
        Parameter {
            name: "omega_dt", unit: "", default: 1e-3, range: [5e-4, 1e-3], doc: "smallest ω·dt of the three"
        },
    ],
    quick: true,
    implicit: false,
    run,
};

/// Young's modulus of the mass over the stiffness of the spring (1/m).
const RIGIDITY: f64 = 1e4;

/// What a drop was like.
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
    let slope = simulation.slope();
    let element = slope.covers.element_at(Point::new(0.51, height + 0.48));
    let block = slope.covers.element_block[element.ok_or_else(|| Trouble("D5: there is no mass".to_owned()))?];
    let (centre, velocity, ..) = block_motion(slope, simulation.state(), &simulation.scratch().metric, block as usize);
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
    let least = setup.get("omega_dt") * if setup.quick { 1.5 } else { 1.0 };
    let steps = [4.0 * least, 2.0 * least, least];
    let mut drops = Vec::new();
    for step in steps {
        let dt = step / omega;
        let solver = format!(
            "[solver]\ncontact_theta = 1.0\ncontact_tolerance = 1e-9\nsweeps_max = 100\ncommunication_step = {:e}\n\
             dt_max = {dt:e}\n",
            10.0 * dt
        );
        drops.push(drop(setup, &format!("omega_dt_{step:e}"), &solver)?);
    }
    let usual = drop(setup, "default_contact", "")?;
    let rows = rows(&drops, &usual, &steps, &Exact::new(mass, stiffness, height));
    Ok(Outcome { rows, plots: vec![path_plot(&drops[2], &usual, height), loss_plot(&drops, &steps)] })
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

fn rows(drops: &[Drop], usual: &Drop, steps: &[f64], exact: &Exact) -> Vec<Row> {
    let last = &drops[2];
    let mut rows = vec![
        Row::new("speed at contact", "m/s", last.speed, exact.speed)
            .within(Tolerance::Relative(1e-3), "the last step before contact, g·dt, and half a step of the leapfrog"),
        Row::new("deepest penetration", "m", last.depth, exact.depth).within(
            Tolerance::Relative(0.5 * PI * steps[2] + 1e-3),
            "half the loss of energy on the way down, ½·π·ω·dt, and 1e-3 for the mass's own \
             spring in series and its waves",
        ),
    ];
    for (drop, step) in drops.iter().zip(steps) {
        rows.push(Row::new(format!("share of the height lost at ω·dt = {step:e}"), "", drop.lost, PI * step).within(
            Tolerance::Relative(0.35),
            "the waves that the mass takes along, up to 1e-3 of the energy, beside a loss of 3e-3 \
             at the smallest step",
        ));
    }
    let order = ((drops[0].lost - drops[1].lost) / (drops[1].lost - drops[2].lost)).log2();
    let limit = 2.0 * last.lost - drops[1].lost;
    rows.extend([
        Row::new("order of the loss in dt", "", order, 1.0).within(
            Tolerance::Absolute(0.2),
            "from three steps; the waves that the mass takes along differ by some 1e-4 of the energy",
        ),
        Row::new("share of the height lost at dt → 0, from two steps", "", limit, 0.0)
            .within(Tolerance::AtMost(1e-3), "the mass comes back to H; the waves that it takes along"),
        Row::new("share of the height lost with the default contact (contact_theta = 4) and step", "", usual.lost, 0.0)
            .within(Tolerance::Shown, "the default contact has a dashpot of (θ − 1)·k·dt and is meant to come to rest"),
        last.ledger.clone(),
    ]);
    rows
}

fn path_plot(fine: &Drop, usual: &Drop, height: f64) -> Plot {
    let fall = (2.0 * height / G).sqrt();
    let exact = |i: i32| {
        let time = 2.0 * fall * f64::from(i) / 100.0;
        let since = if time < fall { time } else { 2.0 * fall - time };
        [time, height - 0.5 * G * since * since]
    };
    Plot {
        title: "Height of the mass over the spring".to_owned(),
        axes: ["time [s]".to_owned(), "height [m]".to_owned()],
        logarithmic: [false; 2],
        series: vec![
            Series {
                name: "exact, without the time of contact".to_owned(),
                points: (0..=100).map(exact).collect(),
                marks: false,
            },
            Series { name: "computed, smallest step".to_owned(), points: fine.path.clone(), marks: true },
            Series { name: "computed, default contact".to_owned(), points: usual.path.clone(), marks: true },
        ],
    }
}

fn loss_plot(drops: &[Drop], steps: &[f64]) -> Plot {
    Plot {
        title: "Loss of height at the rebound".to_owned(),
        axes: ["ω·dt".to_owned(), "share of the height lost".to_owned()],
        logarithmic: [true; 2],
        series: vec![
            Series {
                name: "π·ω·dt".to_owned(), points: steps.iter().map(|&s| [s, PI * s]).collect(), marks: false
            },
            Series {
                name: "computed".to_owned(),
                points: steps.iter().zip(drops).map(|(&s, d)| [s, d.lost]).collect(),
                marks: true,
            },
        ],
    }
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
