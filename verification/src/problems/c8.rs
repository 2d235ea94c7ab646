//! C8: the toppling slope of Goodman and Bray.

use super::incline::{ledger_row, reduce, trial_plot};
use super::toppling::{Columns, Mode};
use crate::{Outcome, Parameter, Plot, Problem, Row, Series, Setup, Tolerance, Trouble, run_stage};
use enmm::model::Simulation;
use enmm::model::strength_reduction::Reduction;

pub const PROBLEM: Problem = Problem {
    id: "C8",
    title: "Toppling columns of Goodman and Bray",
    source: "R. E. Goodman and J. W. Bray, Toppling of rock slopes (1976): limit equilibrium of columns from the crest \
             down; the force that holds the toe, the friction at which it vanishes, the modes of the columns; catches \
             wrong corner contacts, moments and friction on turning faces",
    parameters: &[
        Parameter { name: "columns", unit: "", default: 16.0, range: [3.0, 40.0], doc: "number of columns" },
        Parameter {
            name: "crest",
            unit: "",
            default: 10.0,
            range: [2.0, 39.0],
            doc: "column at the crest, from the toe",
        },
        Parameter { name: "width", unit: "m", default: 10.0, range: [1.0, 50.0], doc: "width of a column" },
        Parameter { name: "step", unit: "m", default: 1.0, range: [0.1, 10.0], doc: "step of the base" },
        Parameter {
            name: "below",
            unit: "m",
            default: 5.0,
            range: [0.5, 50.0],
            doc: "a1, rise of heads below the crest",
        },
        Parameter {
            name: "above",
            unit: "m",
            default: 5.0,
            range: [0.0, 50.0],
            doc: "a2, fall of heads above the crest",
        },
        Parameter { name: "base_deg", unit: "°", default: 30.0, range: [10.0, 50.0], doc: "dip of the base" },
        Parameter { name: "gamma", unit: "N/m³", default: 25e3, range: [1e4, 4e4], doc: "unit weight" },
        Parameter { name: "tan_1", unit: "", default: 0.65, range: [0.1, 0.95], doc: "tan φ, first holding force" },
        Parameter { name: "tan_2", unit: "", default: 0.70, range: [0.1, 0.95], doc: "tan φ, second holding force" },
        Parameter { name: "tan_3", unit: "", default: 0.75, range: [0.1, 0.95], doc: "tan φ, third holding force" },
        Parameter { name: "tan_4", unit: "", default: 0.80, range: [0.1, 0.95], doc: "tan φ that needs no force" },
        Parameter { name: "phi_deg", unit: "°", default: 45.0, range: [10.0, 60.0], doc: "friction for the factor" },
        Parameter { name: "young", unit: "Pa", default: 2e10, range: [1e9, 2e11], doc: "Young's modulus of the rock" },
        Parameter { name: "mesh", unit: "", default: 0.6, range: [0.1, 1.0], doc: "mesh size over column width" },
        Parameter {
            name: "prop",
            unit: "N/m²",
            default: 2e8,
            range: [1e7, 1e10],
            doc: "stiffness of the prop at the toe",
        },
        Parameter {
            name: "t_ramp",
            unit: "s",
            default: 30.0,
            range: [5.0, 300.0],
            doc: "time in which friction falls",
        },
    ],
    quick: true,
    implicit: false,
    run,
};

fn columns(setup: &Setup) -> Columns {
    let width = setup.get("width");
    Columns {
        count: setup.get("columns") as usize,
        crest: setup.get("crest") as usize,
        width,
        step: setup.get("step"),
        below: setup.get("below"),
        above: setup.get("above"),
        base: setup.get("base_deg").to_radians(),
        unit_weight: setup.get("gamma"),
        young: setup.get("young"),
        size: setup.get("mesh") * width,
    }
}

fn run(setup: &mut Setup) -> Result<Outcome, Trouble> {
    let columns = columns(setup);
    if !columns.is_sound() {
        return Err(Trouble("a column has no height: fewer columns, or smaller step and above".to_owned()));
    }
    let mut outcome = Outcome::default();
    factor(setup, &columns, &mut outcome)?;
    if !setup.quick {
        holding(setup, &columns, &mut outcome)?;
    }
    Ok(outcome)
}

/// Factor of safety and the modes of the failure.
fn factor(setup: &mut Setup, columns: &Columns, outcome: &mut Outcome) -> Result<(), Trouble> {
    let phi = setup.get("phi_deg");
    let (limit, tangent) = (columns.limit(), phi.to_radians().tan());
    let exact = tangent / limit;
    let stage = "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 120.0\n";
    let reduction = reduce(setup, "factor", columns.text(phi) + stage)?;
    let factor = reduction.factor().unwrap_or(f64::NAN);
    let reason = "elastic columns lean by some 1e-4 and touch over a length, not in a corner";
    let tolerance = Tolerance::Relative(0.015);
    outcome.rows.push(Row::new("factor of safety", "", factor, exact).within(tolerance, reason));
    outcome.rows.push(Row::new("tan φ at the limit", "", tangent / factor, limit).within(tolerance, reason));
    outcome.rows.extend(modes(columns, &reduction, limit));
    outcome.rows.push(ledger_row(&[&reduction]));
    outcome.plots.push(trial_plot("Trials", &reduction, exact));
    Ok(())
}

/// Columns of each mode: by the formulas at the limit, and by how they move in the least unstable trial.
fn modes(columns: &Columns, reduction: &Reduction, limit: f64) -> Vec<Row> {
    let exact = columns.equilibrium(limit * (1.0 - 1e-6)).modes;
    let found = moving(columns, reduction);
    let name = |mode: Mode| match mode {
        Mode::Stable => "columns that stand",
        Mode::Topples => "columns that topple",
        Mode::Slides => "columns that slide",
    };
    let count = |modes: &[Mode], mode: Mode| modes.iter().filter(|m| **m == mode).count() as f64;
    let row = |mode: Mode| {
        Row::new(name(mode), "", count(&found, mode), count(&exact, mode))
            .within(Tolerance::Absolute(1.0), "a column between two modes does a little of both")
    };
    [Mode::Stable, Mode::Topples, Mode::Slides].map(row).into()
}

/// Modes by the motion of the failing blocks: none, turning by more than half of what its shift explains, or shifting.
fn moving(columns: &Columns, reduction: &Reduction) -> Vec<Mode> {
    let covers = &reduction.simulation.slope().covers;
    let failing = reduction.first_unstable().map_or(&[][..], |trial| &trial.failing);
    let of = |(k, middle): (usize, &[f64; 2])| {
        let element = covers.element_at((*middle).into());
        let block = element.map(|e| covers.element_block[e]);
        let Some(motion) = failing.iter().find(|f| Some(f.block) == block) else { return Mode::Stable };
        let reach = columns.height(k + 1).hypot(columns.width);
        if motion.rotation.abs() * reach > 0.5 * motion.displacement { Mode::Topples } else { Mode::Slides }
    };
    columns.middles().iter().enumerate().map(of).collect()
}

/// The force that holds the toe while friction falls slowly: a prop yields so that friction is mobilised everywhere.
fn holding(setup: &mut Setup, columns: &Columns, outcome: &mut Outcome) -> Result<(), Trouble> {
    let tangents = [1, 2, 3, 4].map(|k| setup.get(&format!("tan_{k}")));
    let begin = 1.2 * tangents.into_iter().fold(columns.limit(), f64::max);
    let ramp = setup.get("t_ramp");
    let toe = columns.middles()[0];
    let text = columns.text(begin.atan().to_degrees())
        + &format!(
            "[[fix]]\nname = \"prop\"\npoint = {toe:?}\naxes = \"x\"\nstiffness = {:e}\nactive = false\n[[stage]]\n\
             name = \"settle\"\nkind = \"static\"\nduration = 120.0\n[[stage]]\nname = \"weaken\"\n\
             kind = \"dynamic\"\nduration = {ramp:e}\ndamping = 1.0\nfix = [\"prop\"]\n",
            setup.get("prop")
        );
    let mut simulation = setup.simulation("holding", text)?;
    run_stage(&mut simulation)?;
    simulation.next_stage()?;
    let end = 0.98 * tangents.into_iter().fold(f64::INFINITY, f64::min);
    let curve = weaken(&mut simulation, [begin, end], ramp)?;
    for tangent in tangents {
        outcome.rows.push(holding_row(columns, tangent, at(&curve.points, tangent)));
    }
    outcome.rows.push(Row::ledger(&simulation.report()));
    let exact = (0..=100).map(|k| end + (begin - end) * f64::from(k) / 100.0);
    let exact = exact.map(|t| [t, columns.equilibrium(t).force / 1e3]).collect();
    let series = vec![Series { name: "exact".to_owned(), points: exact, marks: false }, curve];
    let axes = ["tan φ".to_owned(), "force that holds the toe (kN/m)".to_owned()];
    outcome.plots.push(Plot { title: "Holding force".to_owned(), axes, logarithmic: [false; 2], series });
    Ok(())
}

/// Lets friction fall from one tangent to another over `ramp` (s); the prop's force (kN/m) against the friction.
fn weaken(simulation: &mut Simulation, [begin, end]: [f64; 2], ramp: f64) -> Result<Series, Trouble> {
    let start = simulation.time();
    let drive = simulation.drive();
    drive.from.copy_from(&drive.to);
    drive.to.strength_factor = end / begin;
    (drive.since, drive.until) = (start, start + ramp);
    let mut points = Vec::new();
    let every = (simulation.steps_in(ramp) / 400).max(1);
    let steps = simulation.steps_in(ramp);
    let (mut sum, mut count) = (0.0, 0.0);
    for step in 1..=steps {
        simulation.advance(false)?;
        sum += simulation.state().support_force.iter().sum::<f64>().abs();
        count += 1.0;
        if step.is_multiple_of(every) {
            let share = (simulation.time() - 0.5 * every as f64 * simulation.slope().dt - start) / ramp;
            points.push([begin + (end - begin) * share, sum / count / 1e3]);
            (sum, count) = (0.0, 0.0);
        }
    }
    Ok(Series { name: "computed".to_owned(), points, marks: false })
}

/// Mean of a falling curve within 0.005 of a place.
fn at(points: &[[f64; 2]], place: f64) -> f64 {
    let near = points.iter().filter(|p| (p[0] - place).abs() < 0.005);
    let (sum, count) = near.fold((0.0, 0.0), |(sum, count), p| (sum + p[1], count + 1.0));
    sum / count
}

fn holding_row(columns: &Columns, tangent: f64, computed: f64) -> Row {
    let exact = columns.equilibrium(tangent).force / 1e3;
    let name = format!("force that holds the toe at tan φ = {tangent}");
    let row = Row::new(name, "kN/m", computed, exact);
    if exact > 0.0 {
        return row.within(Tolerance::Relative(0.02), "quasi-static fall of friction onto an elastic prop");
    }
    let weight = columns.equilibrium(0.9 * columns.limit()).force / 1e3;
    let reason = "2 % of the force at 0.9 of the limit: what elastic take-up of shear leaves on the prop";
    row.within(Tolerance::Absolute(0.02 * weight), reason)
}
