//! Results of a model in a folder.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use enmm_record::{Recording, RecordingError};

use super::failure::{Failure, Outcome};
use super::model::Model;
use crate::types::enmm_status;

impl From<RecordingError> for Failure {
    fn from(error: RecordingError) -> Self {
        let status = match error {
            RecordingError::Folder(_) | RecordingError::Output(_) => enmm_status::ENMM_FILE_ERROR,
            RecordingError::OtherCase { .. } => enmm_status::ENMM_INVALID_CASE,
            RecordingError::On(_) | RecordingError::Off => enmm_status::ENMM_INVALID_ARGUMENT,
        };
        Self::new(status, error.to_string())
    }
}

impl Model {
    /// Records results into a folder from now on.
    ///
    /// # Errors
    /// A folder that cannot be written, or a model that is recorded already.
    pub fn record(&mut self, folder: &str) -> Outcome {
        if folder.is_empty() {
            return Err(Failure::invalid("folder: is empty, must be the path of a folder; name one"));
        }
        self.lost_record = false;
        Ok(Recording::open(&mut self.inner, &self.loaded, Path::new(folder))?)
    }

    /// Writes a row and frames of this instant.
    ///
    /// # Errors
    /// Nothing is recorded, or a file that cannot be written.
    pub fn write_frame(&mut self) -> Outcome {
        Ok(Recording::write_frame(&mut self.inner)?)
    }

    /// Ends the recording with its summary.
    ///
    /// # Errors
    /// Nothing is recorded, or a file that cannot be written, now or before.
    pub fn end_record(&mut self) -> Outcome {
        Recording::close(&mut self.inner)?;
        Ok(())
    }

    /// Why recording has ended by itself, if it has.
    pub fn record_fault(&self) -> Option<String> {
        Recording::fault(&self.inner).map(|fault| RecordingError::Output(fault.to_owned()).to_string())
    }
}

impl Drop for Model {
    /// Ends a recording that the host has left on. Nobody hears of a file that cannot be written then.
    fn drop(&mut self) {
        if Recording::is_on(&self.inner) {
            let _ = catch_unwind(AssertUnwindSafe(|| Recording::close(&mut self.inner)));
        }
    }
}
