//! Solves all problems, two at a time, and writes the manual into a directory (default: `docs/`).
//!
//! Exit status: 1 when a value is missed that the report so far does not state as missed, 2 when it cannot be written.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use enmm_verification::{Record, Request, Solved, Trouble, choose, problems, report, solve_all};

fn main() -> ExitCode {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let directory = std::env::args_os().nth(1).map_or_else(default, PathBuf::from);
    match write(&directory) {
        Ok(misses) if misses.is_empty() => ExitCode::SUCCESS,
        Ok(misses) => {
            misses.iter().for_each(|miss| say(&format!("newly missed: {miss}")));
            ExitCode::FAILURE
        }
        Err(Trouble(message)) => {
            say(&format!("error: {message}"));
            ExitCode::from(2)
        }
    }
}

/// Writes the report; returns what it misses and the one before did not.
fn write(directory: &Path) -> Result<Vec<String>, Trouble> {
    let before = report::read(directory)?.unwrap_or_default();
    let solved = run(false)?;
    let quick = Record::of(&run(true)?);
    let mut record = Record::of(&solved).without_wall();
    for problem in &mut record.problems {
        problem.quick_rows = quick.problem(&problem.id).map(|quick| quick.rows.clone()).unwrap_or_default();
    }
    let paths = report::write(&record, &solved, directory)?;
    report::remove_stale_plots(&record, directory)?;
    say(&format!("wrote {} files into {}", paths.len(), directory.display()));
    let quick: Vec<String> =
        report::new_misses(&quick, &record).into_iter().map(|m| format!("quick form: {m}")).collect();
    Ok(report::new_misses(&record, &before).into_iter().chain(quick).collect())
}

fn run(quick: bool) -> Result<Vec<Solved>, Trouble> {
    let jobs = choose(problems::ALL, &Request { quick, ..Request::default() })?;
    let start = std::time::Instant::now();
    let tell = |_: usize, solved: &Solved| {
        let verdict = if solved.passes() { "pass" } else { "MISSED" };
        say(&format!("{:>4} {verdict:<6} {:>7.2} s", solved.job.problem.id, solved.wall.as_secs_f64()));
    };
    let solved = solve_all(jobs, 2, tell);
    say(&format!("{} set: {:.1} s", if quick { "quick" } else { "full" }, start.elapsed().as_secs_f64()));
    Ok(solved)
}

/// A line for the person who waits; a reader that has gone away ends it quietly.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
