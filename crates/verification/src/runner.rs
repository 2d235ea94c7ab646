//! Solves problems, several at a time; one that fails or panics takes no other with it.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use enmm::model::case::Integrator;
use enmm_io::files::{at_path, write_atomic};

use crate::{Outcome, Problem, Setup, Trouble, Values};

/// A problem to be solved, and how.
#[derive(Clone)]
pub struct Job {
    /// The problem.
    pub problem: &'static Problem,
    /// Values of its parameters.
    pub values: Values,
    /// Time integration.
    pub integrator: Integrator,
    /// Whether fewer and coarser models will do.
    pub quick: bool,
}

/// A problem that has been solved, or was tried.
pub struct Solved {
    /// The job.
    pub job: Job,
    /// Rows and plots, or why there are none.
    pub outcome: Result<Outcome, Trouble>,
    /// Name and text of each case that was built.
    pub cases: Vec<(String, String)>,
    /// Wall time.
    pub wall: Duration,
}

impl Solved {
    /// Whether there are rows and all of them pass.
    pub fn passes(&self) -> bool {
        self.outcome.as_ref().is_ok_and(Outcome::passes)
    }
}

/// Solves one problem. A panic of it becomes its trouble; the cases built until then are kept.
pub fn solve(job: Job) -> Solved {
    let start = Instant::now();
    let Job { problem, integrator, quick, .. } = job;
    let mut setup = Setup { values: job.values.clone(), integrator, quick, cases: Vec::new() };
    let found = catch_unwind(AssertUnwindSafe(|| (problem.run)(&mut setup)));
    let outcome = found.unwrap_or_else(|payload| Err(Trouble(format!("panicked: {}", message(payload.as_ref())))));
    Solved { job, outcome, cases: setup.cases, wall: start.elapsed() }
}

/// Message of a panic.
fn message(payload: &(dyn Any + Send)) -> &str {
    let owned = payload.downcast_ref::<String>().map(String::as_str);
    owned.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("no message")
}

/// Solves problems, `threads` at a time, and returns them in the order of the jobs. Results do not depend on
/// `threads`. `done` is called with each with its place, in the order in which they end.
pub fn solve_all(jobs: Vec<Job>, threads: usize, done: impl Fn(usize, &Solved) + Sync) -> Vec<Solved> {
    let solved: Vec<Mutex<Option<Solved>>> = jobs.iter().map(|_| Mutex::new(None)).collect();
    let next = AtomicUsize::new(0);
    let work = || {
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = jobs.get(place).cloned() else { break };
            let found = solve(job);
            done(place, &found);
            *solved[place].lock().unwrap_or_else(|poison| poison.into_inner()) = Some(found);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.min(jobs.len()) {
            scope.spawn(work);
        }
        work();
    });
    solved.into_iter().filter_map(|cell| cell.into_inner().unwrap_or_else(|poison| poison.into_inner())).collect()
}

/// Writes the cases that a problem built into a folder of its own below `directory`; returns their paths.
///
/// # Errors
/// When the file system refuses it.
pub fn write_cases(solved: &Solved, directory: &Path) -> std::io::Result<Vec<PathBuf>> {
    let folder = directory.join(solved.job.problem.id.to_lowercase());
    std::fs::create_dir_all(&folder).map_err(at_path(&folder))?;
    let mut paths: Vec<PathBuf> = Vec::new();
    for (name, text) in &solved.cases {
        let stem = file_stem(name);
        let numbered = |k: usize| if k == 1 { format!("{stem}.toml") } else { format!("{stem}-{k}.toml") };
        let free = (1..).map(|k| folder.join(numbered(k))).find(|path| !paths.contains(path));
        let Some(path) = free else { continue };
        write_atomic(&path, with_integrator(text, solved.job.integrator).as_bytes())?;
        paths.push(path);
    }
    Ok(paths)
}

/// A name in letters, digits, `.`, `-` and `_`.
fn file_stem(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "._-".contains(c) { c } else { '_' };
    let stem: String = name.trim_end_matches(".toml").chars().map(plain).collect();
    if stem.trim_matches('.').is_empty() { "case".to_owned() } else { stem }
}

/// The text of a case that names the integrator that the problem was solved with.
fn with_integrator(text: &str, integrator: Integrator) -> String {
    let name = match integrator {
        Integrator::Explicit => return text.to_owned(),
        Integrator::Implicit => "implicit",
    };
    let lines = text.lines().filter(|line| line.split('=').next().is_none_or(|key| key.trim() != "integrator"));
    let text: String = lines.flat_map(|line| [line, "\n"]).collect();
    match text.find("[solver]\n") {
        Some(at) => {
            let (before, after) = text.split_at(at + "[solver]\n".len());
            format!("{before}integrator = \"{name}\"\n{after}")
        }
        None => format!("{text}[solver]\nintegrator = \"{name}\"\n"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integrator_stands_in_the_text_once() {
        let implicit = |text| with_integrator(text, Integrator::Implicit);
        assert_eq!(implicit("a = 1"), "a = 1\n[solver]\nintegrator = \"implicit\"\n");
        let given = "[solver]\nintegrator = \"explicit\"\ndt_max = 1\n[output]\n";
        assert_eq!(implicit(given), "[solver]\nintegrator = \"implicit\"\ndt_max = 1\n[output]\n");
        assert_eq!(with_integrator(given, Integrator::Explicit), given);
    }

    #[test]
    fn names_of_files_are_plain() {
        assert_eq!(file_stem("k = 0.2, φ/a"), "k___0.2__φ_a");
        assert_eq!(file_stem("../.."), ".._..");
        assert_eq!(file_stem(".."), "case");
    }
}
