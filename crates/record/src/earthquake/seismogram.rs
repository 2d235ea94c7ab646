//! The motion of a place along an axis: of a monitor, or of the ground that a record of the case moves.

use serde::Serialize;

use enmm::model::Case;
use enmm::model::case::{Axis, BaseMotion, BaseMotionKind, Quiet};
use enmm_seismology::{Accelerogram, Measures, Unusable};

/// How many times the wave in it the surface of rock moves.
const OUTCROP: f64 = 2.0;

/// Whose motion it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// A monitor.
    Monitor,
    /// Fixities that move by a record.
    Base,
    /// The surface of rock of which the wave that comes in through a quiet boundary is half.
    Outcrop,
}

/// The motion of a place along an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Seismogram {
    /// Name of the monitor, or place of the record in the case, such as `quiet[0]`.
    pub name: String,
    /// Whose motion it is.
    pub of: Place,
    /// Index of the stage with whose start a record begins.
    pub stage: Option<usize>,
    /// Axis.
    pub axis: Axis,
    /// Acceleration (m/s²) over time (s): of records since the start of their stage.
    pub acceleration: Accelerogram,
    /// Peaks of velocity (m/s) and displacement (m), where they are known better than by the acceleration.
    pub peaks: Option<[f64; 2]>,
}

impl Seismogram {
    /// Its measures.
    pub fn measures(&self, gravity: f64) -> Measures {
        let measures = self.acceleration.measures(gravity);
        match self.peaks {
            Some([velocity, displacement]) => Measures { velocity, displacement, ..measures },
            None => measures,
        }
    }

    /// `x` or `y`.
    pub fn axis_name(&self) -> &'static str {
        if self.axis == Axis::X { "x" } else { "y" }
    }

    /// Name and axis.
    pub fn label(&self) -> String {
        match self.of {
            Place::Outcrop => format!("{} outcrop {}", self.name, self.axis_name()),
            Place::Monitor | Place::Base => format!("{} {}", self.name, self.axis_name()),
        }
    }
}

/// The records of a case that move the ground, as they act: bases, and the outcrops of waves. A record without two
/// rows that differ in time has no motion.
pub fn records(case: &Case) -> Vec<Seismogram> {
    let bases = case.base_motions.iter().enumerate().filter_map(|(k, base)| of_base(case, k, base));
    let waves = case.quiets.iter().enumerate().flat_map(|(k, quiet)| of_wave(case, k, quiet));
    bases.chain(waves).collect()
}

/// Velocity (m/s) and displacement (m) of the base along both axes at a time (s), where the stages of a case have begun
/// at `starts` (s). The motions of a model count from its base.
pub fn base_motion(case: &Case, starts: &[f64], time: f64) -> [[f64; 2]; 2] {
    let mut sums = [[0.0; 2]; 2];
    for base in &case.base_motions {
        let start = case.motion_stage(base.stage.as_deref()).and_then(|stage| starts.get(stage));
        let (Some(start), Some(rows)) = (start, &base.table) else { continue };
        let along = &mut sums[usize::from(base.axis == Axis::Y)];
        for (sum, part) in along.iter_mut().zip(motion_of(rows, base.kind, time - start)) {
            *sum += base.scale * part;
        }
    }
    sums
}

/// Velocity and displacement of rows at a time since the start of their stage.
fn motion_of(rows: &[[f64; 2]], kind: BaseMotionKind, since: f64) -> [f64; 2] {
    if kind == BaseMotionKind::Acceleration {
        return Accelerogram::new(rows.to_vec()).map_or([0.0; 2], |motion| motion.motion_at(since));
    }
    let (mut velocity, mut way) = (0.0, 0.0);
    for two in rows.windows(2).take_while(|two| two[0][0] < since) {
        let [[start, first], [end, last]] = [two[0], two[1]];
        let part = (since - start).min(end - start);
        velocity = first + (last - first) * part / (end - start);
        way += 0.5 * (first + velocity) * part;
    }
    let after = rows.last().map_or(0.0, |last| (since - last[0]).max(0.0));
    [velocity, way + velocity * after]
}

fn of_base(case: &Case, k: usize, base: &BaseMotion) -> Option<Seismogram> {
    let rows: Vec<[f64; 2]> = base.table.as_ref()?.iter().map(|[time, value]| [*time, base.scale * value]).collect();
    let (acceleration, peaks) = match base.kind {
        BaseMotionKind::Acceleration => (Accelerogram::new(rows), None),
        _ => of_velocity(&rows),
    };
    Some(Seismogram {
        name: format!("base_motion[{k}]"),
        of: Place::Base,
        stage: case.motion_stage(base.stage.as_deref()),
        axis: base.axis,
        acceleration: acceleration.ok()?,
        peaks,
    })
}

fn of_wave(case: &Case, k: usize, quiet: &Quiet) -> Vec<Seismogram> {
    let (Some(wave), Some(table)) = (quiet.wave, &quiet.table) else { return Vec::new() };
    let stage = case.motion_stage(quiet.stage.as_deref());
    let along = |(axis, part): (Axis, f64)| {
        let factor = OUTCROP * quiet.scale * part;
        let rows: Vec<[f64; 2]> = table.iter().map(|[time, value]| [*time, factor * value]).collect();
        let (acceleration, peaks) = of_velocity(&rows);
        let acceleration = acceleration.ok().filter(|_| part != 0.0)?;
        Some(Seismogram { name: format!("quiet[{k}]"), of: Place::Outcrop, stage, axis, acceleration, peaks })
    };
    [(Axis::X, wave[0]), (Axis::Y, wave[1])].into_iter().filter_map(along).collect()
}

/// Accelerations between rows of velocity, and the peaks of velocity and displacement.
fn of_velocity(rows: &[[f64; 2]]) -> (Result<Accelerogram, Unusable>, Option<[f64; 2]>) {
    let fastest = rows.iter().map(|row| row[1].abs()).fold(0.0, f64::max);
    let (mut way, mut farthest) = (0.0, 0.0f64);
    for two in rows.windows(2) {
        way += 0.5 * (two[0][1] + two[1][1]) * (two[1][0] - two[0][0]);
        farthest = farthest.max(f64::abs(way));
    }
    (Accelerogram::of_velocity(rows), Some([fastest, farthest]))
}
