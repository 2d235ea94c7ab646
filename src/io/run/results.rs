//! What a run leaves at its start and end beside histories and frames: pictures, and the directory itself.

use std::fs;
use std::io;
use std::path::Path;

use crate::geometry::Point;
use crate::io::decor::model_decor;
use crate::io::picture::{displacement_picture, history_picture, model_picture};
use crate::model::snapshot::Polygons;
use crate::model::{Case, Simulation};

use super::rows;

/// Makes the directory and removes the frames of an earlier run in it.
pub fn clear(directory: &Path) -> io::Result<()> {
    let frames = directory.join("frames");
    fs::create_dir_all(&frames)?;
    for entry in fs::read_dir(&frames)? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if name.ends_with(".vtu") && (name.starts_with("elements_") || name.starts_with("joints_")) {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Draws the model before it moves.
pub fn draw_model(simulation: &Simulation, directory: &Path) -> io::Result<()> {
    model_picture(&simulation.snapshot(), &model_decor(simulation)).write_png(&directory.join("model.png"))
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
