//! What a run leaves at its start and end beside histories and frames: pictures, and the directory itself.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use enmm::geometry::Point;
use enmm::model::snapshot::Polygons;
use enmm::model::{Case, Simulation};
use enmm_io::files::{at_path, sweep_temporaries};
use enmm_picture::model_annotations;
use enmm_picture::{displacement_picture, history_picture, model_picture};
use enmm_report::FILM;

use super::rows;

/// What tells that a run has written into a directory.
const TRACES: [&str; 2] = ["history.csv", "summary.json"];

/// Makes the directory, removes what a killed run left half written, and tells whether a run has been here before.
pub fn enter(directory: &Path) -> io::Result<bool> {
    fs::create_dir_all(directory).map_err(at_path(directory))?;
    sweep_temporaries(directory)?;
    sweep_temporaries(&directory.join("frames"))?;
    Ok(TRACES.iter().any(|name| directory.join(name).exists()))
}

/// Removes the frames of an earlier run in the directory.
pub fn clear(directory: &Path) -> io::Result<()> {
    let frames_directory = directory.join("frames");
    fs::create_dir_all(&frames_directory).map_err(at_path(&frames_directory))?;
    frames(directory)?.iter().try_for_each(|frame| fs::remove_file(frame).map_err(at_path(frame)))
}

/// Files of frames in a directory.
fn frames(directory: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let frames = directory.join("frames");
    for entry in fs::read_dir(&frames).map_err(at_path(&frames))? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if name.ends_with(".vtu") && (name.starts_with("elements_") || name.starts_with("joints_")) {
            found.push(path);
        }
    }
    Ok(found)
}

/// Where the rows and frames before a checkpoint are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Past {
    /// In the directory of the results, as its own.
    Here,
    /// Copied to it from the directory of the checkpoint.
    Copied,
    /// Nowhere.
    Lost,
}

/// Copies histories and frames that lie beside a checkpoint into another directory of results.
pub fn bring_past(checkpoint: &Path, directory: &Path) -> io::Result<Past> {
    let beside = checkpoint.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let apart = beside.canonicalize()? != directory.canonicalize()?;
    if !apart || !beside.join("history.csv").is_file() {
        let here = directory.join("history.csv").is_file();
        return Ok(if here { Past::Here } else { Past::Lost });
    }
    clear(directory)?;
    let copy = |path: &Path| -> io::Result<()> {
        let to = directory.join(path.strip_prefix(beside).unwrap_or(path));
        fs::copy(path, &to).map(drop).map_err(at_path(&to))
    };
    copy(&beside.join("history.csv"))?;
    let film = beside.join(FILM);
    if film.is_file() {
        copy(&film)?;
    }
    let collection = beside.join("run.pvd");
    if collection.is_file() && beside.join("frames").is_dir() {
        frames(beside)?.iter().try_for_each(|frame| copy(frame))?;
        copy(&collection)?;
    }
    Ok(Past::Copied)
}

/// Draws the model before it moves.
pub fn draw_model(simulation: &Simulation, directory: &Path) -> io::Result<()> {
    model_picture(&simulation.snapshot(), &model_annotations(simulation)).write_png(&directory.join("model.png"))
}

/// Draws the slope as it is now, and the histories.
pub fn draw_end(simulation: &Simulation, directory: &Path) -> io::Result<()> {
    let case = simulation.case();
    let snapshot = simulation.snapshot();
    displacement_picture(&snapshot, &case.title, &outline(case)).write_png(&directory.join("deformed.png"))?;
    let series = rows::series(&directory.join("history.csv"))?;
    history_picture(&case.title, &series).write_png(&directory.join("history.png"))
}

/// Outer loops and holes of the case.
fn outline(case: &Case) -> Polygons {
    let domain = &case.domain;
    let mut polygons = Polygons { start: vec![0], points: Vec::new() };
    for points in std::iter::once(&domain.outline).chain(&domain.islands).chain(&domain.holes) {
        polygons.points.extend(points.iter().map(|p| Point::from(*p)));
        polygons.start.push(polygons.points.len() as u32);
    }
    polygons
}
