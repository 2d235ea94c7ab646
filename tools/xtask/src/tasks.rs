//! Tasks that write what is committed but generated.

use std::process::Command;

use crate::repository::{self, Repository};
use crate::test::{SCHEMA, schema};
use crate::venv;

const BENCHMARK: &str = "tools/bench";
/// A run that draws contours.
const CONTOURS: &str = "run --set output.pictures=[\"displacement_contours\",\"mean_stress_contours\"]";
/// Pictures of the README and of the tutorials: command, case, picture of its results, and its place in `docs`.
const PICTURES: [[&str; 4]; 23] = [
    ["run", "fractured_slope", "model.png", "pictures/model.png"],
    ["run", "fractured_slope", "deformed.png", "pictures/deformed.png"],
    ["run", "fractured_slope", "history.png", "pictures/history.png"],
    ["run", "fractured_slope", "stage2_joints.png", "pictures/stage2_joints.png"],
    ["run", "shaken_slope", "history.png", "pictures/shaken.png"],
    ["fos", "plane_slide", "fos.png", "pictures/fos.png"],
    ["run", "road_cut", "stage2_joints.png", "book/pictures/road_cut_joints.png"],
    [CONTOURS, "road_cut", "stage1_displacement_contours.png", "book/pictures/road_cut_displacement.png"],
    [CONTOURS, "road_cut", "stage2_mean_stress_contours.png", "book/pictures/road_cut_mean_stress.png"],
    ["fos", "road_cut", "fos.png", "book/pictures/road_cut_fos.png"],
    ["fos", "road_cut", "failure.png", "book/pictures/road_cut_failure.png"],
    ["run", "step_path", "stage2_joints.png", "book/pictures/step_path_joints.png"],
    ["run", "toppling", "stage1_joints.png", "book/pictures/toppling_joints.png"],
    ["run", "toppling", "deformed.png", "book/pictures/toppling_deformed.png"],
    ["run", "pit", "deformed.png", "book/pictures/pit_deformed.png"],
    ["run", "pit", "stage4_joints.png", "book/pictures/pit_joints.png"],
    ["fos", "pit", "failure.png", "book/pictures/pit_failure.png"],
    ["run", "../flow/drained_bench", "stage2_flow.png", "book/pictures/drained_bench_flow.png"],
    ["run", "../flow/storm", "stage2_flow.png", "book/pictures/storm_flow.png"],
    ["run", "../flow/drawdown", "stage4_flow.png", "book/pictures/drawdown_flow.png"],
    ["run", "../breaking/overhang", "deformed.png", "book/pictures/overhang_deformed.png"],
    ["run", "../breaking/columns", "deformed.png", "book/pictures/columns_deformed.png"],
    ["run", "../breaking/slab", "deformed.png", "book/pictures/slab_deformed.png"],
];

/// Coupling examples, which each draw a picture.
const COUPLINGS: [&str; 3] = ["earthquake", "reservoir", "twin"];

/// Runs a program of the verification crate: `report` writes the manual, `compare` sets the integrators side by side.
pub fn verification(repository: &Repository, program: &str) -> Result<(), String> {
    let run = ["run", "--quiet", "--release", "--package", "enmm-verification", "--bin", program];
    repository::run(repository.cargo(&run).env("ENMM_LABEL", label(repository)?))
}

/// Prints the cost of a step through every export.
pub fn overhead(repository: &Repository) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["run", "--quiet", "--release", "--bin", "enmm-overhead"]))
}

/// Writes the schema of the case file as the command line prints it.
pub fn write_schema(repository: &Repository) -> Result<(), String> {
    repository.build(&["--package", "enmm-cli"])?;
    let schema = schema(repository)?;
    std::fs::write(repository.root.join(SCHEMA), schema).map_err(|error| format!("{SCHEMA}: {error}"))?;
    println!("wrote {SCHEMA}");
    Ok(())
}

/// Times standard models on one thread, or with `--peers` in `options` other programs beside enmm, and writes tables
/// and plots with commit and date.
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

/// Runs the cases of the documents and copies their pictures to where the pages show them; then the coupling examples,
/// which draw the pictures of `docs/coupling.md`.
pub fn write_pictures(repository: &Repository) -> Result<(), String> {
    repository.build(&["--package", "enmm-cli", "--package", "enmm-capi"])?;
    let docs = repository.root.join("docs");
    for (k, [command, case, picture, shown]) in PICTURES.into_iter().enumerate() {
        let first = PICTURES.iter().position(|other| other[..2] == [command, case]).unwrap_or(k);
        let from = repository.target.join("picture-results").join(format!("{}_{first}", case.replace("../", "")));
        if first == k {
            let mut run = repository.command(repository.enmm());
            run.args(command.split(' ')).arg(format!("examples/cases/{case}.toml"));
            repository::run(run.arg("-o").arg(&from))?;
        }
        repository::write(&docs.join(shown), repository::read(&from.join(picture))?)?;
        println!("wrote docs/{shown}");
    }
    for name in COUPLINGS {
        let mut example = venv::command(repository, venv::Packages::All)?;
        example.arg(format!("examples/coupling/{name}.py")).arg("-o").arg(docs.join(format!("pictures/{name}.png")));
        repository::run(&mut example)?;
    }
    Ok(())
}

/// Writes the C header that belongs to the sources of the C ABI.
pub fn write_header(repository: &Repository) -> Result<(), String> {
    repository::run(&mut repository.cargo(&["run", "--quiet", "--package", "enmm-capi", "--example", "header"]))?;
    println!("wrote the header of the C ABI");
    Ok(())
}
