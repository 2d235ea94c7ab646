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
pub use geometry_file::survey::{DEFAULT_LAW, LayerSurvey, Survey};
pub use schema::schema;

use enmm::model::case::limits::NAME_MAX;
use enmm::model::case::text::shortened;

/// Looks at a geometry file whose lines have no meaning yet: its layers with their lines in metres, curves within
/// `tolerance` (m).
///
/// # Errors
/// The file is none of its format, or a block of a drawing cannot be placed, with file and line.
pub fn survey_geometry(path: &Path, tolerance: f64) -> Result<Survey, CaseError> {
    let file = path.display().to_string();
    let unreadable = |message| CaseError::Unreadable { file: file.clone(), message };
    let format = geometry_file::Format::of(path).map_err(unreadable)?;
    let text = geometry_file::text(format, path).map_err(unreadable)?;
    let survey = match format {
        geometry_file::Format::Dxf => geometry_file::dxf::survey(&file, &text, tolerance),
        _ => geometry_file::survey::survey(format, &file, &text),
    }?;
    match survey.layers.iter().map(|layer| &layer.name).find(|name| name.chars().count() > NAME_MAX) {
        None => Ok(survey),
        Some(name) => {
            let (begin, letters) = (shortened(name, 20), name.chars().count());
            let message =
                format!("layer or law {begin:?} has {letters} letters, must have at most {NAME_MAX}; rename it");
            Err(unreadable(message))
        }
    }
}
