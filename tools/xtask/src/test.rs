//! The test command in its two extents, and the shares of it that have commands of their own.
//!
//! All of it is built by the profile of tests, so that nothing is compiled twice.

use std::process::ExitCode;

use crate::bits;
use crate::counts::{self, Counts};
use crate::cross;
use crate::faults;
use crate::platform::{AARCH64_QUICK, WINDOWS_QUICK};
use crate::python::{self, Share};
use crate::repository::{self, Beside, Repository};
use crate::sanitize;
use crate::steps::Steps;
use crate::supply;
use crate::venv::{self, Packages};

/// The schema of the case file.
pub const SCHEMA: &str = "docs/case.schema.json";
/// Left to `cargo xtask test --all`.
const LEFT_OUT: &str = "lints, Chromium, rustdoc, the oldest compiler, licences and advisories of dependencies, \
    notebooks and other Python tests, fuzzing, faults, sanitizers, unit tests within crates, the long forms of tests";
/// The tests in folders of their own: those within a crate would build every crate a second time.
const BESIDE_CRATES: [&str; 3] = ["--test", "*", "--examples"];

/// The tests of a newcomer and of every commit: they install nothing outside the target folder.
pub fn usual(repository: &Repository) -> ExitCode {
    let mut steps = Steps::default();
    std::thread::scope(|scope| {
        scope.spawn(|| venv::prepare(repository, Packages::Usual));
        if take_build(repository, &mut steps) {
            take_usual(repository, &mut steps, &BESIDE_CRATES, None);
        }
    });
    println!("\nleft out, for `cargo xtask test --all`: {LEFT_OUT}");
    steps.close()
}

/// The usual tests, those of Rust in their full form, then those that need other systems.
pub fn all(repository: &Repository) -> ExitCode {
    let mut steps = Steps::default();
    std::thread::scope(|scope| {
        let installed = scope.spawn(|| install_all(repository));
        if take_build(repository, &mut steps) {
            // A step that misses something says so.
            let _ = installed.join();
            // It fills the time in which tests leave a processor idle.
            let oldest = supply::start_oldest_compiler(repository);
            take_usual(repository, &mut steps, &[], Some(("ENMM_FULL", "1")));
            steps.print_counts();
            take_others(repository, &mut steps, oldest);
        }
    });
    steps.close()
}

/// Installs what the steps after the build need: that waits for the network more than it computes.
fn install_all(repository: &Repository) {
    venv::prepare(repository, Packages::All);
    python::install(repository);
}

/// Returns whether there is a build, which all other steps need; they run whatever failed before.
fn take_build(repository: &Repository, steps: &mut Steps) -> bool {
    steps.take("format", || repository::run(&mut repository.cargo(&["fmt", "--all", "--check"])));
    steps.take("build", || repository.build(&["--workspace"]))
}

fn take_usual(repository: &Repository, steps: &mut Steps, words: &[&str], extent: Option<(&str, &str)>) {
    steps.take("tests", || cargo_test(repository, words, extent));
    steps.take("schema", || compare_schema(repository));
    steps.take("bits", || bits::quick(repository));
    steps.take("python", || python::test(repository, Share::Usual));
}

fn take_others(repository: &Repository, steps: &mut Steps, oldest: Result<Option<Beside>, String>) {
    let lint = ["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"];
    steps.take("lints", || repository::run(&mut repository.cargo(&lint)));
    steps.take("documentation", || {
        let mut doc = repository.cargo(&["doc", "--workspace", "--no-deps"]);
        repository::run(doc.env("RUSTDOCFLAGS", "-D warnings"))
    });
    steps.take("dependencies", || supply::deny(repository));
    steps.take("other python", || python::test(repository, Share::Others));
    steps.take("faults", || faults::rounds_of(repository, 1));
    steps.take("fuzz", || throw(repository, &[]));
    steps.take("sanitizers", || sanitize::run(repository, true));
    steps.take("oldest compiler", || oldest?.map_or(Ok(()), Beside::finish));
}

/// Builds for Windows and for ARM, and compares their quick results on emulators with the golden table.
pub fn platforms(repository: &Repository) -> ExitCode {
    let mut steps = Steps::default();
    if steps.take("build", || repository.build(&["--workspace"])) {
        for platform in [&WINDOWS_QUICK, &AARCH64_QUICK] {
            steps.take(platform.name, || cross::quick(repository, platform));
        }
    }
    steps.close()
}

/// Runs the long campaigns; it fails when one failed, or there is none.
pub fn long(repository: &Repository) -> ExitCode {
    let mut steps = Steps::default();
    steps.take("long campaigns", || cargo_test(repository, &["long_"], Some(("ENMM_LONG", "1"))));
    steps.close()
}

/// Builds, and runs a share of the Python tests.
pub fn python(repository: &Repository, name: &str, share: Share) -> ExitCode {
    let mut steps = Steps::default();
    if steps.take("build", || repository.build(&["--workspace", "--examples"])) {
        steps.take(name, || python::test(repository, share));
    }
    steps.close()
}

/// Throws wrong cases, joint networks, calls and states at every entrance, as `words` say.
pub fn fuzz(repository: &Repository, words: &[&str]) -> Result<(), String> {
    repository.build(&["--workspace"])?;
    throw(repository, words)
}

fn throw(repository: &Repository, words: &[&str]) -> Result<(), String> {
    let mut fuzz = repository.command(repository.program("enmm-fuzz"));
    repository::run(fuzz.arg("--finds").arg(repository.target.join("fuzz")).args(words))
}

/// Runs the tests that `words` select; all where there are none.
fn cargo_test(repository: &Repository, words: &[&str], extent: Option<(&str, &str)>) -> Result<Counts, String> {
    let mut test = repository.cargo(&["test", "--workspace", "--no-fail-fast"]);
    let (lines, good) = repository::run_and_listen(test.args(words).envs(extent))?;
    let counts = counts::of_cargo(&lines);
    if !good && counts.failed == 0 {
        return Err("cargo test failed without a failed test: see above".to_owned());
    }
    Ok(counts)
}

/// The schema as the program prints it.
pub fn schema(repository: &Repository) -> Result<Vec<u8>, String> {
    repository::capture(repository.command(repository.enmm()).arg("schema"))
}

fn compare_schema(repository: &Repository) -> Result<(), String> {
    let printed = schema(repository)?;
    let committed = repository::read(&repository.root.join(SCHEMA))?;
    if printed == committed {
        return Ok(());
    }
    let lines = printed.split(|&b| b == b'\n').zip(committed.split(|&b| b == b'\n'));
    let line = 1 + lines.take_while(|(a, b)| a == b).count();
    Err(format!("{SCHEMA} is not what the sources make from line {line} on: run `cargo xtask schema` and commit"))
}
