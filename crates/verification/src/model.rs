//! Models of a problem: cases from text, stages run to their ends, ledgers.

use std::fmt;
use std::path::Path;

use enmm::model::case::Integrator;
use enmm::model::{Simulation, StepReport};
use enmm_io as io;

use crate::{Problem, Row, Values};

/// Why a problem could not be solved.
#[derive(Debug, Clone, PartialEq)]
pub struct Trouble(pub String);

impl<E: std::error::Error> From<E> for Trouble {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

impl fmt::Display for Trouble {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.0)
    }
}

/// Parameters and options of a problem, and the cases that it has built so far.
pub struct Setup {
    /// Values of the parameters.
    pub values: Values,
    /// Time integration.
    pub integrator: Integrator,
    /// Whether fewer and coarser models will do.
    pub quick: bool,
    /// Name and text of each case, for users who want to change them.
    pub cases: Vec<(String, String)>,
}

impl Setup {
    /// The default values of a problem under the explicit integrator.
    pub fn of(problem: &Problem, quick: bool) -> Self {
        Self { values: Values::of(problem), integrator: Integrator::Explicit, quick, cases: Vec::new() }
    }

    /// The value of a parameter.
    pub fn get(&self, name: &str) -> f64 {
        self.values.get(name)
    }

    /// Builds a model from the text of a case and keeps the text under `name`.
    ///
    /// # Errors
    /// When the case cannot be read or built.
    pub fn simulation(&mut self, name: &str, text: String) -> Result<Simulation, Trouble> {
        let mut case = io::parse_case(&text, name, Path::new("."))?.case;
        self.cases.push((name.to_owned(), text));
        case.solver.integrator = self.integrator;
        Ok(enmm_implicit::simulation(case)?)
    }
}

/// Runs all stages; returns the last report of each.
///
/// # Errors
/// A numerical failure, or a stage that does not fit.
pub fn run_all(simulation: &mut Simulation) -> Result<Vec<StepReport>, Trouble> {
    let mut reports = vec![simulation.run_stage()?];
    while simulation.next_stage()? {
        reports.push(simulation.run_stage()?);
    }
    Ok(reports)
}

/// The report whose ledger is wider open, the second of equals.
pub fn wider_open(a: StepReport, b: StepReport) -> StepReport {
    let share = |report: &StepReport| report.ledger.residual_relative().abs();
    if share(&b) >= share(&a) { b } else { a }
}

impl Row {
    /// Residual of the energy ledger, relative to its largest term (claim A4).
    pub fn ledger(report: &StepReport) -> Self {
        Self::new("energy ledger, residual over largest term", "", report.ledger.residual_relative(), 0.0)
            .at_most(1e-3, "claim A4: the leapfrog's own error is ½(ω dt)² of a mode's energy")
    }
}
