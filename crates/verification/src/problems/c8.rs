//! C8: the toppling slope of Goodman and Bray.

use super::incline::{ledger_row, reduce, trial_plot};
use super::toppling::{Columns, Mode};
use crate::{Origin, Outcome, Parameter, Plot, Problem, Row, Setup, Tolerance, Trouble, Values};
use enmm_stability::strength_reduction::Reduction;

pub const PROBLEM: Problem = Problem {
    id: "C8",
    title: "Toppling columns of Goodman and Bray",
    source: "R. E. Goodman and J. W. Bray, Toppling of rock slopes (1976): limit equilibrium of columns from the crest \
             down; the force that holds the toe, the friction at which it vanishes, the modes of the columns; catches \
             wrong corner contacts, moments and friction on turning faces",
    parameters: &[
        Parameter::new("columns", "", 16.0, [3.0, 40.0], "number of columns"),
        Parameter::new("crest", "", 10.0, [2.0, 39.0], "column at the crest, from the toe"),
        Parameter::new("width", "m", 10.0, [1.0, 50.0], "width of a column"),
        Parameter::new("step", "m", 1.0, [0.1, 10.0], "step of the base"),
        Parameter::new("below", "m", 5.0, [0.5, 50.0], "a1, rise of heads below the crest"),
        Parameter::new("above", "m", 5.0, [0.0, 50.0], "a2, fall of heads above the crest"),
        Parameter::new("base_deg", "°", 30.0, [10.0, 50.0], "dip of the base"),
        Parameter::new("gamma", "N/m³", 25e3, [1e4, 4e4], "unit weight"),
        Parameter::new("tan_1", "", 0.65, [0.1, 0.95], "tan φ, first holding force"),
        Parameter::new("tan_2", "", 0.70, [0.1, 0.95], "tan φ, second holding force"),
        Parameter::new("tan_3", "", 0.75, [0.1, 0.95], "tan φ, third holding force"),
        Parameter::new("tan_4", "", 0.80, [0.1, 0.95], "tan φ that needs no force"),
        Parameter::new("phi_deg", "°", 45.0, [10.0, 60.0], "friction for the factor"),
        Parameter::new("young", "Pa", 2e10, [1e9, 2e11], "Young's modulus of the rock"),
        Parameter::new("mesh", "", 0.4, [0.1, 1.0], "mesh size over column width"),
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

/// Why limits may differ from those of rigid columns.
const ELASTIC: &str = "elastic columns lean by some 1e-4 and touch over a length, not in a corner";
/// How the slope comes to rest.
const STAGE: &str = "[[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 120.0\n";

/// Factor of safety and the modes of the failure.
fn factor(setup: &mut Setup, columns: &Columns, outcome: &mut Outcome) -> Result<(), Trouble> {
    let phi = setup.get("phi_deg");
    let (limit, tangent) = (columns.limit(), phi.to_radians().tan());
    let exact_factor = tangent / limit;
    let reduction = reduce(setup, "factor", columns.text(phi) + STAGE)?;
    let factor = reduction.factor().unwrap_or(f64::NAN);
    let tolerance = Tolerance::Relative(0.01);
    outcome.rows.push(Row::new("factor of safety", "", factor, exact_factor).within(tolerance, ELASTIC));
    outcome.rows.push(Row::new("tan φ at the limit", "", tangent / factor, limit).within(tolerance, ELASTIC));
    let free = setup.get("tan_4");
    let exact = f64::from(u8::from(columns.equilibrium(free).force == 0.0));
    let stands = f64::from(u8::from(tangent / free <= reduction.low.unwrap_or(0.0)));
    let name = format!("whether the slope stands at tan φ = {free}");
    outcome.rows.push(Row::new(name, "", stands, exact).absolute(0.0, "yes or no"));
    if setup.values == Values::of(&PROBLEM) {
        let row = Row::new("tan φ at the limit, published", "", tangent / factor, 0.7855);
        let published = Origin::Published("Goodman and Bray 1976, as handed down with the problem");
        outcome.rows.push(row.within(tolerance, ELASTIC).from(published));
    }
    outcome.rows.extend(modes(columns, &reduction, limit));
    outcome.rows.push(ledger_row(&[&reduction]));
    outcome.plots.push(trial_plot("Trials", &reduction, exact_factor));
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
            .absolute(1.0, "a column between two modes does a little of both")
    };
    [Mode::Stable, Mode::Topples, Mode::Slides].map(row).into()
}

/// Modes by the motion of the failing blocks: none, turning by more than half of what its shift explains, or shifting.
fn moving(columns: &Columns, reduction: &Reduction) -> Vec<Mode> {
    let covers = &reduction.simulation.model().covers;
    let failing = reduction.first_unstable().map_or(&[][..], |trial| &trial.failing);
    let of = |(k, middle): (usize, &[f64; 2])| {
        let element = covers.element_at((*middle).into());
        let block = element.map(|e| covers.element_block[e].number());
        let Some(motion) = failing.iter().find(|f| Some(f.block) == block) else { return Mode::Stable };
        let reach = columns.height(k + 1).hypot(columns.width);
        if motion.rotation.abs() * reach > 0.5 * motion.displacement { Mode::Topples } else { Mode::Slides }
    };
    columns.middles().iter().enumerate().map(of).collect()
}

/// Limits under the forces that the formulas require: strength reduced until the held slope fails.
///
/// The force itself would be ill conditioned: it changes by some 13 MN/m per unit of tan φ, so that a limit which is
/// right to 0.1 % leaves 3 % of the smallest one open.
fn holding(setup: &mut Setup, columns: &Columns, outcome: &mut Outcome) -> Result<(), Trouble> {
    let phi = setup.get("phi_deg");
    let toe = columns.middles()[0];
    let mut marks = Vec::new();
    for k in 1..=3 {
        let tangent = setup.get(&format!("tan_{k}"));
        let force = columns.equilibrium(tangent).force;
        if force <= 0.0 {
            return Err(Trouble(format!("tan_{k} needs no holding force: choose it below {:.4}", columns.limit())));
        }
        let load = format!("[[load]]\nkind = \"block\"\npoint = {toe:?}\nforce = [{:e}, 0.0]\n", -force);
        let reduction = reduce(setup, &format!("held_{k}"), columns.text(phi) + &load + STAGE)?;
        let found = phi.to_radians().tan() / reduction.factor().unwrap_or(f64::NAN);
        let name = format!("tan φ at the limit under {:.2} kN/m at the toe", force / 1e3);
        outcome.rows.push(Row::new(name, "", found, tangent).relative(0.02, ELASTIC));
        outcome.rows.push(ledger_row(&[&reduction]));
        marks.push([found, force / 1e3]);
    }
    let free = setup.get("tan_4");
    let exact = (0..=100).map(|k| setup.get("tan_1") + (free - setup.get("tan_1")) * f64::from(k) / 100.0);
    let exact = exact.map(|t| [t, columns.equilibrium(t).force / 1e3]).collect();
    let plot = Plot::new("Holding force", ["tan φ", "force that holds the toe (kN/m)"]);
    outcome.plots.push(plot.line("exact", exact).marks("computed limits", marks));
    Ok(())
}
