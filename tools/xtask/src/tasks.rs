//! The tasks, each a list of steps.

use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use crate::bits;
use crate::book;
use crate::counts::{self, Counts};
use crate::cross;
use crate::faults;
use crate::python;
use crate::repository::{self, Beside, Repository};
use crate::supply;
use crate::venv;

const SCHEMA: &str = "docs/case.schema.json";
const BENCHMARK: &str = "tools/bench";
const MAIN_CASE: &str = "examples/cases/fractured_slope.toml";
/// Pictures of the main case that the README shows.
const PICTURES: [&str; 4] = ["model.png", "deformed.png", "history.png", "stage2_joints.png"];

/// Further cases with the command that draws their picture, its name, and the name under which the README shows it.
const CASES: [[&str; 4]; 2] = [
    ["run", "examples/cases/shaken_slope.toml", "history.png", "shaken.png"],
    ["fos", "examples/cases/plane_slide.toml", "fos.png", "fos.png"],
];

/// Coupling examples, which each draw a picture.
const COUPLINGS: [&str; 3] = ["earthquake", "reservoir", "twin"];

/// How much of the tests to run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// Everything.
    Full,
    /// Without documentation, schema and Python.
    Quick,
}

/// The one test command: every step runs, whatever failed before, but for those that need the build.
///
/// It fails when a step or a test failed, or no test ran.
pub fn test(repository: &Repository, extent: Extent) -> ExitCode {
    let plain = |args: &[&str]| repository::run(&mut repository.cargo(args)).map(|()| Counts::default());
    let mut steps = Steps::default();
    steps.take("format", || plain(&["fmt", "--all", "--check"]));
    steps.take("lints", || plain(&["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"]));
    if !steps.take("build", || plain(&["build", "--release", "--workspace"])) {
        return steps.close();
    }
    // Tests leave a part of the processors idle: what else has to be compiled or fetched fills it.
    let beside =
        (extent == Extent::Full).then(|| (supply::start_oldest_compiler(repository), cross::start_quick(repository)));
    std::thread::scope(|scope| {
        if extent == Extent::Full {
            scope.spawn(|| venv::prepare(repository));
        }
        steps.take("tests", || cargo_test(repository, &["--no-fail-fast"]));
    });
    if let Some((oldest, windows)) = beside {
        steps.take("documentation", || {
            let mut doc = repository.cargo(&["doc", "--release", "--workspace", "--no-deps"]);
            repository::run(doc.env("RUSTDOCFLAGS", "-D warnings")).map(|()| Counts::default())
        });
        steps.take("schema", || compare_schema(repository).map(|()| Counts::default()));
        steps.take("parts", || supply::parts(repository).map(|()| Counts::default()));
        steps.take("dependencies", || supply::deny(repository).map(|()| Counts::default()));
        steps.take("oldest compiler", || finish(oldest?));
        steps.take("python", || python::test(repository, &[python::ALL]));
        steps.take("windows", || cross::quick(repository, windows?));
        steps.take("bits", || bits::quick(repository));
        steps.take("fuzz", || throw(repository, &[]).map(|()| Counts::default()));
        steps.take("faults", || faults::rounds_of(repository, 1));
    }
    steps.close()
}

/// Throws wrong cases, joint networks, calls and states at every entrance, as `words` say.
///
/// # Errors
/// When the program does not build, or finds something.
pub fn fuzz(repository: &Repository, words: &[&str]) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["build", "--release", "--workspace"]))?;
    throw(repository, words)
}

/// Waits for a command that was started, if there is one.
fn finish(started: Option<Beside>) -> Result<Counts, String> {
    started.map_or(Ok(()), Beside::finish).map(|()| Counts::default())
}

fn throw(repository: &Repository, words: &[&str]) -> Result<(), String> {
    let mut fuzz =
        repository.command(repository.enmm().with_file_name(format!("enmm-fuzz{}", std::env::consts::EXE_SUFFIX)));
    repository::run(fuzz.arg("--finds").arg(repository.target.join("fuzz")).args(words))
}

/// Builds and runs the Python tests alone.
pub fn python(repository: &Repository) -> ExitCode {
    let mut steps = Steps::default();
    let build = ["build", "--release", "--workspace", "--examples"];
    if steps.take("build", || repository::run(&mut repository.cargo(&build)).map(|()| Counts::default())) {
        steps.take("python", || python::test(repository, &[python::ALL]));
    }
    steps.close()
}

/// Builds, and runs the full campaigns of the ensembles in Python.
pub fn ensembles(repository: &Repository) -> ExitCode {
    let mut steps = Steps::default();
    let build = ["build", "--release", "--workspace", "--examples"];
    if steps.take("build", || repository::run(&mut repository.cargo(&build)).map(|()| Counts::default())) {
        steps.take("ensembles", || python::test_in_full(repository, &["python_tests/test_ensemble.py"]));
    }
    steps.close()
}

/// Runs the long campaigns; it fails when one failed, or there is none.
pub fn long(repository: &Repository) -> ExitCode {
    let mut steps = Steps::default();
    steps.take("long campaigns", || cargo_test(repository, &["--no-fail-fast", "--", "long_"]));
    steps.close()
}

/// Runs a program of the verification crate: `report` writes the manual, `compare` sets the integrators side by side.
///
/// # Errors
/// When it does not build, or ends with another status than 0.
pub fn verification(repository: &Repository, program: &str) -> Result<(), String> {
    let run = ["run", "--quiet", "--release", "--package", "enmm-verification", "--bin", program];
    repository::run(repository.cargo(&run).env("ENMM_LABEL", label(repository)?))
}

/// Prints the cost of a step through every export.
///
/// # Errors
/// When the program does not build or run.
pub fn overhead(repository: &Repository) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["run", "--quiet", "--release", "--package", "enmm-overhead"]))
}

/// Writes the schema of the case file as the command line prints it.
///
/// # Errors
/// When the program does not build or run, or the file cannot be written.
pub fn write_schema(repository: &Repository) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["build", "--release", "--package", "enmm-cli"]))?;
    let schema = schema(repository)?;
    std::fs::write(repository.root.join(SCHEMA), schema).map_err(|error| format!("{SCHEMA}: {error}"))?;
    println!("wrote {SCHEMA}");
    Ok(())
}

/// Times standard models on one thread, or as `options` say, and writes tables and plots with commit and date.
///
/// # Errors
/// When the program does not build or run.
pub fn write_benchmark(repository: &Repository, options: &[&str]) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["build", "--release", "--package", "enmm-cli"]))?;
    let mut bench = repository.command(repository.enmm());
    bench.args(["bench", "--output", BENCHMARK, "--label", &label(repository)?]);
    let threads: &[&str] = if options.contains(&"--threads") { &[] } else { &["--threads", "1"] };
    repository::run(bench.args(threads).args(options))
}

/// Commit and date, without which a time says nothing.
fn label(repository: &Repository) -> Result<String, String> {
    let line = |command: &mut Command| {
        repository::capture(command).map(|told| String::from_utf8_lossy(&told).trim().to_owned())
    };
    let commit = line(repository.command("git").args(["describe", "--always", "--dirty"]))?;
    let date = line(repository.command("date").args(["-u", "+%Y-%m-%d"]))?;
    Ok(format!("Commit {commit}, {date}"))
}

/// Runs the main case and further ones and copies their pictures to where the README shows them.
///
/// # Errors
/// When the case does not run or a picture is missing.
pub fn write_pictures(repository: &Repository) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["build", "--release", "--package", "enmm-cli"]))?;
    let results = repository.target.join("picture-results");
    repository::run(repository.command(repository.enmm()).args(["run", MAIN_CASE, "-o"]).arg(&results))?;
    let pictures = repository.root.join("docs/pictures");
    std::fs::create_dir_all(&pictures).map_err(|error| format!("{}: {error}", pictures.display()))?;
    for name in PICTURES {
        let from = results.join(name);
        std::fs::copy(&from, pictures.join(name)).map_err(|error| format!("{}: {error}", from.display()))?;
        println!("wrote docs/pictures/{name}");
    }
    write_cases(repository, &pictures)?;
    book::write_pictures(repository)?;
    write_couplings(repository, &pictures)
}

/// Runs the further cases and copies one picture of each.
fn write_cases(repository: &Repository, pictures: &Path) -> Result<(), String> {
    for [command, case, name, shown] in CASES {
        let results = repository.target.join("picture-results").join(shown);
        repository::run(repository.command(repository.enmm()).args([command, case, "-o"]).arg(&results))?;
        let from = results.join(name);
        std::fs::copy(&from, pictures.join(shown)).map_err(|error| format!("{}: {error}", from.display()))?;
        println!("wrote docs/pictures/{shown}");
    }
    Ok(())
}

/// Runs the coupling examples, which draw the pictures of `docs/coupling.md`.
fn write_couplings(repository: &Repository, pictures: &Path) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["build", "--release", "--package", "enmm-capi"]))?;
    for name in COUPLINGS {
        let mut example = venv::command(repository)?;
        example.arg(format!("examples/coupling/{name}.py")).arg("-o").arg(pictures.join(format!("{name}.png")));
        repository::run(&mut example)?;
    }
    Ok(())
}

/// Runs `cargo test` with `args` at the end; campaigns named `long_*` do their work only when called by that name.
fn cargo_test(repository: &Repository, args: &[&str]) -> Result<Counts, String> {
    let mut test: Command = repository.cargo(&["test", "--release", "--workspace"]);
    test.args(args);
    if args.contains(&"long_") {
        test.env("ENMM_LONG", "1");
    }
    let (lines, good) = repository::run_and_listen(&mut test)?;
    let counts = counts::of_cargo(&lines);
    if !good && counts.failed == 0 {
        return Err("cargo test failed without a failed test: see above".to_owned());
    }
    Ok(counts)
}

fn schema(repository: &Repository) -> Result<Vec<u8>, String> {
    repository::capture(repository.command(repository.enmm()).arg("schema"))
}

/// Writes the C header that belongs to the sources of the C ABI.
///
/// # Errors
/// When its program does not build or run, or the file cannot be written.
pub fn write_header(repository: &Repository) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["run", "--quiet", "--release", "--package", "enmm-header"]))?;
    println!("wrote the header of the C ABI");
    Ok(())
}

fn compare_schema(repository: &Repository) -> Result<(), String> {
    let told = schema(repository)?;
    let path = repository.root.join(SCHEMA);
    let committed = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    if told == committed {
        return Ok(());
    }
    let lines = told.split(|&b| b == b'\n').zip(committed.split(|&b| b == b'\n'));
    let line = 1 + lines.take_while(|(a, b)| a == b).count();
    Err(format!("{SCHEMA} is not what the sources make from line {line} on: run `cargo xtask schema` and commit"))
}

/// Steps that have run.
#[derive(Default)]
struct Steps {
    counts: Counts,
    failed: Vec<String>,
}

impl Steps {
    /// Runs one step under a header and returns whether it passed.
    fn take(&mut self, name: &str, act: impl FnOnce() -> Result<Counts, String>) -> bool {
        println!("\n== {name}");
        let start = Instant::now();
        let verdict = self.judge(name, act());
        let seconds = start.elapsed().as_secs_f64();
        match &verdict {
            Ok(()) => println!("-- {name}: ok, {seconds:.1} s"),
            Err(problem) => println!("-- {name}: FAILED, {seconds:.1} s: {problem}"),
        }
        verdict.is_ok()
    }

    /// Counts the tests of a step; one that is bad without a failed test counts as one failure.
    fn judge(&mut self, name: &str, result: Result<Counts, String>) -> Result<(), String> {
        let (counts, problem) = match result {
            Ok(counts) if counts.failed + counts.skipped == 0 => (counts, None),
            Ok(counts) => (counts, Some(format!("{} failed, {} switched off", counts.failed, counts.skipped))),
            Err(problem) => (Counts::default(), Some(problem)),
        };
        self.counts += counts;
        let Some(problem) = problem else { return Ok(()) };
        if counts.failed == 0 {
            self.counts.failed += 1;
        }
        self.failed.push(name.to_owned());
        Err(problem)
    }

    /// Prints what failed and, last of all, the closing line.
    fn close(self) -> ExitCode {
        let Counts { passed, failed, .. } = self.counts;
        println!();
        if passed + failed == 0 {
            println!("no test ran");
        } else if failed > 0 {
            println!("failed: {}", self.failed.join(", "));
        }
        println!("{passed} passed, {failed} failed");
        if passed > 0 && failed == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(results: &[Result<Counts, String>]) -> Steps {
        let mut steps = Steps::default();
        for result in results {
            let _ = steps.judge("step", result.clone());
        }
        steps
    }

    fn counts(passed: u64, failed: u64, skipped: u64) -> Counts {
        Counts { passed, failed, skipped }
    }

    #[test]
    fn good_steps_close_well() {
        let steps = steps(&[Ok(Counts::default()), Ok(counts(3, 0, 0)), Ok(counts(2, 0, 0))]);
        assert_eq!(steps.counts, counts(5, 0, 0));
        assert!(steps.close() == ExitCode::SUCCESS);
    }

    #[test]
    fn a_bad_step_never_stands_beside_zero_failed() {
        let broken = steps(&[Err("lint".to_owned()), Ok(counts(3, 0, 0))]);
        assert_eq!(broken.counts, counts(3, 1, 0));
        assert!(broken.close() == ExitCode::FAILURE);
        let skipping = steps(&[Ok(counts(3, 0, 1))]);
        assert_eq!(skipping.counts.failed, 1);
        assert!(skipping.close() == ExitCode::FAILURE);
        let failing = steps(&[Ok(counts(3, 2, 1))]);
        assert_eq!(failing.counts.failed, 2);
        assert!(failing.close() == ExitCode::FAILURE);
    }

    #[test]
    fn no_test_at_all_is_a_failure() {
        assert!(steps(&[Ok(Counts::default())]).close() == ExitCode::FAILURE);
    }
}
