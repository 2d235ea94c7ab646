//! `enmm sample`: the probability of failure of a case with random values.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use enmm_ensemble::{Interval, Row, beta, medians};
use enmm_io::LoadedCase;
use enmm_run::{EnsembleOptions, EnsembleResult, SampleOutput, answer, columns, ensemble};
use enmm_stability::strength_reduction::{Progress, Trial};
use serde_json::{Map, Value as Json, json};

use crate::case::CaseArguments;
use crate::fos::trial_line;
use crate::run::{directory_of, results_folder};
use crate::workers::{WorkArguments, Workers, report};
use crate::{BAD_INPUT, INTERRUPTED, OrFail, Outcome, print_line};

/// Arguments of `enmm sample`.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// Number of samples; default: `ensemble.samples` of the case.
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    samples: Option<u64>,
    /// Directory for the results; default: the name of the case file, here.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    work: WorkArguments,
    /// Print one JSON object, that of ensemble.json.
    #[arg(long)]
    json: bool,
    /// Works out one sample of the case with this fingerprint and prints its answer; how the program calls itself.
    #[arg(long, hide = true, value_name = "HASH")]
    sample_of: Option<String>,
    /// A value of that sample.
    #[arg(long, hide = true, value_name = "KEY=VALUE")]
    value: Vec<String>,
    /// Output to work out of it; default: that of the case.
    #[arg(long, hide = true, value_name = "OUTPUT", value_parser = SampleOutput::of_name)]
    output_of: Option<SampleOutput>,
}

/// Works out an ensemble.
pub fn sample(arguments: &Arguments) -> Outcome {
    find(arguments).map_err(|failure| failure.json(arguments.json))
}

fn find(arguments: &Arguments) -> Outcome {
    // Options with which no search can be made are refused before any sample.
    let work = &arguments.work;
    work.search().fos().check().or_fail(BAD_INPUT)?;
    let loaded = load(arguments).or_fail(BAD_INPUT)?;
    if let Some(hash) = &arguments.sample_of {
        return Ok(work_out(arguments, &loaded, hash));
    }
    let directory = results_folder(arguments.output.as_ref(), directory_of(&arguments.case.path), work.force)?;
    let workers = Workers { case: &arguments.case, loaded: &loaded, work, quiet: arguments.json };
    let (found, options) = workers.find(directory, |options, ask, hear| ensemble(&loaded, options, ask, hear))?;
    let json = arguments.json.then_some((&*options.directory, "ensemble.json"));
    report(json, || table(&found, &options), found.rows.len(), [&found.failed, &found.doubtful])
}

/// The case; of an ensemble with a look at the middle of its random values, so that wrong keys are found at once.
fn load(arguments: &Arguments) -> Result<LoadedCase, enmm_io::CaseError> {
    let mut loaded = arguments.case.load()?;
    if let Some(n) = arguments.samples {
        loaded.case.ensemble.samples = n;
    }
    if arguments.sample_of.is_none() {
        let medians = medians(&loaded.case);
        let medians = medians.map_err(|invalid| loaded.source.locate(&invalid.key, &invalid.message))?;
        arguments.case.load_with(&medians)?;
    }
    Ok(loaded)
}

/// Works out one sample in this process and prints its trials and its answer, a line each.
fn work_out(arguments: &Arguments, loaded: &LoadedCase, hash: &str) -> ExitCode {
    if loaded.hash != hash {
        print_line(&json!({ "changed": loaded.hash }).to_string());
        return ExitCode::SUCCESS;
    }
    let wanted = arguments.output_of.unwrap_or(loaded.case.ensemble.output.into());
    let mut hear = |trial: &Trial, progress: Progress| print_line(&trial_line(trial, progress));
    let row = match arguments.case.load_with(&arguments.value) {
        Ok(sample) => answer(&sample, wanted, &arguments.work.search(), &mut hear),
        Err(error) => Some(Row { outputs: Vec::new(), message: error.to_string() }),
    };
    let Some(row) = row else { return ExitCode::from(INTERRUPTED) };
    let outputs: Map<String, Json> = row.outputs.into_iter().collect();
    print_line(&json!({ "outputs": outputs, "message": row.message }).to_string());
    ExitCode::SUCCESS
}

/// Results, as lines of a name and a text.
fn table(found: &EnsembleResult, options: &EnsembleOptions) -> String {
    let mut lines = Vec::new();
    let mut tell = |name: &str, text: String| lines.push(format!("{name:<23} {text}"));
    let of = &found.ensemble;
    let sampling = of.sampling.name().replace('_', " ");
    let asked = if (found.rows.len() as u64) < of.samples { format!(" of {}", of.samples) } else { String::new() };
    tell("samples", format!("{}{asked} by {sampling}, seed {}", found.rows.len(), of.seed));
    tell("below the limit", format!("{} below {}", found.failures(), of.limit));
    let (p, Interval { low, high }) = (found.probability_of_failure(), found.interval());
    tell("probability of failure", format!("{p:.4}, 95 % (Wilson): {low:.4} to {high:.4}"));
    tell("reliability index", format!("{:.3}, 95 %: {:.3} to {:.3}", beta(p), beta(high), beta(low)));
    let quantiles = found.quantiles().map(|(share, output)| format!("{output:.4} ({:.0} %)", 100.0 * share));
    let name = columns(of.output)[0].replace('_', " ");
    tell(&name, format!("mean {:.4}, quantiles {}", found.mean(), quantiles.join(", ")));
    if let Some(text) = found.decided() {
        tell("decided", text);
    }
    for (key, correlation) in found.sensitivity() {
        let text = correlation.map_or("none".to_owned(), |correlation| format!("{correlation:.3}"));
        tell("rank correlation", format!("{text} of {key}"));
    }
    tell("store", options.store.display().to_string());
    tell("results", options.directory.display().to_string());
    lines.join("\n")
}
