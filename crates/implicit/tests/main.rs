//! Tests of the implicit integrator.

mod agrees;
#[path = "../../../tests/common/mod.rs"]
mod common;
mod issue_keys_of_the_other_integrator_were_silent;

use std::path::Path;

use enmm::model::Simulation;

/// Builds a simulation from the text of a case, by the integrator that it names.
fn simulation(text: &str) -> Simulation {
    let loaded = enmm_io::parse_case(text, "test.toml", Path::new(".")).unwrap_or_else(|e| panic!("{e}"));
    enmm_implicit::simulation(loaded.case).unwrap_or_else(|e| panic!("{e}"))
}
