//! The page of a model as it is built, before anything has moved.

use std::io;
use std::path::{Path, PathBuf};

use enmm_report::{Axis, FILM, MOTION, PAGE};

use enmm::model::Simulation;
use enmm_io::LoadedCase;
use enmm_record::film::{Film, Opening};

/// Writes the page of a model into a directory, with a film beside it, and returns its path.
///
/// # Errors
/// Whatever the file system refuses, or a number that cannot be shown.
pub fn write_model_page(directory: &Path, loaded: &LoadedCase, simulation: &Simulation) -> io::Result<PathBuf> {
    let axis = Axis { name: "time".to_owned(), unit: "s".to_owned() };
    let film = directory.join(FILM);
    let opening = Opening { command: "edit", film, axis, numbers: MOTION.to_vec(), elements: false, columns: &[] };
    let mut film = Film::open(directory, loaded, simulation, opening, None)?;
    film.frame_at(simulation, 0.0)?;
    film.close(0.0, "finished".to_owned())?;
    Ok(directory.join(PAGE))
}
