//! Result of one sample.

use enmm::model::case::EnsembleOutput;
use enmm_ensemble::Row;
use enmm_io::LoadedCase;
use enmm_stability::limit_analysis::{Collapse, Factor};
use enmm_stability::strength_reduction::{End, Progress, Trial};
use serde_json::{Value, json};

use super::SearchOptions;
use crate::fos::{FosError, Found, end_name, remedy, search};

/// Names of the outputs of a sample, in their order; the first decides whether it fails.
pub fn columns(output: EnsembleOutput) -> &'static [&'static str] {
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
    output: EnsembleOutput,
    options: &SearchOptions,
    hear: &mut (dyn FnMut(&Trial, Progress) + Send),
) -> Option<Row> {
    let found = match output {
        EnsembleOutput::FactorOfSafety => factor(sample, options, hear)?,
        EnsembleOutput::Failure => Err("whether a sample fails is found by its bound and its trials".to_owned()),
        EnsembleOutput::LevelTops => bound(sample, |bound| &bound.level_tops),
        EnsembleOutput::Associated => bound(sample, |bound| &bound.associated),
    };
    let names = columns(output).iter().map(|name| (*name).to_owned());
    Some(match found {
        Ok(values) => Row { outputs: names.zip(values).collect(), message: String::new() },
        Err(message) => Row { outputs: Vec::new(), message },
    })
}

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
    let status = end_name(&main.end);
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
