//! Results of problems, as data that can be written and read back.

use serde::{Deserialize, Serialize};

use crate::plot::file_name;
use crate::{Origin, Outcome, Parameter, Problem, Row, Solved, Tolerance};
use enmm::model::case::Integrator;

/// Problems with their rows.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Whether all of them pass.
    pub passed: bool,
    /// The problems in their order.
    pub problems: Vec<ProblemRecord>,
}

/// One problem.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProblemRecord {
    /// Name of the problem, such as `C1`.
    pub id: String,
    /// Title.
    pub title: String,
    /// The closed form, where it comes from, and what the problem catches.
    pub source: String,
    /// Whether it is part of the quick set.
    pub quick: bool,
    /// `explicit` or `implicit`.
    pub integrator: String,
    /// Its parameters.
    pub parameters: Vec<ParameterRecord>,
    /// Computed beside exact values.
    pub rows: Vec<RowRecord>,
    /// Title of each plot and the name of its file.
    pub plots: Vec<[String; 2]>,
    /// Why there are no rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trouble: Option<String>,
    /// Whether there are rows and all pass.
    pub passed: bool,
    /// Wall time (s); absent where records are compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<f64>,
    /// Rows of the quick form, by which a test sees whether the report is still that of the code.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quick_rows: Vec<RowRecord>,
}

/// A parameter with its value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ParameterRecord {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Value that the rows hold for.
    pub value: f64,
    /// Value when nobody changes it.
    pub default: f64,
    /// Least and greatest value.
    pub range: [f64; 2],
    /// Description.
    pub doc: String,
}

impl ParameterRecord {
    /// A parameter that has this value, as data.
    pub fn of(parameter: &Parameter, value: f64) -> Self {
        let Parameter { name, unit, default, range, doc } = *parameter;
        Self { name: name.to_owned(), unit: unit.to_owned(), value, default, range, doc: doc.to_owned() }
    }
}

/// How the error of a row is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToleranceKind {
    /// Relative to the exact value.
    Relative,
    /// In the row's unit.
    Absolute,
    /// The computed value itself is bounded.
    AtMost,
    /// Not judged.
    Shown,
}

/// One value beside its exact one; a value that is no number is `null`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RowRecord {
    /// Name.
    pub quantity: String,
    /// Unit.
    pub unit: String,
    /// Value of the engine.
    pub computed: Option<f64>,
    /// Exact value.
    pub exact: Option<f64>,
    /// Relative error where the exact value is not zero, else the absolute one.
    pub error: Option<f64>,
    /// How the error is judged.
    pub judged: ToleranceKind,
    /// How far the values may be apart; absent where the row is not judged.
    pub tolerance: Option<f64>,
    /// Why this far.
    pub reason: String,
    /// `closed form`, `published: …` or `numerical: …`.
    pub origin: String,
    /// Whether the value is near enough.
    pub pass: bool,
}

impl RowRecord {
    /// The row as data.
    pub fn of(row: &Row) -> Self {
        let finite = |value: f64| Some(value).filter(|v| v.is_finite());
        let (judged, tolerance) = match row.tolerance {
            Tolerance::Relative(t) => (ToleranceKind::Relative, finite(t)),
            Tolerance::Absolute(t) => (ToleranceKind::Absolute, finite(t)),
            Tolerance::AtMost(t) => (ToleranceKind::AtMost, finite(t)),
            Tolerance::Shown => (ToleranceKind::Shown, None),
        };
        let origin = match row.origin {
            Origin::ClosedForm => "closed form".to_owned(),
            Origin::Published(by) => format!("published: {by}"),
            Origin::Numerical(by) => format!("numerical: {by}"),
        };
        Self {
            quantity: row.quantity.clone(),
            unit: row.unit.to_owned(),
            computed: finite(row.computed),
            exact: finite(row.exact),
            error: finite(row.error()),
            judged,
            tolerance,
            reason: row.reason.clone(),
            origin,
            pass: row.passes(),
        }
    }

    /// Error over tolerance; none where the row is not judged, infinite where the value is no number.
    pub fn share(&self) -> Option<f64> {
        let allowed = match (self.judged, self.tolerance) {
            (ToleranceKind::Shown, _) => return None,
            (ToleranceKind::Relative, Some(share)) => share * self.exact.unwrap_or_default().abs(),
            (_, Some(most)) => most,
            (_, None) => f64::INFINITY,
        };
        let (Some(computed), Some(exact)) = (self.computed, self.exact) else { return Some(f64::INFINITY) };
        let away = if self.judged == ToleranceKind::AtMost { computed.abs() } else { (computed - exact).abs() };
        Some(if away == 0.0 { 0.0 } else { away / allowed })
    }
}

impl ProblemRecord {
    /// A problem that was solved, as data.
    pub fn of(solved: &Solved) -> Self {
        let Problem { id, title, source, quick, parameters, .. } = solved.job.problem;
        let parameter = |p: &Parameter| ParameterRecord::of(p, solved.job.values.get(p.name));
        let nothing = Outcome::default();
        let (outcome, trouble) = match &solved.outcome {
            Ok(outcome) => (outcome, None),
            Err(trouble) => (&nothing, Some(trouble.to_string())),
        };
        let plots = outcome.plots.iter().enumerate();
        let integrator = match solved.job.integrator {
            Integrator::Explicit => "explicit",
            Integrator::Implicit => "implicit",
        };
        Self {
            id: (*id).to_owned(),
            title: (*title).to_owned(),
            source: (*source).to_owned(),
            quick: *quick,
            integrator: integrator.to_owned(),
            parameters: parameters.iter().map(parameter).collect(),
            rows: outcome.rows.iter().map(RowRecord::of).collect(),
            plots: plots.map(|(k, plot)| [plot.title.clone(), file_name(id, k)]).collect(),
            trouble,
            passed: solved.passes(),
            wall: Some(solved.wall.as_secs_f64()),
            quick_rows: Vec::new(),
        }
    }

    /// The row whose error is the largest part of its tolerance.
    pub fn worst(&self) -> Option<&RowRecord> {
        let judged = self.rows.iter().filter_map(|row| Some((row, row.share()?)));
        judged.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(row, _)| row)
    }

    /// Rows that miss their tolerance.
    pub fn missed(&self) -> impl Iterator<Item = &RowRecord> {
        self.rows.iter().filter(|row| !row.pass)
    }
}

impl Record {
    /// Problems that were solved, as data.
    pub fn of(solved: &[Solved]) -> Self {
        Self { passed: solved.iter().all(Solved::passes), problems: solved.iter().map(ProblemRecord::of).collect() }
    }

    /// The same without wall times, so that it does not change from run to run.
    pub fn without_wall(mut self) -> Self {
        self.problems.iter_mut().for_each(|problem| problem.wall = None);
        self
    }

    /// The problem of this ID.
    pub fn problem(&self, id: &str) -> Option<&ProblemRecord> {
        self.problems.iter().find(|problem| problem.id == id)
    }
}
