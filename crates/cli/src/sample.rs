//! `enmm sample`: the probability of failure of a case with random values. Every sample is worked out by a process of
//! its own, so that one that is lost ends no other.

use std::io::{BufRead, BufReader, Read};
use std::path::PathBuf;
use std::process::{Child, Command, ExitCode, ExitStatus, Stdio};
use std::thread;

use clap::Args;
use enmm::model::case::EnsembleOutput;
use enmm_ensemble::{Interval, Row, beta, medians};
use enmm_io::LoadedCase;
use enmm_run::{Answer, Ask, EnsembleError, EnsembleOptions, EnsembleResult, SearchOptions, answer, columns, ensemble};
use enmm_stability::strength_reduction::{Progress, Trial};
use serde_json::{Map, Value as Json, json};

use crate::case::CaseArguments;
use crate::fos::trial_line;
use crate::interrupt::{INTERRUPT, listen as listen_for_interrupts};
use crate::progress::Count;
use crate::run::{check_folder, directory_of, print_record, results_folder};
use crate::{BAD_INPUT, FAILED, Failure, INTERRUPTED, OrFail, Outcome, listed, print_line, tell_line};

/// Exit status of a panic.
const PANIC: i32 = 101;

/// Arguments of `enmm sample`.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// Number of samples; default: `ensemble.samples` of the case.
    #[arg(short = 'n', long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    samples: Option<u64>,
    /// Samples that are worked out at a time; default: one for each processor. Results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Directory for the results; default: the name of the case file, here.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// File that keeps every sample as soon as it is done; what is there is not worked out again. Default:
    /// ensemble.sqlite in the directory for the results.
    #[arg(long, value_name = "FILE")]
    store: Option<PathBuf>,
    /// Least F that trials of a factor of safety reach.
    #[arg(long)]
    low: Option<f64>,
    /// Greatest F that trials of a factor of safety reach.
    #[arg(long)]
    high: Option<f64>,
    /// Width of the final bracket of a factor of safety relative to F; default: that of `enmm fos`.
    #[arg(long)]
    tolerance: Option<f64>,
    /// Ignore mechanisms of less rock (m²).
    #[arg(long, value_name = "AREA")]
    least_area: Option<f64>,
    /// Replace results of another case in the directory.
    #[arg(long)]
    force: bool,
    /// Work out again the samples that have no answer.
    #[arg(long)]
    retry_failed: bool,
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
    #[arg(long, hide = true, value_name = "OUTPUT", value_parser = output)]
    output_of: Option<EnsembleOutput>,
}

impl Arguments {
    fn search(&self) -> SearchOptions {
        let Self { low, high, tolerance, least_area, .. } = *self;
        SearchOptions { low, high, tolerance, least_area }
    }
}

/// Works out an ensemble.
pub fn sample(arguments: &Arguments) -> Outcome {
    find(arguments).map_err(|failure| failure.json(arguments.json))
}

fn find(arguments: &Arguments) -> Outcome {
    // Options with which no search can be made are refused before any sample.
    arguments.search().fos().check().or_fail(BAD_INPUT)?;
    let loaded = load(arguments).or_fail(BAD_INPUT)?;
    if let Some(hash) = &arguments.sample_of {
        return Ok(work_out(arguments, &loaded, hash));
    }
    listen_for_interrupts()?;
    let program = std::env::current_exe();
    let program = program.map_err(|error| format!("cannot find this program again ({error})")).or_fail(FAILED)?;
    let directory = results_folder(arguments.output.as_ref(), directory_of(&arguments.case.path), arguments.force)?;
    check_folder(&directory, &loaded, arguments.force).or_fail(BAD_INPUT)?;
    let processors = || std::thread::available_parallelism().map_or(1, usize::from);
    let options = EnsembleOptions {
        store: arguments.store.clone().unwrap_or_else(|| directory.join(enmm_run::STORE)),
        directory,
        jobs: arguments.jobs.map_or_else(processors, usize::from),
        search: arguments.search(),
        retry_failed: arguments.retry_failed,
        interrupt: &INTERRUPT,
    };
    let screen = Count::new(arguments.json);
    let ask = |what: &Ask| ask(&mut command(&program, arguments, &loaded, what), what, &screen);
    let found = ensemble(&loaded, &options, ask, &mut |progress| screen.tell(progress));
    drop(screen);
    let found = found.map_err(|error| match error {
        EnsembleError::Case(_) => Failure::new(error, BAD_INPUT).on(&loaded),
        EnsembleError::NoAnswer { .. } => Failure::new(error, FAILED).on(&loaded),
        EnsembleError::Directory(_) => Failure::new(error, BAD_INPUT),
        EnsembleError::Interrupted { .. } => Failure::new(error, INTERRUPTED),
        _ => Failure::new(error, FAILED),
    })?;
    report(arguments, &found, &options)
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

/// The output of a sample by its name in a case.
fn output(name: &str) -> Result<EnsembleOutput, String> {
    serde_json::from_value(json!(name)).map_err(|error| error.to_string())
}

/// The call of this program that works out one sample.
fn command(program: &PathBuf, arguments: &Arguments, loaded: &LoadedCase, what: &Ask) -> Command {
    let mut command = Command::new(program);
    command.arg("sample").arg(&arguments.case.path).arg(format!("--sample-of={}", loaded.hash));
    command.arg(format!("--output-of={}", what.output.name()));
    command.args(loaded.settings.iter().map(|setting| format!("--set={setting}")));
    command.args(what.settings.iter().map(|value| format!("--value={value}")));
    let options = what.search.given();
    command.args(options.iter().map(|(name, value)| format!("--{}={value:?}", name.replace('_', "-"))));
    command.arg(crate::caller::OPTION).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Computes one sample in a process, and shows its trials; fails when the process was lost.
fn ask(command: &mut Command, what: &Ask, screen: &Count) -> Result<Answer, String> {
    let k = what.sample;
    let child = command.spawn().map_err(|error| format!("the process of sample {k} did not start: {error}"))?;
    let (status, found, told) = listen(child, |trial| screen.trial(k, trial)).map_err(|error| error.to_string())?;
    if let Some(found) = found {
        return Ok(read(&found, what.output));
    }
    let told = told.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    match status.code() {
        Some(PANIC) => {
            let message = format!("the engine failed: {told}");
            Ok(Answer::Done(Row { outputs: Vec::new(), message }))
        }
        // The case cannot be read any more.
        Some(status) if status == i32::from(BAD_INPUT) => Ok(Answer::Changed),
        _ => Err(format!("the process of sample {k} ended with {status}: {told}")),
    }
}

/// Reads what a process prints until it ends: its trials, its answer, and its messages.
fn listen(mut child: Child, mut hear: impl FnMut(&str)) -> std::io::Result<(ExitStatus, Option<Json>, String)> {
    // The child ends with this process, which alone has the other end of its standard input.
    let _alive = child.stdin.take();
    let (output, messages) = (child.stdout.take(), child.stderr.take());
    let reader = thread::spawn(move || {
        let mut bytes = Vec::new();
        messages.map(|mut messages| messages.read_to_end(&mut bytes));
        String::from_utf8_lossy(&bytes).into_owned()
    });
    let mut answer = None;
    for line in output.into_iter().flat_map(|output| BufReader::new(output).lines()) {
        match serde_json::from_str::<Json>(&line?) {
            Ok(found) if found["trial"].is_string() => hear(found["trial"].as_str().unwrap_or_default()),
            Ok(found) => answer = Some(found),
            Err(_) => {}
        }
    }
    let status = child.wait()?;
    Ok((status, answer.filter(|_| status.success()), reader.join().unwrap_or_default()))
}

fn read(found: &Json, wanted: EnsembleOutput) -> Answer {
    if found["changed"].is_string() {
        return Answer::Changed;
    }
    let output = |name: &&str| Some(((*name).to_owned(), found["outputs"].get(*name)?.clone()));
    let message = found["message"].as_str().unwrap_or_default().to_owned();
    Answer::Done(Row { outputs: columns(wanted).iter().filter_map(output).collect(), message })
}

/// Works out one sample in this process and prints its trials and its answer, a line each.
fn work_out(arguments: &Arguments, loaded: &LoadedCase, hash: &str) -> ExitCode {
    if loaded.hash != hash {
        print_line(&json!({ "changed": loaded.hash }).to_string());
        return ExitCode::SUCCESS;
    }
    let wanted = arguments.output_of.unwrap_or(loaded.case.ensemble.output);
    let mut hear = |trial: &Trial, progress: Progress| print_line(&trial_line(trial, progress));
    let row = match arguments.case.load_with(&arguments.value) {
        Ok(sample) => answer(&sample, wanted, &arguments.search(), &mut hear),
        Err(error) => Some(Row { outputs: Vec::new(), message: error.to_string() }),
    };
    let Some(row) = row else { return ExitCode::from(INTERRUPTED) };
    let outputs: Map<String, Json> = row.outputs.into_iter().collect();
    print_line(&json!({ "outputs": outputs, "message": row.message }).to_string());
    ExitCode::SUCCESS
}

fn report(arguments: &Arguments, found: &EnsembleResult, options: &EnsembleOptions) -> Outcome {
    if arguments.json {
        print_record(&options.directory, "ensemble.json")?;
        return Ok(ExitCode::SUCCESS);
    }
    print_line(&table(found, options));
    let n = found.rows.len();
    let named = |list: &[(usize, String)]| {
        let shown = list.iter().map(|(k, message)| format!("{k} ({message})")).collect::<Vec<_>>();
        listed(shown.into_iter())
    };
    let warnings = [
        (&found.failed, "samples have no answer and count neither as failed nor as stable slopes"),
        (&found.doubtful, "factors are above the bound of limit analysis"),
    ];
    for (list, what) in warnings.into_iter().filter(|(list, _)| !list.is_empty()) {
        tell_line(&format!("warning: {} of {n} {what}: {}", list.len(), named(list)));
    }
    Ok(ExitCode::SUCCESS)
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
