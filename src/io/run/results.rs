//! What a run leaves at its start and end beside histories and frames: pictures, and the directory itself.

use std::fs;
use std::io;
use std::path::Path;

use crate::geometry::{NONE, Point};
use crate::io::picture::{ModelDecor, displacement_picture, history_picture, model_picture};
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
    model_picture(&simulation.snapshot(), &decor(simulation)).write_png(&directory.join("model.png"))
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

fn decor(simulation: &Simulation) -> ModelDecor {
    let (slope, case) = (simulation.slope(), simulation.case());
    let covers = &slope.covers;
    let supports = slope.supports.iter().map(|support| {
        let place = |(&i, w): (&u32, f64)| covers.star_position[i as usize] * w;
        support.covers.iter().zip(support.weights).map(place).sum()
    });
    let mut fixed: Vec<Point> = supports.collect();
    fixed.dedup();
    let joints = covers.outlines.pieces.iter().filter(|piece| piece.trace != NONE && piece.element < piece.opposite);
    ModelDecor {
        title: case.title.clone(),
        stars: covers.covers_by_star().into_iter().map(|(star, count)| (covers.mesh.node(star), count)).collect(),
        fixed,
        monitors: case.monitors.iter().map(|m| (m.name.clone(), Point::from(m.point))).collect(),
        counts: vec![
            format!("{} blocks", covers.block_count()),
            format!("{} elements", covers.element_count()),
            format!("{} physical covers", covers.cover_count()),
            format!("mesh size {} m", covers.mesh.size),
        ],
        trace_segments: joints.map(|piece| ([piece.a, piece.b], slope.trace_law[piece.trace as usize])).collect(),
    }
}
