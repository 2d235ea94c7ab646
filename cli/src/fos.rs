//! `enmm fos`: finds the factor of safety of a case by strength reduction.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use enmm::io::fos::remedy;
use enmm::io::{FosError, FosOptions};
use enmm::model::strength_reduction::{End, Reduction, TOLERANCE, Trial};

use crate::run::{INTERRUPT, directory_of, interrupt};
use crate::{BAD_INPUT, FAILED, INTERRUPTED, fail, print_line};

/// Arguments of `enmm fos`.
#[derive(Args)]
pub struct Arguments {
    /// Case file (TOML); the static stages that it begins with bring the slope to rest.
    case: PathBuf,
    /// Directory for the results; default: the name of the case file, here.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Least F that is tried, and the first.
    #[arg(long)]
    low: Option<f64>,
    /// Greatest F that is tried, and the second.
    #[arg(long)]
    high: Option<f64>,
    /// Width of the final bracket relative to F.
    #[arg(long, default_value_t = TOLERANCE)]
    tolerance: f64,
    /// Threads; default: all. Results do not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print one JSON object, that of fos.json.
    #[arg(long)]
    json: bool,
}

/// Heads the columns of [`row`].
const HEAD: &str = "         F  verdict   by            time (s)  displacement (m)  speed (m/s)  kinetic (J/m)  \
                    failing    steps  wall (s)";

/// Finds the factor of safety of a case.
pub fn fos(arguments: &Arguments) -> ExitCode {
    let options = FosOptions {
        directory: arguments.output.clone().unwrap_or_else(|| directory_of(&arguments.case)),
        low: arguments.low,
        high: arguments.high,
        tolerance: arguments.tolerance,
        threads: arguments.threads.map(usize::from),
        interrupt: Some(&INTERRUPT),
    };
    if let Err(message) = options.check() {
        return refuse(arguments, &message, BAD_INPUT);
    }
    let loaded = match enmm::io::load_case(&arguments.case) {
        Ok(loaded) => loaded,
        Err(error) => return refuse(arguments, &error, BAD_INPUT),
    };
    if let Err(error) = ctrlc::set_handler(interrupt) {
        return refuse(arguments, &format!("cannot listen for interrupts ({error})"), FAILED);
    }
    let mut begun = false;
    let mut hear = |trial: &Trial| {
        if !arguments.json {
            if !begun {
                print_line(HEAD);
            }
            begun = true;
            print_line(&row(trial));
        }
    };
    match enmm::io::fos(&loaded, &options, &mut hear) {
        Ok(reduction) => report(arguments, &reduction, &options.directory),
        Err(error @ (FosError::NoRest(_) | FosError::Output(_))) => refuse(arguments, &error, FAILED),
        Err(error @ FosError::Interrupted) => refuse(arguments, &error, INTERRUPTED),
        Err(error) => refuse(arguments, &error, BAD_INPUT),
    }
}

fn refuse(arguments: &Arguments, message: &impl std::fmt::Display, status: u8) -> ExitCode {
    if arguments.json {
        print_line(&serde_json::json!({ "error": message.to_string() }).to_string());
    }
    fail(message, status)
}

fn row(t: &Trial) -> String {
    format!(
        "{:10.5}  {:<8}  {:<12}  {:8.3}  {:16.3e}  {:11.3e}  {:13.3e}  {:7}  {:7}  {:8.2}",
        t.factor,
        t.verdict.name(),
        t.reason.name(),
        t.time,
        t.displacement,
        t.speed,
        t.kinetic,
        t.failing.len(),
        t.steps,
        t.wall
    )
}

fn report(arguments: &Arguments, reduction: &Reduction, directory: &Path) -> ExitCode {
    if arguments.json {
        match std::fs::read_to_string(directory.join("fos.json")) {
            Ok(text) => print_line(text.trim_end()),
            Err(error) => return refuse(arguments, &format!("cannot read fos.json again ({error})"), FAILED),
        }
    } else {
        print_line(&result(reduction, directory));
    }
    let message = remedy(reduction).unwrap_or_default();
    match reduction.end {
        End::Found => ExitCode::SUCCESS,
        End::Interrupted => fail(&message, INTERRUPTED),
        End::StableThroughout | End::UnstableThroughout | End::Failed(_) => fail(&message, FAILED),
    }
}

fn result(reduction: &Reduction, directory: &Path) -> String {
    let mut lines = vec![String::new()];
    if let (Some(factor), Some(low), Some(high)) = (reduction.factor(), reduction.low, reduction.high) {
        lines.push(format!("factor of safety     {factor:.4} (stable at {low:.4}, unstable at {high:.4})"));
    }
    if let Some(trial) = reduction.first_unstable() {
        let blocks = trial.failing.iter().take(8);
        let names: Vec<String> =
            blocks.map(|b| format!("{} at ({:.2}, {:.2}) m", b.block, b.place.x, b.place.y)).collect();
        let more = trial.failing.len().saturating_sub(8);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        lines.push(format!("failing blocks       {}{more}", names.join(", ")));
    }
    lines.push(format!("results              {}", directory.display()));
    lines.extend(reduction.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.join("\n")
}
