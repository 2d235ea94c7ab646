//! Notes and warnings as commands print them: warnings first, and notes of the drawing and of the build once, by
//! `enmm check`; other commands count them, and show them all above an error.

use enmm_io::LoadedCase;
use serde_json::json;

use crate::{fail, print_line, tell_line};

/// Lines of warnings, and how many notes `enmm check` has.
pub fn lines<'a>(warnings: impl IntoIterator<Item = &'a String>, notes: usize) -> Vec<String> {
    let warnings = warnings.into_iter().map(|warning| format!("warning: {warning}"));
    warnings.chain(enmm_run::count_of_notes(notes).map(|count| format!("note: {count}"))).collect()
}

/// Notes and warnings of a case whose command has failed.
#[derive(Default)]
pub struct Told {
    warnings: Vec<String>,
    notes: Vec<String>,
}

impl Told {
    /// The notes of `enmm check` on a case; of one that cannot be built those of its reader.
    pub fn of(loaded: &LoadedCase) -> Self {
        match enmm_implicit::simulation(loaded.case.clone()) {
            Ok(simulation) => {
                let found = enmm_run::check(&simulation, &loaded.warnings);
                Self { warnings: found.warnings, notes: found.notes }
            }
            Err(_) => Self { warnings: loaded.warnings.clone(), notes: loaded.case.reader_notes.clone() },
        }
    }

    /// Prints it above an error, or with it as one object, and returns the exit status.
    pub fn refuse(&self, error: &impl std::fmt::Display, json: bool, status: u8) -> std::process::ExitCode {
        let Self { warnings, notes } = self;
        if json {
            let mut object = json!({ "error": error.to_string() });
            for (name, list) in [("warnings", warnings), ("notes", notes)].into_iter().filter(|(_, l)| !l.is_empty()) {
                object[name] = json!(list);
            }
            print_line(&object.to_string());
        }
        warnings.iter().for_each(|warning| tell_line(&format!("warning: {warning}")));
        notes.iter().for_each(|note| tell_line(&format!("note: {note}")));
        fail(error, status)
    }
}
