//! The case that a command works on: a file, and values that take the place of the file's.

use std::path::PathBuf;

use clap::Args;
use enmm_io::{CaseError, LoadedCase, load_case_with};

/// Arguments that name a case.
#[derive(Args)]
pub struct CaseArguments {
    /// Case file (TOML).
    #[arg(value_name = "CASE")]
    pub path: PathBuf,
    /// Gives a key of the case another value, such as joint_law.plane.friction_deg=30 or joint_set[0].seed=7; as often
    /// as needed.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,
}

impl CaseArguments {
    /// Reads the case.
    ///
    /// # Errors
    /// The first thing in the files or the settings that cannot be used.
    pub fn load(&self) -> Result<LoadedCase, CaseError> {
        load_case_with(&self.path, &self.settings)
    }

    /// Reads the case with further values.
    pub fn load_with(&self, more: &[String]) -> Result<LoadedCase, CaseError> {
        load_case_with(&self.path, &[&self.settings, more].concat())
    }
}
