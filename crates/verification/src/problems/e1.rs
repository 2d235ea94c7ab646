//! E1: a fractured slope by the explicit and by the implicit method.

use enmm::model::case::Integrator;
use enmm::model::{Simulation, StepReport};

use crate::slope::{Totals, block_displacements, difference, fail, slope_text};
use crate::{Origin, Outcome, Parameter, Plot, Problem, Row, Setup, Trouble};

pub const PROBLEM: Problem = Problem {
    id: "E1",
    title: "Fractured slope, explicit and implicit",
    source: "No exact answer: both methods on one model must settle at the same places, and fail with the same \
             energies. `cargo xtask compare` sets their cost side by side. Catches whatever one of them does wrong \
             alone",
    parameters: &[
        Parameter::new("spacing", "m", 6.4, [3.0, 30.0], "spacing of both joint sets"),
        Parameter::new("spacing_failing", "m", 12.0, [3.0, 30.0], "the same of a slope that fails"),
        Parameter::new("t", "s", 1.0, [0.2, 3.0], "time for which it fails"),
    ],
    quick: true,
    implicit: false,
    run,
};

/// Both methods, the one that the other is compared with first.
const METHODS: [Integrator; 2] = [Integrator::Explicit, Integrator::Implicit];
/// Where compared values come from.
const ORIGIN: Origin = Origin::Numerical("the explicit method");

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let mut outcome = Outcome::default();
    let given = setup.integrator;
    rest(setup, &mut outcome)?;
    failure(setup, &mut outcome)?;
    setup.integrator = given;
    Ok(outcome)
}

/// Spacing (m) of a parameter; wide when quick.
fn spacing(setup: &Setup, name: &str) -> f64 {
    if setup.quick { setup.get(name).max(16.0) } else { setup.get(name) }
}

/// A slope at rest under its weight.
fn settled(setup: &mut Setup, name: &str, text: String) -> Result<(Simulation, StepReport), Trouble> {
    let name = format!("{name}_{:?}", setup.integrator).to_lowercase();
    let mut simulation = setup.simulation(&name, text)?;
    let report = simulation.run_stage()?;
    if !simulation.at_rest(&report) {
        return Err(Trouble(format!("{name}: the slope has not come to rest in its time")));
    }
    Ok((simulation, report))
}

/// Places and sums of two slopes at rest.
fn rest(setup: &mut Setup, outcome: &mut Outcome) -> Result<(), Trouble> {
    let spacing = spacing(setup, "spacing");
    let mut found = Vec::new();
    for integrator in METHODS {
        setup.integrator = integrator;
        let (simulation, report) = settled(setup, "e1", slope_text(spacing, 0.0))?;
        let ledger = Row::ledger(&report);
        outcome.rows.push(Row { quantity: format!("{integrator:?}: {}", ledger.quantity), ..ledger });
        let forces: f64 = simulation.state().contacts.iter().map(|c| c.normal_force.max(0.0)).sum();
        found.push((block_displacements(&simulation), forces, report.ledger.potential));
    }
    let [explicit, implicit] = [&found[0], &found[1]];
    let apart = difference(&implicit.0, &explicit.0);
    let path = "friction remembers its path: dynamic relaxation and static steps load joints in another order";
    outcome.rows.extend([
        Row::new("places of all blocks, rms difference over rms displacement", "", apart, 0.0)
            .at_most(0.05, path)
            .from(ORIGIN),
        Row::new("sum of the normal forces of all contacts", "N/m", implicit.1, explicit.1)
            .relative(0.05, path)
            .from(ORIGIN),
        Row::new("potential energy released", "J/m", implicit.2, explicit.2)
            .relative(0.02, "the total hardly knows the path")
            .from(ORIGIN),
    ]);
    let points = |k: usize| found[k].0.iter().enumerate().map(|(b, u)| [b as f64, u.norm()]).collect();
    let plot = Plot::new("E1: displacement of every block", ["block [-]", "displacement [m]"]);
    outcome.plots.push(plot.marks("explicit", points(0)).marks("implicit", points(1)));
    Ok(())
}

/// Sums over a slope that fails: single blocks go their own ways.
fn failure(setup: &mut Setup, outcome: &mut Outcome) -> Result<(), Trouble> {
    let (spacing, seconds) = (spacing(setup, "spacing_failing"), setup.get("t"));
    let mut found = Vec::new();
    for integrator in METHODS {
        setup.integrator = integrator;
        let (mut simulation, _) = settled(setup, "e1_failing", slope_text(spacing, 2.0 * seconds))?;
        found.push(fail(&mut simulation, seconds)?.values());
    }
    let reason = "steps twenty times as long see blocks part and meet later, and damp the swings of their deformation; \
                  the motion as a whole is that of gravity against friction";
    for (k, (name, unit)) in Totals::NAMES.into_iter().enumerate() {
        let row = Row::new(format!("failing for {seconds} s: {name}"), unit, found[1][k], found[0][k]);
        outcome.rows.push(row.relative(0.05, reason).from(ORIGIN));
    }
    Ok(())
}
