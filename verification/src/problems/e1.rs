//! E1: a fractured slope by the explicit and by the implicit method.

use enmm::model::case::Integrator;

use crate::comparison::{block_displacements, difference, slope_text};
use crate::{Origin, Outcome, Parameter, Plot, Problem, Row, Series, Setup, Tolerance, Trouble, run_stage};

pub const PROBLEM: Problem = Problem {
    id: "E1",
    title: "Fractured slope, explicit and implicit",
    source: "No exact answer: both methods on one model must settle at the same places. `cargo xtask compare` sets \
             their cost side by side. Catches whatever one of them does wrong alone",
    parameters: &[Parameter {
        name: "spacing",
        unit: "m",
        default: 6.4,
        range: [3.0, 30.0],
        doc: "spacing of both joint sets",
    }],
    quick: true,
    implicit: false,
    run,
};

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let spacing = if setup.quick { setup.get("spacing").max(16.0) } else { setup.get("spacing") };
    let mut outcome = Outcome::default();
    let mut settled = Vec::new();
    let given = setup.integrator;
    for integrator in [Integrator::Explicit, Integrator::Implicit] {
        setup.integrator = integrator;
        let mut simulation =
            setup.simulation(&format!("e1_{integrator:?}").to_lowercase(), slope_text(spacing, 0.0))?;
        let report = run_stage(&mut simulation)?;
        if !simulation.at_rest(&report) {
            return Err(Trouble(format!("e1, {integrator:?}: the slope has not come to rest in its time")));
        }
        let ledger = Row::ledger(&report);
        outcome.rows.push(Row { quantity: format!("{integrator:?}: {}", ledger.quantity), ..ledger });
        let forces: f64 = simulation.state().contacts.iter().map(|c| c.normal_force.max(0.0)).sum();
        settled.push((block_displacements(&simulation), forces, report.ledger.potential));
    }
    setup.integrator = given;
    let origin = Origin::Numerical("the explicit method");
    let [explicit, implicit] = [&settled[0], &settled[1]];
    let apart = difference(&implicit.0, &explicit.0);
    let path = "friction remembers its path: dynamic relaxation and static steps load joints in another order";
    outcome.rows.extend([
        Row::new("places of all blocks, rms difference over rms displacement", "", apart, 0.0)
            .within(Tolerance::AtMost(0.05), path)
            .from(origin),
        Row::new("sum of the normal forces of all contacts", "N/m", implicit.1, explicit.1)
            .within(Tolerance::Relative(0.05), path)
            .from(origin),
        Row::new("potential energy released", "J/m", implicit.2, explicit.2)
            .within(Tolerance::Relative(0.02), "the total hardly knows the path")
            .from(origin),
    ]);
    let points = |k: usize| settled[k].0.iter().enumerate().map(|(b, u)| [b as f64, u.norm()]).collect();
    outcome.plots.push(Plot {
        title: "E1: displacement of every block".into(),
        axes: ["block [-]".into(), "displacement [m]".into()],
        logarithmic: [false; 2],
        series: vec![
            Series { name: "explicit".into(), points: points(0), marks: true },
            Series { name: "implicit".into(), points: points(1), marks: true },
        ],
    });
    Ok(outcome)
}
