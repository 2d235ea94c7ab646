//! Files of a run at its start and end beside histories and frames: pictures, and the directory itself.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use enmm::geometry::{Point, Vector};
use enmm::model::case::{PictureKind, StageKind};
use enmm::model::{Case, Simulation};
use enmm_io::files::{at_path, copy_file};
use enmm_observe::{
    Joints, Polygons, Snapshot, WaterInJoints, broken_sections, moved_since, references, rock_sections, water_surface,
};
use enmm_picture::{
    Picture, StageEnd, bolt_marks, covers_picture, displacement_contours, displacement_picture, flow_picture,
    history_picture, joint_stress_pictures, joints_picture, lines_picture, mean_stress_contours, model_annotations,
    model_picture, number_text, stage_displacement_picture, stars, strength_picture, stress_picture, velocity_picture,
};
use enmm_report::FILM;

use crate::earthquake::{self, EarthquakeRecord};
use crate::flow::FLOW;
use crate::folder::{FRAMES, make_frames};
use crate::lines::{LINES, LineRecord, profiles};
use crate::rows::{self, Histories};
use crate::vtu::PARTS;

/// Kinds of pictures of the end of a stage, and with what the rest of their names begins.
const STAGE_PICTURES: [(PictureKind, &[&str]); 10] = [
    (PictureKind::Displacement, &["displacement"]),
    (PictureKind::Joints, &["joints"]),
    (PictureKind::JointStress, &["normal_stress", "shear_stress"]),
    (PictureKind::Stress, &["stress"]),
    (PictureKind::Velocity, &["velocity"]),
    (PictureKind::DisplacementContours, &["displacement_contours"]),
    (PictureKind::MeanStressContours, &["mean_stress_contours"]),
    (PictureKind::Strength, &["strength"]),
    (PictureKind::Flow, &["flow"]),
    (PictureKind::Lines, &["lines"]),
];

/// Files by which a directory is known as that of a run.
const TRACES: [&str; 2] = ["history.csv", "summary.json"];

/// Whether a run has written into a directory.
pub fn has_run(directory: &Path) -> bool {
    TRACES.iter().any(|name| directory.join(name).exists())
}

/// Removes the frames, the pictures of stages, the flow and the lines of an earlier run in the directory.
pub fn clear(directory: &Path) -> io::Result<()> {
    stage_pictures(directory)?.iter().try_for_each(|picture| fs::remove_file(picture).map_err(at_path(picture)))?;
    [FLOW, LINES].iter().try_for_each(|name| remove_table(&directory.join(name)))?;
    earthquake::clear(directory)?;
    make_frames(directory)?;
    frames(directory)?.iter().try_for_each(|frame| fs::remove_file(frame).map_err(at_path(frame)))
}

/// Removes a table of an earlier run, which a case without flow in joints or without lines would leave.
fn remove_table(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(at_path(path)(error)),
        _ => Ok(()),
    }
}

/// Pictures of ends of stages in a directory, such as `stage1_joints.png`.
fn stage_pictures(directory: &Path) -> io::Result<Vec<PathBuf>> {
    let is_one = |name: &str| {
        let rest = name.strip_prefix("stage").and_then(|rest| rest.strip_suffix(".png").or(rest.strip_suffix(".svg")));
        rest.and_then(|rest| rest.split_once('_')).is_some_and(|(number, kind)| {
            let kinds = STAGE_PICTURES.iter().flat_map(|(_, names)| names.iter());
            number.parse::<u32>().is_ok() && kinds.into_iter().any(|name| *name == kind)
        })
    };
    let mut found = Vec::new();
    for entry in fs::read_dir(directory).map_err(at_path(directory))? {
        let path = entry?.path();
        if path.file_name().and_then(|name| name.to_str()).is_some_and(is_one) {
            found.push(path);
        }
    }
    Ok(found)
}

/// Files of frames in a directory.
fn frames(directory: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let frames = directory.join(FRAMES);
    for entry in fs::read_dir(&frames).map_err(at_path(&frames))? {
        let path = entry?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if name.ends_with(".vtu") && PARTS.iter().any(|part| name.starts_with(&format!("{}_", part.name()))) {
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
        copy_file(path, &to)
    };
    copy(&beside.join("history.csv"))?;
    let film = beside.join(FILM);
    if film.is_file() {
        copy(&film)?;
    }
    stage_pictures(beside)?.iter().try_for_each(|picture| copy(picture))?;
    let collection = beside.join("run.pvd");
    if collection.is_file() && beside.join(FRAMES).is_dir() {
        frames(beside)?.iter().try_for_each(|frame| copy(frame))?;
        copy(&collection)?;
    }
    Ok(Past::Copied)
}

/// Draws the model before it moves: those pictures of it that the case requests.
pub fn draw_model(simulation: &Simulation, directory: &Path) -> io::Result<()> {
    let pictures = &simulation.case().output.pictures;
    if pictures.include(PictureKind::Model) {
        draw_slope(simulation, directory)?;
    }
    if pictures.include(PictureKind::Covers) {
        let annotations = model_annotations(simulation);
        let picture = covers_picture(&Snapshot::of(simulation), &annotations, &stars(simulation));
        picture.write(directory, "covers")?;
    }
    Ok(())
}

fn draw_slope(simulation: &Simulation, directory: &Path) -> io::Result<()> {
    model_picture(&Snapshot::of(simulation), &model_annotations(simulation)).write(directory, "model")
}

/// Draws a model that is only looked at into a directory: `model.png`, and `covers.png` if the case requests it.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn draw_checked(simulation: &Simulation, directory: &Path) -> io::Result<()> {
    if !simulation.case().output.pictures.include(PictureKind::Model) {
        draw_slope(simulation, directory)?;
    }
    draw_model(simulation, directory)
}

/// Draws the slope as it is now, the histories and the spectra of earthquakes.
pub fn draw_end(simulation: &Simulation, earthquakes: &[EarthquakeRecord], directory: &Path) -> io::Result<()> {
    let case = simulation.case();
    if case.output.pictures.include(PictureKind::Spectra) && !earthquakes.is_empty() {
        earthquake::draw(directory, &case.title, earthquakes)?;
    }
    if case.output.pictures.include(PictureKind::Deformed) {
        let snapshot = Snapshot::of(simulation);
        let title = match &case.output.since {
            Some(since) => format!("{}: since the end of {since}", case.title),
            None => case.title.clone(),
        };
        displacement_picture(&snapshot, &title, &outline(case)).write(directory, "deformed")?;
    }
    let kinds = [PictureKind::History, PictureKind::Energy].map(|kind| case.output.pictures.include(kind));
    if kinds.contains(&true) {
        let Histories { series, energies, stages } = rows::histories(&directory.join("history.csv"), case)?;
        let all = [("history", series), ("energy", energies)].into_iter().zip(kinds).filter(|(_, wanted)| *wanted);
        for ((name, series), _) in all {
            history_picture(&case.title, &series, &stages).write(directory, name)?;
        }
    }
    Ok(())
}

/// Draws the slope at the end of a stage: those pictures that the case requests. `started` are the displacements of the
/// covers (m) at the start of the stage, `lines` are those at the ends of the stages before.
pub fn draw_stage(
    simulation: &Simulation,
    joints: &Joints,
    (started, lines): (&[Vector], &[LineRecord]),
    directory: &Path,
) -> io::Result<()> {
    let pictures = &simulation.case().output.pictures;
    if !STAGE_PICTURES.iter().any(|(kind, _)| pictures.include(*kind)) {
        return Ok(());
    }
    let snapshot = Snapshot::of(simulation);
    let (bolts, water) = (bolt_marks(simulation), water_surface(simulation));
    let (number, caption) = (simulation.state().stage + 1, stage_caption(simulation));
    let stage =
        StageEnd { title: &simulation.case().title, caption, snapshot: &snapshot, bolts: &bolts, water: &water };
    for (kind, names) in STAGE_PICTURES.into_iter().filter(|(kind, _)| pictures.include(*kind)) {
        let pictures = match kind {
            PictureKind::Displacement | PictureKind::DisplacementContours if started.is_empty() => Vec::new(),
            PictureKind::Displacement => {
                vec![stage_displacement_picture(&stage, &moved_since(simulation, started))]
            }
            PictureKind::DisplacementContours => {
                vec![displacement_contours(&stage, &moved_since(simulation, started))]
            }
            PictureKind::MeanStressContours => vec![mean_stress_contours(&stage, &references(simulation))],
            PictureKind::Strength if simulation.model().breaking.is_none() => Vec::new(),
            PictureKind::Strength => {
                vec![strength_picture(&stage, &rock_sections(simulation), &broken_sections(simulation))]
            }
            PictureKind::Flow => {
                let flow = WaterInJoints::of(simulation);
                flow.map(|flow| flow_picture(&stage, &flow)).into_iter().collect()
            }
            PictureKind::Lines => lines_so_far(&stage, lines, &LineRecord::all(simulation)),
            PictureKind::Joints => vec![joints_picture(&stage, &joints.now(simulation))],
            PictureKind::JointStress => joint_stress_pictures(&stage, &joints.now(simulation)).into(),
            PictureKind::Stress => vec![stress_picture(&stage)],
            PictureKind::Velocity => vec![velocity_picture(&stage)],
            PictureKind::Model
            | PictureKind::Deformed
            | PictureKind::History
            | PictureKind::Energy
            | PictureKind::Spectra
            | PictureKind::Covers => Vec::new(),
        };
        for (picture, name) in pictures.iter().zip(names) {
            picture.write(directory, &format!("stage{number}_{name}"))?;
        }
    }
    Ok(())
}

/// Number, name and, where it is dynamic, time of a stage, as its pictures have them.
fn stage_caption(simulation: &Simulation) -> String {
    let (number, stage) = (simulation.state().stage + 1, simulation.stage());
    let time = match stage.kind {
        StageKind::Static => String::new(),
        StageKind::Dynamic => format!(", t = {} s", number_text(simulation.time())),
    };
    format!("stage {number}, {}{time}", stage.name)
}

/// The picture of lines at the ends of the stages before and of this one; none of a case without lines.
fn lines_so_far(stage: &StageEnd, before: &[LineRecord], now: &[LineRecord]) -> Vec<Picture> {
    let profiles = profiles(&[before, now].concat());
    if now.is_empty() { Vec::new() } else { vec![lines_picture(stage.title, &stage.caption, &profiles)] }
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
