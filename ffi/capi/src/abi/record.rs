//! Results of a coupled run.

use libc::c_char;

use super::pointers;
use crate::safe::enter::with_model;
use crate::types::{enmm_model, enmm_status};

/// Records the results of the model into a folder from now on: the files of `enmm run`, among them `history.csv`, the
/// film, frames for ParaView where the case asks for them, and at the end pictures, `checkpoint.enmm`, `report.html`
/// and `summary.json`, of which `enmm report` makes a report.
///
/// `folder` is a path in UTF-8, relative to the current directory; it is made if it is not there, and results of an
/// earlier run in it are replaced. Call it before enmm_start to have the initial equilibrium. Rows and frames are due
/// at the times of the case, which count all stages as in `enmm run`. What a step brings is written when the next one
/// begins, so that a step that is repeated from a saved state leaves nothing twice; a return to an earlier state
/// removes what is later. Recording changes no result. When a file cannot be written later, steps go on: the log gets
/// the error, and enmm_end_record returns it.
///
/// Errors: ENMM_FILE_ERROR when the folder cannot be written, another process writes there, or a result would replace
/// an input of the case; ENMM_INVALID_ARGUMENT when the model is recorded already; ENMM_NULL_ARGUMENT.
///
/// # Safety
/// Every pointer is as the head of the header states.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn enmm_record(model: *mut enmm_model, folder: *const c_char) -> enmm_status {
    // SAFETY: promised by the host.
    with_model(model.addr(), |model| model.record(unsafe { pointers::text("folder", folder)? }))
}

/// Writes a row of the history, a frame of the film and frames for ParaView of this instant at once, the latter also
/// when the case asks for none. A host that repeats steps calls it when a step stands.
///
/// Errors: ENMM_INVALID_ARGUMENT when the model is not recorded; ENMM_FILE_ERROR.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_write_frame(model: *mut enmm_model) -> enmm_status {
    with_model(model.addr(), |model| model.write_frame())
}

/// Ends the recording with pictures, checkpoint, page and summary. enmm_destroy does so too, but cannot return an
/// error.
///
/// Errors: ENMM_INVALID_ARGUMENT when the model is not recorded; ENMM_FILE_ERROR when a file could not be written,
/// now or since enmm_record. The recording has ended in any case.
#[unsafe(no_mangle)]
pub extern "C" fn enmm_end_record(model: *mut enmm_model) -> enmm_status {
    with_model(model.addr(), |model| model.end_record())
}
