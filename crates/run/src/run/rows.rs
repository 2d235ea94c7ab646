//! Columns and rows of `history.csv`, and how often rows, frames and checkpoints are due.

use std::io;
use std::path::Path;

use enmm::geometry::Vector;
use enmm::model::case::StageKind;
use enmm::model::settle::REST_STEPS;
use enmm::model::{Case, Simulation, StepReport};
use enmm_observe::{ENERGIES, REPORT_QUANTITIES};
use enmm_picture::{Series, StageStart};

/// Rows of a stage that names no interval: of a dynamic one, and of a static one each time that its
/// number of steps doubles.
const ROWS: [f64; 2] = [500.0, 32.0];
/// Frames of a stage that names no interval: of a dynamic one, and of a doubling of the steps of a static one.
const FRAMES: [f64; 2] = [20.0, 2.0];
/// Least and most frames of the film of a dynamic stage, and those of a doubling of the steps of a static one.
const FILM_FRAMES: [f64; 3] = [60.0, 200.0, 6.0];

/// Quantity of the energies in the picture of the histories.
const ENERGY: &str = "energy";
/// Part of the largest energy below which an energy is left out of the picture.
const SMALL: f64 = 0.01;

/// Steps at which something is due.
#[derive(Debug, Clone, Copy)]
enum Due {
    /// Every so many steps.
    Every(u64),
    /// At multiples of [`REST_STEPS`], so many times at least while the number of steps doubles: the run alone shows
    /// how long a static stage lasts. With many times, at each of the first steps too.
    Doubling(u64),
}

impl Due {
    /// At times of so many seconds; without them as often as the two numbers say: in a dynamic stage, and in each
    /// doubling of a static one.
    fn of(simulation: &Simulation, interval: Option<f64>, [of_stage, of_doubling]: [f64; 2]) -> Self {
        let stage = simulation.stage();
        match (interval, stage.kind) {
            (Some(interval), _) => Self::Every(simulation.steps_in(interval)),
            (None, StageKind::Dynamic) => Self::Every(simulation.steps_in(stage.duration / of_stage)),
            (None, StageKind::Static) => Self::Doubling(of_doubling as u64),
        }
    }

    /// Whether it is due at the start of a step of the stage.
    fn at(self, step: u64) -> bool {
        match self {
            Self::Every(steps) => step.is_multiple_of(steps),
            Self::Doubling(times) if step < REST_STEPS => step == 0 || times > REST_STEPS,
            Self::Doubling(times) => {
                let doublings = (step / (REST_STEPS * 2 * times)).checked_ilog2().map_or(0, |power| power + 1);
                step.is_multiple_of(REST_STEPS << doublings)
            }
        }
    }
}

/// Steps between outputs of one stage.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    row: Due,
    frame: Due,
    film: Due,
    checkpoint: Option<u64>,
    first: bool,
}

impl Plan {
    /// The plan of the stage in progress.
    pub fn of(simulation: &Simulation) -> Self {
        let output = &simulation.case().output;
        Self {
            row: Due::of(simulation, output.history_interval, ROWS),
            frame: Due::of(simulation, output.frame_interval, FRAMES),
            film: film_due(simulation, output.frame_interval),
            checkpoint: output.checkpoint_interval.map(|interval| simulation.steps_in(interval)),
            first: simulation.state().stage == 0,
        }
    }

    /// Whether a row is due at the start of a step; the end of the stage before wrote that of step 0.
    pub fn row_due(&self, step: u64) -> bool {
        self.row.at(step) && self.begins(step)
    }

    /// Whether a frame is due at the start of a step.
    pub fn frame_due(&self, step: u64) -> bool {
        self.frame.at(step) && self.begins(step)
    }

    /// Whether a frame of the film is due at the start of a step.
    pub fn film_due(&self, step: u64) -> bool {
        self.film.at(step) && self.begins(step)
    }

    /// Whether a checkpoint is due at the start of a step.
    pub fn checkpoint_due(&self, step: u64) -> bool {
        step > 0 && self.checkpoint.is_some_and(|every| step.is_multiple_of(every))
    }

    fn begins(&self, step: u64) -> bool {
        step > 0 || self.first
    }
}

/// When frames of the film are due: with those of the results, unless a film would be too coarse or too long by it.
fn film_due(simulation: &Simulation, frames: Option<f64>) -> Due {
    let [least, most, of_doubling] = FILM_FRAMES;
    let (duration, kind) = (simulation.stage().duration, simulation.stage().kind);
    let frames = frames.filter(|_| kind == StageKind::Dynamic);
    let interval = frames.map(|interval| interval.clamp(duration / most, duration / least));
    Due::of(simulation, interval, [least, of_doubling])
}

/// Names and units of the columns.
pub fn columns(case: &Case) -> Vec<(String, &'static str)> {
    let mut columns = vec![("time".to_owned(), "s"), ("stage".to_owned(), "")];
    for monitor in &case.monitors {
        for (part, unit) in [("ux", "m"), ("uy", "m"), ("vx", "m/s"), ("vy", "m/s")] {
            columns.push((format!("{}_{part}", monitor.name), unit));
        }
    }
    columns.extend(ENERGIES.map(|energy| (energy.column.to_owned(), energy.unit)));
    columns.extend(REPORT_QUANTITIES.map(|quantity| (quantity.column.to_owned(), quantity.unit)));
    columns.push(("sweeps_mean".to_owned(), ""));
    columns
}

/// Displacement and velocity of all monitors.
pub fn monitors(simulation: &Simulation) -> Vec<(Vector, Vector)> {
    (0..simulation.case().monitors.len()).map(|k| simulation.monitor(k)).collect()
}

/// One row: `before` are the monitors at the start of the step, `after` at its end, `dt` its length and that of the
/// step before (s). Velocities, which live halfway between, are brought to the time of the row.
pub fn row(
    stage: u32,
    report: &StepReport,
    before: &[(Vector, Vector)],
    after: &[(Vector, Vector)],
    [dt_before, dt]: [f64; 2],
    sweeps_mean: f64,
) -> Vec<f64> {
    let mut row = vec![report.time, f64::from(stage + 1)];
    for ((u, v), (_, v_after)) in before.iter().zip(after) {
        let velocity = (v * dt + v_after * dt_before) / (dt + dt_before);
        row.extend([u.x, u.y, velocity.x, velocity.y]);
    }
    row.extend(ENERGIES.iter().map(|energy| (energy.get)(&report.ledger)));
    row.extend(REPORT_QUANTITIES.iter().map(|quantity| (quantity.get)(report)));
    row.push(sweeps_mean);
    row
}

/// The series that the picture of the histories shows, and the stages, read back from `history.csv`: displacements of
/// monitors, and the energies that are not small beside the largest.
///
/// # Errors
/// Whatever the file system refuses, or what is not a table of numbers.
pub fn series(path: &Path, case: &Case) -> io::Result<(Vec<Series>, Vec<StageStart>)> {
    let mut reader = csv::Reader::from_path(path)?;
    let headers = reader.headers()?.clone();
    // Terms of the balance that stand behind the residual are left to readers of the table.
    let pictured: Vec<&str> =
        ENERGIES.iter().map(|energy| energy.column).take_while(|column| *column != "energy_residual").collect();
    let mut series: Vec<(usize, Series)> =
        headers.iter().enumerate().filter_map(|(k, header)| Some((k, pictured_series(header, &pictured)?))).collect();
    let mut stages: Vec<StageStart> = Vec::new();
    let mut last = f64::NAN;
    for record in reader.records() {
        let record = record?;
        let number = |k: usize| record.get(k).and_then(|text| text.parse::<f64>().ok()).unwrap_or(f64::NAN);
        let stage = number(1) as usize;
        if stage > stages.len() {
            let name = case.stages.get(stage - 1).map_or(String::new(), |stage| stage.name.clone());
            // The row at the start of a later stage is that of the end of the stage before.
            stages.push(StageStart { name, time: if stages.is_empty() { number(0) } else { last } });
        }
        last = number(0);
        for (k, series) in &mut series {
            series.points.push((number(0), number(*k)));
        }
    }
    let size = |series: &Series| series.points.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    let energies = series.iter().filter(|(_, series)| series.quantity == ENERGY);
    let least = SMALL * energies.map(|(_, series)| size(series)).fold(0.0, f64::max);
    let matters = |series: &Series| series.quantity != ENERGY || (size(series) > 0.0 && size(series) >= least);
    Ok((series.into_iter().map(|(_, series)| series).filter(matters).collect(), stages))
}

/// The empty series of a column; none if the picture leaves it out.
fn pictured_series(header: &str, energies: &[&str]) -> Option<Series> {
    let (column, unit) = header.strip_suffix(']')?.rsplit_once(" [")?;
    let of = |name: String, quantity: &str| {
        Some(Series { name, quantity: quantity.to_owned(), unit: unit.to_owned(), points: Vec::new() })
    };
    match column.rsplit_once('_') {
        Some((monitor, part @ ("ux" | "uy"))) if unit == "m" => of(format!("{monitor} {part}"), "displacement"),
        _ if unit == "J/m" && energies.contains(&column) => of(column.replace('_', " "), ENERGY),
        _ => None,
    }
}
