//! Helpers that tests share: cases from text, runs.
#![allow(dead_code)]

pub mod claims;
pub mod extent;
pub mod geometry;
pub mod loose;
pub mod pit;
pub mod rest;
pub mod saved;
pub mod shared;

#[path = "../../crates/verification/src/parts.rs"]
pub mod parts;
#[path = "../../crates/verification/src/random.rs"]
pub mod random;

use std::path::{Path, PathBuf};

use enmm::model::bytes::{Keeper, decode, encode};
use enmm::model::tables::DetectionRule;
use enmm::model::{Case, Simulation, State, StepReport};

/// Root of the repository, from the tests of any crate.
pub fn root() -> &'static Path {
    let folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    folders.into_iter().find(|folder| folder.join("Cargo.lock").is_file()).expect("a crate of the repository")
}

/// Folder of the example cases.
pub fn examples() -> PathBuf {
    root().join("examples/cases")
}

/// The text of an example case.
pub fn example(name: &str) -> String {
    let path = examples().join(name).with_extension("toml");
    std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The case of a text; files that it names lie beside the examples.
pub fn case(text: &str) -> Case {
    enmm_io::parse_case(text, "case.toml", &examples()).unwrap_or_else(|e| panic!("{e}\n{text}")).case
}

/// Builds a simulation from the text of a case.
pub fn simulation(text: &str) -> Simulation {
    Simulation::new(case(text)).unwrap_or_else(|e| panic!("{e}"))
}

/// A model of the same text with the state of a simulation, which has gone through bytes and been checked.
pub fn through_bytes(simulation: &Simulation, text: &str) -> Simulation {
    let bytes = encode(Keeper::Model, simulation.state(), "hash").expect("bytes");
    let mut other = self::simulation(text);
    let state: State = decode(Keeper::Model, &bytes, "hash").expect("a state");
    other.check(&state).expect("a state of this model");
    other.restore(state);
    other
}

/// The error of a case that cannot be read or built.
pub fn refusal(text: &str) -> String {
    match enmm_io::parse_case(text, "case.toml", &examples()) {
        Ok(loaded) => Simulation::new(loaded.case).map(|_| ()).expect_err("it is refused").to_string(),
        Err(error) => error.to_string(),
    }
}

/// Takes so many steps, without a report.
pub fn step(simulation: &mut Simulation, steps: u64) {
    (0..steps).for_each(|_| _ = simulation.advance(false).unwrap_or_else(|e| panic!("{e}")));
}

/// Takes steps up to a time (s), without a report.
pub fn step_to(simulation: &mut Simulation, time: f64) {
    while simulation.time() < time {
        step(simulation, 1);
    }
}

/// Runs the stage in progress to its end; returns the last report.
pub fn run_stage(simulation: &mut Simulation) -> StepReport {
    simulation.run_stage().unwrap_or_else(|e| panic!("{e}"))
}

/// Runs all stages; returns the last report of each.
pub fn run_all(simulation: &mut Simulation) -> Vec<StepReport> {
    let mut reports = vec![run_stage(simulation)];
    while simulation.next_stage().unwrap_or_else(|e| panic!("{e}")) {
        reports.push(run_stage(simulation));
    }
    reports
}

/// Constants of contact with one of them halved or doubled, and which. Those of the boundary are not among them: a
/// model is built with them, and `contact_boundary.rs` varies them.
pub fn varied_rules() -> Vec<(String, DetectionRule)> {
    type Constant = fn(&mut DetectionRule) -> &mut f64;
    let constants: [(&str, Constant); 20] = [
        ("ledge", |rule| &mut rule.ledge),
        ("closure_most", |rule| &mut rule.closure_most),
        ("flush_sine", |rule| &mut rule.flush_sine),
        ("opposed_cosine", |rule| &mut rule.opposed_cosine),
        ("held_beyond", |rule| &mut rule.held_beyond),
        ("deep", |rule| &mut rule.deep),
        ("deep_share", |rule| &mut rule.deep_share),
        ("wedge_ratio", |rule| &mut rule.wedge_ratio),
        ("stiffness_floor", |rule| &mut rule.stiffness_floor),
        ("hardens", |rule| &mut rule.hardens),
        ("corner_tolerance", |rule| &mut rule.corner_tolerance),
        ("tie_tolerance", |rule| &mut rule.tie_tolerance),
        ("length_floor", |rule| &mut rule.length_floor),
        ("crush_floor", |rule| &mut rule.crush_floor),
        ("share_floor", |rule| &mut rule.share_floor),
        ("reach", |rule| &mut rule.reach),
        ("reach_steps", |rule| &mut rule.reach_steps),
        ("stays", |rule| &mut rule.stays),
        ("stays_steps", |rule| &mut rule.stays_steps),
        ("cutoff", |rule| &mut rule.cutoff),
    ];
    let vary = |(name, constant): (&str, Constant)| {
        [0.5, 2.0].map(|factor| {
            let mut rule = DetectionRule::default();
            *constant(&mut rule) *= factor;
            (format!("{factor} {name}"), rule)
        })
    };
    constants.into_iter().flat_map(vary).collect()
}

/// The same simulation, of which the next step finds all contacts.
pub fn without_found(simulation: &Simulation) -> Simulation {
    let mut state = simulation.state().clone();
    state.found.forget();
    let mut other = simulation.clone();
    other.restore(state);
    other
}
