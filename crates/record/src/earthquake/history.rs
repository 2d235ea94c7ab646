//! Accelerations in the rows of `history.csv`, and what these rows hold of stages that are shaken.

use std::io;
use std::ops::Range;
use std::path::Path;

use enmm::model::case::Axis;
use enmm::model::{Case, Simulation};
use enmm_io::files::at_path;
use enmm_seismology::Accelerogram;

use super::seismogram::{Place, Seismogram, base_motion};

/// Axes with their names in columns.
const AXES: [(Axis, &str); 2] = [(Axis::X, "x"), (Axis::Y, "y")];

/// Whether a ground motion acts in any stage of a case.
pub fn is_shaken(case: &Case) -> bool {
    (0..case.stages.len()).any(|stage| case.is_shaken(stage))
}

/// Columns of the accelerations of monitors: of cases with a ground motion alone.
pub fn columns(case: &Case) -> Vec<(String, &'static str)> {
    let monitors = case.monitors.iter().filter(|_| is_shaken(case));
    let of = |name: &str| AXES.map(|(_, axis)| (format!("{name}_a{axis}"), "m/s2"));
    monitors.flat_map(|monitor| of(&monitor.name)).collect()
}

/// Mean accelerations (m/s²) of monitors since the last row, by the velocities of both and of the base; 0 in the first
/// row. The values of [`columns`] of a case that is shaken; `names` are those of the columns of the row.
pub fn accelerations(simulation: &Simulation, names: &[&str], last: Option<&[f64]>, row: &[f64]) -> Vec<f64> {
    let case = simulation.case();
    let Some(last) = last.filter(|last| row[0] > last[0]) else {
        return vec![0.0; columns(case).len()];
    };
    let starts = &simulation.state().stage_starts;
    let [before, now] = [last[0], row[0]].map(|time| base_motion(case, starts, time));
    let mean = |(axis, k): (usize, usize)| (row[k] - last[k] + now[axis][0] - before[axis][0]) / (row[0] - last[0]);
    places(case, names, "v").into_iter().flat_map(|both| both.into_iter().enumerate()).map(mean).collect()
}

/// Places of the columns of a quantity of each monitor, along both axes.
fn places(case: &Case, names: &[&str], quantity: &str) -> Vec<[usize; 2]> {
    let place = |name: &str, axis: &str| {
        let wanted = format!("{name}_{quantity}{axis}");
        names.iter().position(|column| *column == wanted).unwrap_or_default()
    };
    case.monitors.iter().map(|monitor| AXES.map(|(_, axis)| place(&monitor.name, axis))).collect()
}

/// Stages, one after the other, that are shaken.
pub fn spans(case: &Case) -> Vec<Range<usize>> {
    let mut spans: Vec<Range<usize>> = Vec::new();
    for stage in (0..case.stages.len()).filter(|stage| case.is_shaken(*stage)) {
        match spans.last_mut() {
            Some(span) if span.end == stage => span.end = stage + 1,
            _ => spans.push(stage..stage + 1),
        }
    }
    spans
}

/// Motions of the monitors in the rows of some stages.
#[derive(Debug, Clone, Default)]
pub struct Rows {
    /// Times (s).
    pub times: Vec<f64>,
    /// Of each monitor with its name, along each axis: velocity (m/s) and displacement (m) at the times.
    monitors: Vec<(String, [Vec<[f64; 2]>; 2])>,
}

/// Reads the rows of spans of stages from `history.csv`, each with the row at the end of the stage before.
pub fn read(path: &Path, simulation: &Simulation, spans: &[Range<usize>]) -> io::Result<Vec<Rows>> {
    let case = simulation.case();
    let base = |time: f64| base_motion(case, &simulation.state().stage_starts, time);
    let blank = || Rows {
        times: Vec::new(),
        monitors: case.monitors.iter().map(|monitor| (monitor.name.clone(), Default::default())).collect(),
    };
    let mut found: Vec<Rows> = spans.iter().map(|_| blank()).collect();
    let mut reader = csv::Reader::from_path(path).map_err(io::Error::from).map_err(at_path(path))?;
    let head = reader.headers().map_err(io::Error::from).map_err(at_path(path))?.clone();
    let names: Vec<&str> = head.iter().map(|column| column.split(" [").next().unwrap_or_default()).collect();
    let (speeds, ways) = (places(case, &names, "v"), places(case, &names, "u"));
    let mut before: Option<Vec<f64>> = None;
    for record in reader.records() {
        let record = record.map_err(io::Error::from).map_err(at_path(path))?;
        let row: Vec<f64> = record.iter().map(|text| text.parse().unwrap_or(f64::NAN)).collect();
        let stage = row.get(1).map_or(0, |stage| *stage as usize);
        let span = spans.iter().position(|span| (span.start + 1..=span.end).contains(&stage));
        if let Some(rows) = span.map(|span| &mut found[span]) {
            if rows.times.is_empty() {
                before.iter().for_each(|before| rows.push(before, [&speeds, &ways], base(before[0])));
            }
            rows.push(&row, [&speeds, &ways], base(row[0]));
        }
        before = Some(row);
    }
    Ok(found)
}

impl Rows {
    fn push(&mut self, row: &[f64], [speeds, ways]: [&[[usize; 2]]; 2], base: [[f64; 2]; 2]) {
        let number = |k: usize| row.get(k).copied().unwrap_or(f64::NAN);
        if self.times.last().is_some_and(|last| *last >= number(0)) {
            return;
        }
        self.times.push(number(0));
        for ((_, axes), (speed, way)) in self.monitors.iter_mut().zip(speeds.iter().zip(ways)) {
            for (k, along) in axes.iter_mut().enumerate() {
                along.push([number(speed[k]) + base[k][0], number(way[k]) + base[k][1]]);
            }
        }
    }

    /// The motions of the monitors; none of fewer than three rows.
    pub fn seismograms(&self) -> Vec<Seismogram> {
        let of = |(name, axes): &(String, [Vec<[f64; 2]>; 2])| {
            let along = |((axis, _), rows): (&(Axis, &str), &Vec<[f64; 2]>)| self.seismogram(name, *axis, rows);
            AXES.iter().zip(axes).filter_map(along).collect::<Vec<_>>()
        };
        self.monitors.iter().flat_map(of).collect()
    }

    fn seismogram(&self, name: &str, axis: Axis, rows: &[[f64; 2]]) -> Option<Seismogram> {
        let velocity: Vec<[f64; 2]> = self.times.iter().zip(rows).map(|(time, row)| [*time, row[0]]).collect();
        let fastest = rows.iter().map(|row| row[0].abs()).fold(0.0, f64::max);
        let farthest = rows.iter().map(|row| (row[1] - rows[0][1]).abs()).fold(0.0, f64::max);
        Some(Seismogram {
            name: name.to_owned(),
            of: Place::Monitor,
            stage: None,
            axis,
            acceleration: Accelerogram::of_velocity(&velocity).ok()?,
            peaks: Some([fastest, farthest]),
        })
    }
}
