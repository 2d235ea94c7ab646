//! Lines at the ends of stages: `lines.csv`, records for summaries, and their pictures.

use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};

use enmm::geometry::Vector;
use enmm::model::{LinePoint, Simulation, stress};
use enmm_io::files::{at_path, write_atomic};
use enmm_picture::{LineProfile, ProfileCurve};

/// Name of the file.
pub(crate) const LINES: &str = "lines.csv";
/// Head of `lines.csv`.
const COLUMNS: [&str; 14] = [
    "stage",
    "name",
    "time [s]",
    "line",
    "point",
    "distance [m]",
    "x [m]",
    "y [m]",
    "ux [m]",
    "uy [m]",
    "along [m]",
    "across [m]",
    "mean_stress [Pa]",
    "max_shear [Pa]",
];

/// A line at the end of a stage.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LineRecord {
    /// Name of the stage.
    pub stage: String,
    /// Its number, from 1.
    pub number: u32,
    /// Simulated time (s).
    pub time: f64,
    /// Name of the line.
    pub line: String,
    /// Its points, from the first to the last.
    pub points: Vec<LinePointRecord>,
}

/// A point of a line; NaN, or null, in rock that has been excavated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LinePointRecord {
    /// Distance from the first point in the reference configuration (m).
    pub distance: f64,
    /// Place there (m).
    pub place: [f64; 2],
    /// Displacement (m).
    pub displacement: [f64; 2],
    /// Displacement along the line (m), towards its end positive.
    pub along: f64,
    /// Displacement across the line (m), to the left on the way to its end positive.
    pub across: f64,
    /// Mean of the stresses xx and yy (Pa, tension positive).
    pub mean_stress: f64,
    /// Greatest shear stress in the plane (Pa).
    pub max_shear: f64,
}

impl LineRecord {
    /// All lines of a case now.
    pub fn all(simulation: &Simulation) -> Vec<Self> {
        let lines = simulation.case().lines.iter().enumerate();
        lines
            .map(|(k, line)| {
                let direction = Vector::from(line.direction());
                let start = Vector::from(line.from);
                let record = |point: &LinePoint| LinePointRecord {
                    distance: (point.place - start).norm(),
                    place: point.place.into(),
                    displacement: point.displacement.into(),
                    along: point.displacement.dot(&direction),
                    across: direction.perp(&point.displacement),
                    mean_stress: stress::mean(&point.stress),
                    max_shear: stress::max_shear(&point.stress),
                };
                Self {
                    stage: simulation.stage().name.clone(),
                    number: simulation.state().stage + 1,
                    time: simulation.time(),
                    line: line.name.clone(),
                    points: simulation.line(k).iter().map(record).collect(),
                }
            })
            .collect()
    }
}

/// Writes lines as CSV, units in the header; digits read back to the same numbers.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub(crate) fn write_lines(path: &Path, lines: &[LineRecord]) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(Vec::new());
    let mut write = |row: &[String]| csv.write_record(row).map_err(io::Error::from).map_err(at_path(path));
    write(&COLUMNS.map(str::to_owned))?;
    for line in lines {
        for (k, point) in line.points.iter().enumerate() {
            let LinePointRecord { distance, place, displacement, along, across, mean_stress, max_shear } = *point;
            let [[x, y], [ux, uy]] = [place, displacement];
            let whose = [line.number.to_string(), line.stage.clone(), format!("{:?}", line.time), line.line.clone()];
            let numbers = [distance, x, y, ux, uy, along, across, mean_stress, max_shear];
            let numbers = numbers.iter().map(|number| format!("{number:?}"));
            let row: Vec<String> = whose.into_iter().chain([(k + 1).to_string()]).chain(numbers).collect();
            write(&row)?;
        }
    }
    let bytes = csv.into_inner().map_err(csv::IntoInnerError::into_error).map_err(at_path(path))?;
    write_atomic(path, &bytes)
}

/// Lines as their picture shows them: each with its curves at the ends of stages.
pub(crate) fn profiles(lines: &[LineRecord]) -> Vec<LineProfile> {
    let mut profiles: Vec<LineProfile> = Vec::new();
    for record in lines {
        let of = |point: &LinePointRecord| [point.distance, point.across, point.along];
        let curve = ProfileCurve { stage: record.stage.clone(), points: record.points.iter().map(of).collect() };
        match profiles.iter_mut().find(|profile| profile.name == record.line) {
            Some(profile) => profile.curves.push(curve),
            None => profiles.push(LineProfile { name: record.line.clone(), curves: vec![curve] }),
        }
    }
    profiles
}
