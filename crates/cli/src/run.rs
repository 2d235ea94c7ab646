//! `enmm run`: runs a case and reports where the results are.

use enmm::model::case::keys::rounded;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use enmm::model::case::Pictures;
use enmm_io::LoadedCase;
use enmm_report::PAGE;
use enmm_run::summary::OVER;
use enmm_run::{RunError, RunOptions, RunStatus, Summary};

use crate::case::CaseArguments;
use crate::interrupt::{INTERRUPT, listen};
use crate::progress::Screen;
use crate::{BAD_INPUT, FAILED, Failure, INTERRUPTED, OrFail, Outcome, SLOPE_FAILED, fail, print_line, tell_line};

/// Arguments of `enmm run`.
#[derive(Args)]
#[command(after_help = "Example: enmm run slope.toml -o results --threads 2")]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// Directory for the results; default: the name of the case file, here.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Threads; default: as many as make steps shorter. Results do not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Checkpoint to continue from.
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// Replace results of another case in the directory.
    #[arg(long)]
    force: bool,
    /// Draw no pictures, whatever the case says.
    #[arg(long)]
    no_pictures: bool,
    /// Print nothing but errors.
    #[arg(long)]
    quiet: bool,
}

/// Runs a case.
pub fn run(arguments: &Arguments) -> Outcome {
    let mut loaded = arguments.case.load().or_fail(BAD_INPUT)?;
    if arguments.no_pictures {
        loaded.case.output.pictures = Pictures::Usual(false);
    }
    listen()?;
    let options = RunOptions {
        directory: results_folder(arguments.output.as_ref(), directory_of(&arguments.case.path), arguments.force)?,
        resume: arguments.resume.clone(),
        threads: arguments.threads.map(usize::from),
        interrupt: Some(&INTERRUPT),
    };
    check_folder(&options.directory, &loaded, arguments.force).or_fail(BAD_INPUT)?;
    let mut screen = Screen::new(arguments.quiet);
    let outcome = enmm_run::run(&loaded, &options, &mut screen);
    drop(screen);
    let summary = outcome.map_err(|error| match error {
        RunError::Output(_) | RunError::OutputAfter { .. } => Failure::new(error, FAILED),
        RunError::Case(_) => Failure::new(error, BAD_INPUT).on(&loaded),
        _ => Failure::new(error, BAD_INPUT),
    })?;
    Ok(report(&summary, &options.directory, arguments.quiet))
}

/// Refuses a folder with results of another case, unless they may be replaced.
///
/// # Errors
/// The other case, and the remedy.
pub fn check_folder(directory: &Path, loaded: &LoadedCase, force: bool) -> std::io::Result<()> {
    if force { Ok(()) } else { enmm_run::check_owner(directory, loaded.source.file()) }
}

/// The folder for results: the one that the user names, or a default one. A link in the place of that, which may have
/// come with the case, would lead the results out of this folder.
pub fn results_folder(named: Option<&PathBuf>, default: PathBuf, force: bool) -> Result<PathBuf, Failure> {
    if let Some(named) = named {
        return Ok(named.clone());
    }
    match default.ancestors().find(|path| path.is_symlink()).filter(|_| !force) {
        None => Ok(default),
        Some(link) => {
            let (link, default) = (link.display(), default.display());
            let message = format!("{link}: is a link; to write results through it give -o {default} or --force");
            Err(Failure::new(message, BAD_INPUT))
        }
    }
}

/// Prints a record that was written into the folder of the results.
pub fn print_record(directory: &Path, name: &str) -> Result<(), Failure> {
    let text = std::fs::read_to_string(directory.join(name));
    print_line(text.map_err(|error| format!("cannot read {name} again ({error})")).or_fail(FAILED)?.trim_end());
    Ok(())
}

/// The name of the case file without its extension, in the current directory.
pub fn directory_of(case: &Path) -> PathBuf {
    let stem = case.file_stem().unwrap_or_default();
    let directory = PathBuf::from(stem);
    if directory.exists() && !directory.is_dir() {
        PathBuf::from(format!("{}-results", directory.display()))
    } else {
        directory
    }
}

/// Where a command puts its results beside those of a run, such as `plane_slide/fos`: no page replaces another.
pub fn directory_for(case: &Path, command: &str) -> PathBuf {
    directory_of(case).join(command)
}

fn report(summary: &Summary, directory: &Path, quiet: bool) -> ExitCode {
    let checkpoint = directory.join("checkpoint.enmm");
    if !quiet {
        print_line(&table(summary, directory));
    }
    match (summary.status, &summary.failure) {
        (RunStatus::Finished, _) => match &summary.doubt {
            Some(doubt) => fail(doubt, FAILED),
            None if summary.failed_at_rest() => {
                if quiet {
                    tell_line(&summary.verdict);
                }
                ExitCode::from(SLOPE_FAILED)
            }
            None => ExitCode::SUCCESS,
        },
        (RunStatus::Interrupted, _) => {
            let place = checkpoint.display();
            fail(
                &format!("interrupted at t = {} s; continue with --resume {place}", rounded(summary.time)),
                INTERRUPTED,
            )
        }
        (RunStatus::Failed, failure) => {
            let cause = failure.as_ref().map_or_else(String::new, |failure| {
                let [x, y] = failure.place;
                format!(
                    "block {} at ({x:.3}, {y:.3}) m, t = {} s: {}",
                    failure.block,
                    rounded(failure.time),
                    failure.cause
                )
            });
            let (time, place) = (rounded(summary.time), checkpoint.display());
            fail(&format!("{cause}; the last good state, t = {time} s, is in {place}"), FAILED)
        }
    }
}

/// Blocks that have broken which are named.
const BREAKS: usize = 5;

fn table(summary: &Summary, directory: &Path) -> String {
    let mut lines = vec![String::new()];
    let mut row = |name: &str, value: String| lines.push(format!("{name:<20} {value}"));
    row("verdict", summary.verdict.clone());
    row("results", directory.display().to_string());
    row("page to open", directory.join(PAGE).display().to_string());
    row("simulated time", format!("{} s in {} steps", rounded(summary.time), summary.steps));
    for stage in &summary.stages {
        let outcome = stage.outcome();
        let end = if outcome == OVER { String::new() } else { format!(", {outcome}") };
        row(&format!("stage {}", stage.name), format!("{} s, {} steps{end}", rounded(stage.time), stage.steps));
    }
    for of in summary.breaks.iter().take(BREAKS) {
        let [[x0, y0], [x1, y1]] = of.section.ends;
        let value = format!(
            "from ({x0:.2}, {y0:.2}) to ({x1:.2}, {y1:.2}) m after {} s, {}; block {} parts off",
            rounded(of.time),
            of.section.how(),
            of.part
        );
        row(&format!("block {} broke", of.section.block), value);
    }
    if summary.breaks.len() > BREAKS {
        row("", format!("and {} more blocks: see summary.json", summary.breaks.len() - BREAKS));
    }
    if let Some(worst) = summary.worst_sections.first() {
        let [[x0, y0], [x1, y1]] = worst.ends;
        let value = format!(
            "block {}: from ({x0:.2}, {y0:.2}) to ({x1:.2}, {y1:.2}) m at {:.2} of the strength of the rock, {}",
            worst.block,
            worst.share,
            worst.how()
        );
        row("nearest to breaking", value);
    }
    let open_close = &summary.open_close;
    row(
        "open–close sweeps",
        format!("{:.2} mean, {} most, {} steps unsettled", open_close.mean, open_close.max, open_close.unsettled),
    );
    row(
        "largest penetration",
        format!(
            "{:.3e} m, {:.3} % of the mesh size",
            summary.penetration_max,
            100.0 * summary.penetration_max_relative
        ),
    );
    row("energy residual", format!("{:.2e} of the largest term", summary.energy.residual_relative()));
    row("wall time", format!("{:.1} s", summary.wall_seconds.total));
    lines.join("\n")
}
