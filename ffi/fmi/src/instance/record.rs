//! Results of the instance in a folder that the importer names: those of `enmm run`.

use std::ffi::{CStr, CString};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use enmm_record::Recording;

use crate::log::{Category, Status};
use crate::phase::Call;
use crate::table::Type;

use super::{Failure, Instance};

impl Instance {
    /// The folder of results, which is the only text; it stays until the next call of this function.
    pub fn text(&mut self) -> &CStr {
        self.cache.text = CString::new(self.values.results_folder.as_str()).unwrap_or_default();
        &self.cache.text
    }

    /// Sets the folder of results.
    pub fn set_texts(&mut self, references: &[u32], texts: &[&str]) -> Status {
        let legal = self.allow(Call::Set);
        let counted = legal.and_then(|()| self.check_count(references, Type::String, texts.len()));
        let outcome = counted.and_then(|()| {
            for &reference in references {
                self.check_settable(self.variable(reference, Type::String)?)?;
            }
            self.take_back_start()
        });
        if let (Ok(()), Some(folder)) = (&outcome, texts.last()) {
            self.values.results_folder = (*folder).to_owned();
        }
        self.end(outcome)
    }

    /// Begins to record if the importer has named a folder; before the start, so that the equilibrium is recorded too.
    pub(super) fn begin_record(&mut self) -> Result<(), Failure> {
        let folder = &self.values.results_folder;
        if folder.is_empty() || Recording::is_on(&self.model) {
            return Ok(());
        }
        self.lost_record = false;
        Recording::open(&mut self.model, &self.built_case, Path::new(folder))
            .map_err(|error| format!("results_folder: {error}"))
    }

    /// Ends the recording, if there is one, with pictures and summary.
    pub(super) fn end_record(&mut self) -> Result<(), Failure> {
        if !Recording::is_on(&self.model) {
            return Ok(());
        }
        Recording::close(&mut self.model).map(drop).map_err(|error| format!("results_folder: {error}"))
    }

    /// Warns once of a recording that could not go on.
    pub(super) fn warn_of_lost_record(&mut self) {
        if self.lost_record {
            return;
        }
        let fault = Recording::fault(&self.model).map(|fault| format!("results_folder: recording has ended: {fault}"));
        if let Some(text) = fault {
            self.lost_record = true;
            self.log(Status::Warning, Category::Warning, text);
        }
    }
}

impl Drop for Instance {
    /// Ends a recording that the importer has not ended. Nobody hears of a file that cannot be written then.
    fn drop(&mut self) {
        let _ = catch_unwind(AssertUnwindSafe(|| self.end_record()));
    }
}
