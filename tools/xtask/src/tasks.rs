//! Tasks that write what is committed but generated.

use std::path::Path;
use std::process::Command;

use crate::book;
use crate::repository::{self, Repository};
use crate::test::{SCHEMA, schema};
use crate::venv;

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
    repository::run(&mut repository.cargo(&["run", "--quiet", "--release", "--bin", "enmm-overhead"]))
}

/// Writes the schema of the case file as the command line prints it.
///
/// # Errors
/// When the program does not build or run, or the file cannot be written.
pub fn write_schema(repository: &Repository) -> Result<(), String> {
    repository.build(&["--package", "enmm-cli"])?;
    let schema = schema(repository)?;
    std::fs::write(repository.root.join(SCHEMA), schema).map_err(|error| format!("{SCHEMA}: {error}"))?;
    println!("wrote {SCHEMA}");
    Ok(())
}

/// Times standard models on one thread, or with `--peers` in `options` other programs beside enmm, and writes tables
/// and plots with commit and date.
///
/// # Errors
/// When the program does not build or run.
pub fn write_benchmark(repository: &Repository, options: &[&str]) -> Result<(), String> {
    repository.build(&["--package", "enmm-cli", "--package", "enmm-peers"])?;
    let beside_others = options.iter().any(|option| option.starts_with("--peers"));
    let mut bench = repository.command(repository.program(if beside_others { "enmm-peers" } else { "enmm" }));
    let threads: &[&str] = if options.contains(&"--threads") { &[] } else { &["--threads", "1"] };
    bench.args(if beside_others { vec![] } else { [&["bench"], threads].concat() });
    repository::run(bench.args(["--output", BENCHMARK, "--label", &label(repository)?]).args(options))
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
    repository.build(&["--package", "enmm-cli"])?;
    let results = repository.target.join("picture-results/main");
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
    repository.build(&["--package", "enmm-capi"])?;
    for name in COUPLINGS {
        let mut example = venv::command(repository, venv::Packages::All)?;
        example.arg(format!("examples/coupling/{name}.py")).arg("-o").arg(pictures.join(format!("{name}.png")));
        repository::run(&mut example)?;
    }
    Ok(())
}

/// Writes the C header that belongs to the sources of the C ABI.
///
/// # Errors
/// When its program does not build or run, or the file cannot be written.
pub fn write_header(repository: &Repository) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["run", "--quiet", "--package", "enmm-capi", "--example", "header"]))?;
    println!("wrote the header of the C ABI");
    Ok(())
}
