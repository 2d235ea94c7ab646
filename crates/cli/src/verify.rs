//! `enmm verify`: runs the verification problems and prints computed beside exact values.
//!
//! Exit status: 0 all pass, 1 one does not, 2 bad arguments.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;

use clap::{Args, ValueEnum};
use enmm::model::case;
use enmm_run::make_place;
use enmm_verification::{
    Parameter, Problem, ProblemRecord, Record, Request, Solved, choose, problems, report, solve_all, text, write_cases,
};
use serde_json::json;

use crate::{BAD_INPUT, FAILED, OrFail, Outcome, print_line};

/// A problem does not pass.
const MISSED: u8 = 1;
/// Problems that are solved at a time.
const THREADS: usize = 2;

/// Arguments of `enmm verify`.
#[derive(Args)]
pub struct Arguments {
    /// Problems by ID, or all whose IDs begin so: C6, or B for B1, B2, …
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    only: Vec<String>,
    /// Only the quick problems, with fewer and coarser models.
    #[arg(long)]
    quick: bool,
    /// Gives a parameter another value; without --only the problems that have it are run.
    #[arg(long, value_name = "[ID.]NAME=VALUE")]
    set: Vec<String>,
    /// Time integration.
    #[arg(long, value_enum)]
    integrator: Option<Integrator>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Print problems and parameters; run nothing.
    #[arg(long)]
    list: bool,
    /// Also write the case files that the problems build, each problem's into a folder of its own.
    #[arg(long, value_name = "DIR")]
    write: Option<PathBuf>,
    /// Also write the report there: verification.md, verification.json and plots.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Integrator {
    Explicit,
    Implicit,
}

impl Arguments {
    fn request(&self) -> Request {
        let integrator = self.integrator.map(|integrator| match integrator {
            Integrator::Explicit => case::Integrator::Explicit,
            Integrator::Implicit => case::Integrator::Implicit,
        });
        Request { only: self.only.clone(), set: self.set.clone(), integrator, quick: self.quick }
    }
}

/// Runs the chosen problems, two at a time, and prints their tables in the order of the manual.
pub fn verify(arguments: &Arguments) -> Outcome {
    let jobs = choose(problems::ALL, &arguments.request()).or_fail(BAD_INPUT)?;
    if arguments.list {
        print_line(&list(&jobs.iter().map(|job| job.problem).collect::<Vec<_>>(), arguments.json));
        return Ok(ExitCode::SUCCESS);
    }
    let places = [(&arguments.write, &[][..]), (&arguments.output, &[report::DOCUMENT, report::RECORD][..])];
    for (directory, files) in places.into_iter().filter_map(|(place, files)| Some((place.as_ref()?, files))) {
        make_place(directory, files).or_fail(BAD_INPUT)?;
    }
    if let Some(directory) = &arguments.output {
        make_place(&directory.join(report::PLOTS), &[]).or_fail(BAD_INPUT)?;
    }
    let tables = InOrder::default();
    let solved = solve_all(jobs, THREADS, |place, solved| {
        if !arguments.json {
            tables.take(place, text::table(&ProblemRecord::of(solved)));
        }
    });
    let record = Record::of(&solved);
    print_line(&if arguments.json { report::json(&record).trim_end().to_owned() } else { closing_line(&record) });
    write(arguments, &record, &solved).or_fail(FAILED)?;
    Ok(if record.passed { ExitCode::SUCCESS } else { ExitCode::from(MISSED) })
}

/// Prints what comes in any order by its places, as soon as all before it are there.
#[derive(Default)]
struct InOrder(Mutex<(usize, BTreeMap<usize, String>)>);

impl InOrder {
    fn take(&self, place: usize, text: String) {
        let mut waiting = self.0.lock().unwrap_or_else(|poison| poison.into_inner());
        waiting.1.insert(place, text);
        loop {
            let next = waiting.0;
            let Some(text) = waiting.1.remove(&next) else { break };
            print_line(&format!("{text}\n"));
            waiting.0 += 1;
        }
    }
}

fn write(arguments: &Arguments, record: &Record, solved: &[Solved]) -> std::io::Result<()> {
    let tell = |what: &str, directory: &Path| {
        if !arguments.json {
            print_line(&format!("{what}: {}", directory.display()));
        }
    };
    if let Some(directory) = &arguments.write {
        for solved in solved {
            write_cases(solved, directory)?;
        }
        tell("cases", directory);
    }
    if let Some(directory) = &arguments.output {
        report::write(&record.clone().without_wall(), solved, directory)?;
        tell("report", &directory.join(report::DOCUMENT));
    }
    Ok(())
}

fn closing_line(record: &Record) -> String {
    let failed: Vec<&str> = record.problems.iter().filter(|p| !p.passed).map(|p| p.id.as_str()).collect();
    let passed = record.problems.len() - failed.len();
    let names = if failed.is_empty() { String::new() } else { format!(": {}", failed.join(", ")) };
    format!("{passed} passed, {} failed{names}", failed.len())
}

fn list(problems: &[&Problem], json: bool) -> String {
    if json {
        let one = |p: &&Problem| {
            let parameter = |parameter: &Parameter| {
                let Parameter { name, unit, default, range, doc } = parameter;
                json!({ "name": name, "unit": unit, "default": default, "range": range, "doc": doc })
            };
            let parameters: Vec<_> = p.parameters.iter().map(parameter).collect();
            json!({ "id": p.id, "title": p.title, "source": p.source, "quick": p.quick,
                                "implicit": p.implicit, "parameters": parameters })
        };
        return format!("{:#}", json!({ "problems": problems.iter().map(one).collect::<Vec<_>>() }));
    }
    let mut lines = Vec::new();
    for problem in problems {
        let marks = [(problem.quick, "quick"), (problem.implicit, "implicit too")];
        let marks: Vec<&str> = marks.iter().filter(|(is, _)| *is).map(|(_, mark)| *mark).collect();
        let marks = if marks.is_empty() { String::new() } else { format!(" ({})", marks.join(", ")) };
        lines.push(format!("{:<4} {}{marks}", problem.id, problem.title));
        lines.extend(problem.parameters.iter().map(parameter_line));
    }
    lines.join("\n")
}

fn parameter_line(p: &Parameter) -> String {
    let [low, high] = p.range.map(|limit| text::number(limit, 7));
    let value = text::quantity(Some(p.default), p.unit);
    format!("       {:<12} {value:<14} from {low} to {high}: {}", p.name, p.doc)
}
