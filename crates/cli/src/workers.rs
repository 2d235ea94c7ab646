//! Workers: every sample of an ensemble or of a sweep is worked out by a process of its own, `enmm sample --sample-of`,
//! so that one that is lost ends no other.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, ExitStatus, Stdio};
use std::thread;

use clap::Args;
use enmm_ensemble::Row;
use enmm_io::LoadedCase;
use enmm_run::{Answer, Ask, EnsembleError, EnsembleOptions, EnsembleProgress, SampleOutput, SearchOptions, columns};
use serde_json::Value as Json;

use crate::case::CaseArguments;
use crate::interrupt::{INTERRUPT, listen as listen_for_interrupts};
use crate::progress::Count;
use crate::run::{check_folder, print_record};
use crate::{BAD_INPUT, FAILED, Failure, INTERRUPTED, OrFail, Outcome, listed, print_line, tell_line};

/// Exit status of a panic.
const PANIC: i32 = 101;

/// How samples are worked out and kept.
#[derive(Args)]
pub struct WorkArguments {
    /// Samples that are worked out at a time; default: one for each processor. Results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
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
    pub force: bool,
    /// Work out again the samples that have no answer.
    #[arg(long)]
    retry_failed: bool,
}

impl WorkArguments {
    /// Options of each search for a factor of safety.
    pub fn search(&self) -> SearchOptions {
        let Self { low, high, tolerance, least_area, .. } = *self;
        SearchOptions { low, high, tolerance, least_area }
    }
}

/// A case with the workers of its samples.
pub struct Workers<'a> {
    /// File and settings of the case.
    pub case: &'a CaseArguments,
    /// The case.
    pub loaded: &'a LoadedCase,
    /// How they work.
    pub work: &'a WorkArguments,
    /// Whether no progress is shown.
    pub quiet: bool,
}

/// Asks a worker for a sample.
type Worker<'a> = &'a (dyn Fn(&Ask) -> Result<Answer, String> + Sync);

impl Workers<'_> {
    /// Finds results in a folder by a function that asks workers, and hears of progress.
    ///
    /// # Errors
    /// Those of the function, with their exit status; a folder of another case.
    pub fn find<T>(
        &self,
        directory: PathBuf,
        find: impl FnOnce(&EnsembleOptions, Worker, &mut dyn FnMut(&EnsembleProgress)) -> Result<T, EnsembleError>,
    ) -> Result<(T, EnsembleOptions<'static>), Failure> {
        let Self { case, loaded, work, quiet } = *self;
        listen_for_interrupts()?;
        let program = std::env::current_exe();
        let program = program.map_err(|error| format!("cannot find this program again ({error})")).or_fail(FAILED)?;
        check_folder(&directory, loaded, work.force).or_fail(BAD_INPUT)?;
        let processors = || std::thread::available_parallelism().map_or(1, usize::from);
        let options = EnsembleOptions {
            store: work.store.clone().unwrap_or_else(|| directory.join(enmm_run::STORE)),
            directory,
            jobs: work.jobs.map_or_else(processors, usize::from),
            search: work.search(),
            retry_failed: work.retry_failed,
            interrupt: &INTERRUPT,
        };
        let screen = Count::new(quiet);
        let ask = |what: &Ask| ask(&mut command(&program, &case.path, loaded, what), what, &screen);
        let found = find(&options, &ask, &mut |progress| screen.tell(progress));
        drop(screen);
        let found = found.map_err(|error| match error {
            EnsembleError::Case(_) => Failure::new(error, BAD_INPUT).on(loaded),
            EnsembleError::NoAnswer { .. } => Failure::new(error, FAILED).on(loaded),
            EnsembleError::Directory(_) => Failure::new(error, BAD_INPUT),
            EnsembleError::Interrupted { .. } => Failure::new(error, INTERRUPTED),
            _ => Failure::new(error, FAILED),
        })?;
        Ok((found, options))
    }
}

/// Prints what a command found: its record as JSON, or a table, and warnings of samples without an answer.
///
/// # Errors
/// The record cannot be read again.
pub fn report(
    json: Option<(&Path, &str)>,
    table: impl FnOnce() -> String,
    n: usize,
    [failed, doubtful]: [&[(usize, String)]; 2],
) -> Outcome {
    if let Some((directory, name)) = json {
        print_record(directory, name)?;
        return Ok(ExitCode::SUCCESS);
    }
    print_line(&table());
    warn(n, failed, doubtful);
    Ok(ExitCode::SUCCESS)
}

/// Warns of samples without an answer and of factors above their bound.
fn warn(n: usize, failed: &[(usize, String)], doubtful: &[(usize, String)]) {
    let named = |list: &[(usize, String)]| {
        let shown = list.iter().map(|(k, message)| format!("{k} ({message})")).collect::<Vec<_>>();
        listed(shown.into_iter())
    };
    let warnings = [
        (failed, "samples have no answer and count neither as failed nor as stable slopes"),
        (doubtful, "factors are above the bound of limit analysis"),
    ];
    for (list, what) in warnings.into_iter().filter(|(list, _)| !list.is_empty()) {
        tell_line(&format!("warning: {} of {n} {what}: {}", list.len(), named(list)));
    }
}

/// The call of this program that works out one sample.
fn command(program: &Path, case: &Path, loaded: &LoadedCase, what: &Ask) -> Command {
    let mut command = Command::new(program);
    command.arg("sample").arg(case).arg(format!("--sample-of={}", loaded.hash));
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

fn read(found: &Json, wanted: SampleOutput) -> Answer {
    if found["changed"].is_string() {
        return Answer::Changed;
    }
    let output = |name: &&str| Some(((*name).to_owned(), found["outputs"].get(*name)?.clone()));
    let message = found["message"].as_str().unwrap_or_default().to_owned();
    Answer::Done(Row { outputs: columns(wanted).iter().filter_map(output).collect(), message })
}
