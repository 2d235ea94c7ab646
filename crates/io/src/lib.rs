//! Files of enmm: case files with the geometry and records that they name, their schema, checkpoints.
//!
//! [`load_case`] reads a case, whose errors name file, line and key; [`files`] writes what is whole or absent.
#![forbid(unsafe_code)]

mod case_error;
mod case_file;
pub mod checkpoint;
pub mod files;
mod geometry_file;
mod lines;
pub mod numbers;
mod record_file;
mod schema;

use std::path::Path;

pub use case_error::CaseError;
pub use case_file::{CaseSource, LoadedCase, load_case, load_case_with, parse_case};
pub use geometry_file::dxf::{LayerSurvey, Survey};
pub use schema::schema;

/// Looks at a DXF drawing whose layers have no meaning yet: its layers with their lines in metres, curves within
/// `tolerance` (m).
///
/// # Errors
/// The file is no drawing, or a block cannot be placed, with file and line.
pub fn survey_drawing(path: &Path, tolerance: f64) -> Result<Survey, CaseError> {
    let file = path.display().to_string();
    let text =
        case_error::read_drawing(path).map_err(|message| CaseError::Unreadable { file: file.clone(), message })?;
    geometry_file::dxf::survey(&file, &text, tolerance)
}
