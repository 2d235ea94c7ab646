//! Columns and rows of `history.csv`, and how often rows, frames and checkpoints are due.

use std::io;
use std::path::Path;

use enmm::geometry::Vector;
use enmm::model::case::{Axis, StageKind};
use enmm::model::settle::REST_STEPS;
use enmm::model::{
    Case, JOINT_MONITOR_QUANTITIES, JointMonitorState, MONITOR_STRESS_QUANTITIES, Simulation, StepReport, Stress,
};
use enmm_observe::{ENERGIES, MONITOR_QUANTITIES, REPORT_QUANTITIES, bolts};
use enmm_picture::{Series, StageStart};

use crate::earthquake;

/// Rows of a stage that names no interval: of a dynamic one, and of a static one each time that its
/// number of steps doubles.
const ROWS: [f64; 2] = [500.0, 32.0];
/// Frames of a stage that names no interval: of a dynamic one, and of a doubling of the steps of a static one.
const FRAMES: [f64; 2] = [20.0, 2.0];
/// Least and most frames of the film of a dynamic stage, and those of a doubling of the steps of a static one.
const FILM_FRAMES: [f64; 3] = [60.0, 200.0, 6.0];

/// More bolts than this have one column, with the largest tension of all.
const BOLTS_MAX: usize = 50;
/// Share of a step by which a time that is one of whole steps may fall short of it, by rounding.
const WHOLE: f64 = 1e-6;
/// End of the name of the column of a bolt.
const TENSION: &str = "_tension";
/// Quantity of the energies in their picture.
const ENERGY: &str = "energy";
/// Quantities of monitors in the picture of the histories that dynamic stages alone show.
const VELOCITY: &str = "velocity";
const ACCELERATION: &str = "acceleration";
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
            row: Due::of(simulation, row_interval(simulation), ROWS),
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

/// Time (s) between rows: that of the case, else a short one while a ground motion shakes the slope.
fn row_interval(simulation: &Simulation) -> Option<f64> {
    let case = simulation.case();
    let is_shaken = case.is_shaken(simulation.state().stage as usize);
    // Whole steps, and not more of them than the time has.
    let steps = |time: f64| (time / simulation.model().dt + WHOLE).floor().max(1.0);
    let shortest = || {
        let interval = (simulation.stage().duration / ROWS[0]).min(earthquake::ROW_INTERVAL);
        simulation.model().dt * steps(interval)
    };
    case.output.history_interval.or_else(|| is_shaken.then(shortest))
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
        columns.extend(MONITOR_QUANTITIES.map(|q| (format!("{}_{}", monitor.name, q.column), q.unit)));
        if monitor.stress {
            columns.extend(MONITOR_STRESS_QUANTITIES.map(|q| (format!("{}_{}", monitor.name, q.column), q.unit)));
        }
    }
    for monitor in &case.joint_monitors {
        columns.extend(JOINT_MONITOR_QUANTITIES.map(|q| (format!("{}_{}", monitor.name, q.column), q.unit)));
    }
    columns.extend(ENERGIES.map(|energy| (energy.column.to_owned(), energy.unit)));
    columns.extend(REPORT_QUANTITIES.map(|quantity| (quantity.column.to_owned(), quantity.unit)));
    columns.push(("sweeps_mean".to_owned(), ""));
    columns.extend(bolt_columns(case).into_iter().map(|name| (name, "N")));
    columns.extend(earthquake::columns(case));
    columns
}

/// Names of the columns of bolts: one for each, or one for all where they are many.
fn bolt_columns(case: &Case) -> Vec<String> {
    let own = |(k, bolt): (usize, &enmm::model::case::Bolt)| match &bolt.name {
        Some(name) => format!("bolt_{name}{TENSION}"),
        None => format!("bolt_{}{TENSION}", k + 1),
    };
    match case.bolts.len() {
        0..=BOLTS_MAX => case.bolts.iter().enumerate().map(own).collect(),
        _ => vec![format!("bolts_largest{TENSION}")],
    }
}

/// Largest tension (N) along one bar of each bolt, 0 before it is installed; the values of [`bolt_columns`].
pub fn tensions(simulation: &Simulation) -> Vec<f64> {
    let case = simulation.case();
    let mut all = vec![0.0; case.bolts.len()];
    for line in bolts(simulation) {
        let k = line.bolt as usize;
        all[k] = f64::max(all[k], line.force * case.bolts[k].spacing);
    }
    if all.len() > BOLTS_MAX { vec![all.into_iter().fold(0.0, f64::max)] } else { all }
}

/// Displacement and velocity of all monitors.
pub fn monitors(simulation: &Simulation) -> Vec<(Vector, Vector)> {
    (0..simulation.case().monitors.len()).map(|k| simulation.monitor(k)).collect()
}

/// Numbers of monitors of stress and of joints at the time of a row.
#[derive(Debug)]
pub struct Readings {
    stresses: Vec<Option<Stress>>,
    joints: Vec<JointMonitorState>,
}

impl Readings {
    /// Those of now.
    pub fn of(simulation: &Simulation) -> Self {
        let monitors = 0..simulation.case().monitors.len();
        let stresses = monitors.map(|k| simulation.monitor_stress(k)).collect();
        Self { stresses, joints: simulation.joint_monitors().to_vec() }
    }
}

/// One row: `before` are the monitors at the start of the step, `after` at its end, `dt` its length and that of the
/// step before (s), `readings` those of stress and joints at its start, `tensions` those of the bolts at its end.
/// Velocities, which live halfway between, are brought to the time of the row.
pub fn row(
    stage: u32,
    report: &StepReport,
    before: &[(Vector, Vector)],
    after: &[(Vector, Vector)],
    [dt_before, dt]: [f64; 2],
    (sweeps_mean, readings): (f64, &Readings),
    tensions: &[f64],
) -> Vec<f64> {
    let mut row = vec![report.time, f64::from(stage + 1)];
    for (((u, v), (_, v_after)), stress) in before.iter().zip(after).zip(&readings.stresses) {
        let velocity = (v * dt + v_after * dt_before) / (dt + dt_before);
        row.extend(MONITOR_QUANTITIES.iter().map(|quantity| (quantity.get)(&(*u, velocity))));
        row.extend(stress.iter().flat_map(|stress| MONITOR_STRESS_QUANTITIES.map(|quantity| (quantity.get)(stress))));
    }
    for joint in &readings.joints {
        row.extend(JOINT_MONITOR_QUANTITIES.iter().map(|quantity| (quantity.get)(joint)));
    }
    row.extend(ENERGIES.iter().map(|energy| (energy.get)(&report.ledger)));
    row.extend(REPORT_QUANTITIES.iter().map(|quantity| (quantity.get)(report)));
    row.push(sweeps_mean);
    row.extend(tensions);
    row
}

/// What the pictures of the histories show.
pub struct Histories {
    /// Displacement of monitors; their velocity in dynamic stages, the motion of the base, tension of bolts.
    pub series: Vec<Series>,
    /// Energies that are not small beside the largest.
    pub energies: Vec<Series>,
    /// Stages that have rows.
    pub stages: Vec<StageStart>,
}

/// Series and stages, read back from `history.csv`.
///
/// # Errors
/// Whatever the file system refuses, or what is not a table of numbers.
pub fn histories(path: &Path, case: &Case) -> io::Result<Histories> {
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
            let of_case = case.stages.get(stage - 1);
            let name = of_case.map_or(String::new(), |stage| stage.name.clone());
            // The row at the start of a later stage is that of the end of the stage before.
            let time = if stages.is_empty() { number(0) } else { last };
            stages.push(StageStart { name, time, is_static: of_case.is_none_or(|s| s.kind == StageKind::Static) });
        }
        last = number(0);
        let is_static = stages.last().is_none_or(|stage| stage.is_static);
        for (k, series) in &mut series {
            let hidden = is_static && moves(series);
            series.points.push((number(0), if hidden { f64::NAN } else { number(*k) }));
        }
    }
    let (energies, mut series): (Vec<_>, Vec<_>) =
        series.into_iter().map(|(_, series)| series).partition(|series| series.quantity == ENERGY);
    series.retain(|series| !moves(series) || series.points.iter().any(|point| point.1.is_finite()));
    series.extend(base_motions(case, &stages, last));
    let size = |series: &Series| series.points.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
    let least = SMALL * energies.iter().map(size).fold(0.0, f64::max);
    let energies = energies.into_iter().filter(|series| size(series) > 0.0 && size(series) >= least).collect();
    Ok(Histories { series, energies, stages })
}

/// Whether a series has a meaning in dynamic stages alone.
fn moves(series: &Series) -> bool {
    [VELOCITY, ACCELERATION].contains(&series.quantity.as_str())
}

/// The motion of the base from the stage on with which it begins, in dynamic stages.
fn base_motions(case: &Case, stages: &[StageStart], end: f64) -> Vec<Series> {
    let motion = |base: &enmm::model::case::BaseMotion| {
        let start = stages.get(case.motion_stage(base.stage.as_deref())?)?.time;
        let is_dynamic = |time: f64| stages.iter().rev().find(|stage| stage.time <= time).is_some_and(|s| !s.is_static);
        let rows = base.table.as_ref()?.iter().map(|[time, value]| (start + time, base.scale * value));
        let points: Vec<(f64, f64)> = rows.filter(|(time, _)| *time <= end && is_dynamic(*time)).collect();
        let name = if base.axis == Axis::X { "base x" } else { "base y" };
        (!points.is_empty()).then(|| Series {
            name: name.to_owned(),
            quantity: format!("base {}", base.kind.name()),
            unit: base.kind.unit().to_owned(),
            points,
        })
    };
    case.base_motions.iter().filter_map(motion).chain(waves(case, stages, end)).collect()
}

/// Particle velocities of the waves that come in through quiet boundaries.
fn waves(case: &Case, stages: &[StageStart], end: f64) -> Vec<Series> {
    let of = |quiet: &enmm::model::case::Quiet| -> Option<Vec<Series>> {
        let start = stages.get(case.motion_stage(quiet.stage.as_deref())?)?.time;
        let (wave, rows) = (quiet.wave?, quiet.table.as_ref()?);
        let series = |(name, part): (&str, f64)| Series {
            name: name.to_owned(),
            quantity: "incoming wave".to_owned(),
            unit: "m/s".to_owned(),
            points: rows
                .iter()
                .map(|[time, factor]| (start + time, quiet.scale * factor * part))
                .filter(|(time, _)| *time <= end)
                .collect(),
        };
        let parts = [("wave x", wave[0]), ("wave y", wave[1])].into_iter().filter(|(_, part)| *part != 0.0);
        Some(parts.map(series).filter(|series| !series.points.is_empty()).collect())
    };
    case.quiets.iter().filter_map(of).flatten().collect()
}

/// The empty series of a column; none if the pictures leave it out.
fn pictured_series(header: &str, energies: &[&str]) -> Option<Series> {
    let (column, unit) = header.strip_suffix(']')?.rsplit_once(" [")?;
    let of = |name: String, quantity: &str| {
        Some(Series { name, quantity: quantity.to_owned(), unit: unit.replace("s2", "s²"), points: Vec::new() })
    };
    match column.rsplit_once('_') {
        Some((monitor, "ux")) if unit == "m" => of(format!("{monitor} x"), "displacement"),
        Some((monitor, "uy")) if unit == "m" => of(format!("{monitor} y"), "displacement"),
        Some((monitor, "vx")) if unit == "m/s" => of(format!("{monitor} x"), VELOCITY),
        Some((monitor, "vy")) if unit == "m/s" => of(format!("{monitor} y"), VELOCITY),
        Some((gauge, "opening")) if unit == "m" => of(gauge.to_owned(), "opening of joints"),
        Some((gauge, "slip")) if unit == "m" => of(gauge.to_owned(), "slip of joints"),
        Some((monitor, "ax")) if unit == "m/s2" => of(format!("{monitor} x"), ACCELERATION),
        Some((monitor, "ay")) if unit == "m/s2" => of(format!("{monitor} y"), ACCELERATION),
        Some((bolt, "tension")) if unit == "N" => of(bolt.replace('_', " "), "tension of a bar"),
        _ if unit == "J/m" && energies.contains(&column) => of(column.replace('_', " "), ENERGY),
        _ => None,
    }
}
