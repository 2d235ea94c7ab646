//! Result of one sample.

use enmm::model::case::EnsembleOutput;
use enmm::model::case::Pictures;
use enmm_ensemble::Row;
use enmm_io::LoadedCase;
use enmm_stability::limit_analysis::{Collapse, Factor};
use enmm_stability::strength_reduction::{End, Progress, Trial};
use serde_json::{Value, json};

use super::SearchOptions;
use crate::fos::{FosError, Found, remedy, search};
use crate::run::{RunOptions, run};
use enmm_record::RunStatus;

/// Result that is worked out of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleOutput {
    /// One that an ensemble can have.
    Ensemble(EnsembleOutput),
    /// Largest displacement (m) in the last stage of a run, and whether the slope failed in any.
    Displacement,
}

impl From<EnsembleOutput> for SampleOutput {
    fn from(output: EnsembleOutput) -> Self {
        Self::Ensemble(output)
    }
}

impl SampleOutput {
    /// Its name in stores and records.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ensemble(output) => output.name(),
            Self::Displacement => DISPLACEMENT,
        }
    }

    /// The output of a name.
    pub fn of_name(name: &str) -> Result<Self, String> {
        if name == DISPLACEMENT {
            return Ok(Self::Displacement);
        }
        serde_json::from_value(json!(name)).map(Self::Ensemble).map_err(|error| error.to_string())
    }
}

/// Name of the output of runs.
const DISPLACEMENT: &str = "displacement";

/// Names of the outputs of a sample, in their order; the first decides whether it fails.
pub fn columns(output: impl Into<SampleOutput>) -> &'static [&'static str] {
    let output = match output.into() {
        SampleOutput::Ensemble(output) => output,
        SampleOutput::Displacement => return &[DISPLACEMENT, "status", "verdict"],
    };
    match output {
        EnsembleOutput::FactorOfSafety => {
            &["factor_of_safety", "stable", "unstable", "status", "failing_blocks", "failing_area", "doubt"]
        }
        EnsembleOutput::LevelTops => &["level_tops", "status"],
        EnsembleOutput::Associated => &["associated", "status"],
        EnsembleOutput::Failure => &["factor_estimate", "decided_by", "level_tops", "doubt"],
    }
}

/// Works out one output of a sample on this thread: `sample` is the case with its values, and `hear` is called with
/// each trial. None when the search was interrupted.
///
/// Whether a sample fails is no output of one: it follows from several (see `screen.rs`).
pub fn answer(
    sample: &LoadedCase,
    output: SampleOutput,
    options: &SearchOptions,
    hear: &mut (dyn FnMut(&Trial, Progress) + Send),
) -> Option<Row> {
    let found = match output {
        SampleOutput::Displacement => displacement(sample),
        SampleOutput::Ensemble(EnsembleOutput::FactorOfSafety) => factor(sample, options, hear)?,
        SampleOutput::Ensemble(EnsembleOutput::Failure) => {
            Err("whether a sample fails is found by its bound and its trials".to_owned())
        }
        SampleOutput::Ensemble(EnsembleOutput::LevelTops) => bound(sample, |bound| &bound.level_tops),
        SampleOutput::Ensemble(EnsembleOutput::Associated) => bound(sample, |bound| &bound.associated),
    };
    let names = columns(output).iter().map(|name| (*name).to_owned());
    Some(match found {
        Ok(values) => Row { outputs: names.zip(values).collect(), message: String::new() },
        Err(message) => Row { outputs: Vec::new(), message },
    })
}

/// Status of a run whose slope failed.
pub const FAILS: &str = "fails";
/// Status of a run that did not fail and did not come to rest.
pub const NO_VERDICT: &str = "no_verdict";

type Values = Result<Vec<Value>, String>;

fn bound(sample: &LoadedCase, of: fn(&enmm_stability::limit_analysis::Bound) -> &Collapse) -> Values {
    let bound = crate::bound::bounds(sample).map_err(|error| error.to_string())?;
    let (limit, end) = match of(&bound).factor {
        Factor::Found(factor) => (factor, "found"),
        Factor::AtLeast(least) => (least, "at_least"),
        Factor::AtMost(most) => (most, "at_most"),
    };
    Ok(vec![json!(limit), json!(end)])
}

/// The displacement of the last stage of a run, whose other results are dropped.
fn displacement(sample: &LoadedCase) -> Values {
    let mut sample = sample.clone();
    sample.case.output.pictures = Pictures::Usual(false);
    sample.case.output.frames = false;
    let directory = tempfile::tempdir().map_err(|error| format!("no folder for the run ({error})"))?;
    let options =
        RunOptions { directory: directory.path().to_owned(), resume: None, threads: Some(1), interrupt: None };
    let summary = run(&sample, &options, &mut ()).map_err(|error| error.to_string())?;
    let last = summary.stages.last().map(|stage| stage.displacement);
    let displacement = last.filter(|_| summary.status == RunStatus::Finished && summary.doubt.is_none());
    let displacement = displacement.ok_or_else(|| summary.doubt.clone().unwrap_or_else(|| summary.verdict.clone()))?;
    let is_restless = summary.stages.iter().any(|stage| stage.converged == Some(false));
    let status = match (summary.failed, is_restless) {
        (true, _) => FAILS,
        (false, true) => NO_VERDICT,
        (false, false) => "stands",
    };
    Ok(vec![json!(displacement), json!(status), json!(summary.verdict)])
}

fn factor(
    sample: &LoadedCase,
    options: &SearchOptions,
    hear: &mut (dyn FnMut(&Trial, Progress) + Send),
) -> Option<Values> {
    match search(sample, &options.fos(), hear) {
        Ok(found) => Some(values(&found)),
        Err(FosError::Interrupted) => None,
        Err(error) => Some(Err(error.to_string())),
    }
}

/// Factor and what fails. A factor beyond the search is its limit, with the status that says so, and one above an upper
/// bound is that bound.
fn values(found: &Found) -> Values {
    let main = found.main();
    let status = main.end.name();
    let factor = main.at_most().or(main.factor()).or(main.at_least()).or(main.high);
    let Some(factor) = factor.filter(|_| !matches!(main.end, End::Failed(_) | End::Interrupted)) else {
        let remedy = remedy(main).unwrap_or_default();
        return Err(format!("the search for the factor of safety ended {status}: {remedy}"));
    };
    let failing = main.first_unstable();
    Ok(vec![
        json!(factor),
        json!(main.low),
        json!(main.high),
        json!(status),
        json!(failing.map_or(0, |trial| trial.failing.len())),
        json!(failing.map_or(0.0, |trial| trial.failing_area())),
        json!(main.doubt().unwrap_or_default()),
    ])
}
