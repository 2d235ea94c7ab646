//! Notes and warnings as commands print them: warnings first, and notes of the drawing and of the build once, by
//! `enmm check`; other commands count them, and show them all above an error.

use std::fmt::Display;
use std::process::ExitCode;

use enmm_io::LoadedCase;
use serde_json::json;

use crate::{fail, print_line, tell_line};

/// Lines of warnings, and how many notes `enmm check` has.
pub fn lines<'a>(warnings: impl IntoIterator<Item = &'a String>, notes: usize) -> Vec<String> {
    let warnings = warnings.into_iter().map(|warning| format!("warning: {warning}"));
    warnings.chain(enmm_run::count_of_notes(notes).map(|count| format!("note: {count}"))).collect()
}

/// The exit status of a command, or why it failed.
pub type Outcome = Result<ExitCode, Failure>;

/// An error of a command with its exit status, and notes and warnings of its case.
pub struct Failure {
    error: String,
    status: u8,
    warnings: Vec<String>,
    notes: Vec<String>,
    json: bool,
}

impl Failure {
    /// An error alone.
    pub fn new(error: impl Display, status: u8) -> Self {
        Self { error: error.to_string(), status, warnings: Vec::new(), notes: Vec::new(), json: false }
    }

    /// With the notes of `enmm check` on a case; of one that cannot be built with those of its reader.
    pub fn on(self, loaded: &LoadedCase) -> Self {
        let (warnings, notes) = match enmm_implicit::simulation(loaded.case.clone()) {
            Ok(simulation) => {
                let found = enmm_run::check(&simulation, &loaded.warnings);
                (found.warnings, found.notes)
            }
            Err(_) => (loaded.warnings.clone(), loaded.case.reader_notes.clone()),
        };
        Self { warnings, notes, ..self }
    }

    /// Printed as one JSON object as well, if that is asked for.
    pub fn json(self, json: bool) -> Self {
        Self { json, ..self }
    }

    /// Prints it below the notes and warnings, and returns the exit status.
    pub fn tell(&self) -> ExitCode {
        let Self { error, status, warnings, notes, json } = self;
        if *json {
            let mut object = json!({ "error": error });
            for (name, list) in [("warnings", warnings), ("notes", notes)].into_iter().filter(|(_, l)| !l.is_empty()) {
                object[name] = json!(list);
            }
            print_line(&object.to_string());
        }
        warnings.iter().for_each(|warning| tell_line(&format!("warning: {warning}")));
        notes.iter().for_each(|note| tell_line(&format!("note: {note}")));
        fail(error, *status)
    }
}

/// Errors that end a command.
pub trait OrFail<T> {
    /// The value, or the failure with an exit status.
    fn or_fail(self, status: u8) -> Result<T, Failure>;
}

impl<T, E: Display> OrFail<T> for Result<T, E> {
    fn or_fail(self, status: u8) -> Result<T, Failure> {
        self.map_err(|error| Failure::new(error, status))
    }
}
