//! Earthquakes in a run: accelerations of monitors in the histories, and measures of records and monitors.

mod files;
mod history;
mod seismogram;

use std::io;
use std::path::Path;

use serde::Serialize;

use enmm::model::case::STANDARD_GRAVITY;
use enmm::model::{Case, Simulation};
use enmm_seismology::{DAMPING, periods};

pub use seismogram::{Place, Seismogram, records};

pub(crate) use files::{clear, draw, write};
pub(crate) use history::{accelerations, columns, is_shaken};

/// Longest time (s) between rows of a stage that a ground motion shakes, where the case names none: that of
/// accelerographs with 200 samples in a second.
pub const ROW_INTERVAL: f64 = 0.005;
/// Least number of rows in a period for which monitors have a spectrum.
pub const ROWS_OF_PERIOD: f64 = 4.0;

/// Stages, one after the other, in which ground motions act.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EarthquakeRecord {
    /// Names of the stages.
    pub stages: Vec<String>,
    /// Time (s) at its start and at the last row.
    pub time: [f64; 2],
    /// Longest time (s) between rows: accelerations of monitors are means over it.
    pub interval: f64,
    /// Records of the case that begin in these stages, and monitors.
    pub motions: Vec<MotionRecord>,
    /// The motions themselves.
    #[serde(skip)]
    pub seismograms: Vec<Seismogram>,
}

/// Measures of a motion along an axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionRecord {
    /// Name of the monitor, or place of the record in the case.
    pub name: String,
    /// Whether it is that of a monitor, of a base, or of an outcrop.
    pub of: Place,
    /// `x` or `y`.
    pub axis: &'static str,
    /// Peak ground acceleration (m/s²).
    pub pga: f64,
    /// The same over the standard gravity.
    pub pga_g: f64,
    /// Peak ground velocity (m/s).
    pub pgv: f64,
    /// Peak ground displacement (m) since the start.
    pub pgd: f64,
    /// Arias intensity (m/s).
    pub arias: f64,
    /// Significant duration D5–95 (s).
    pub duration: f64,
}

impl EarthquakeRecord {
    /// Those of a run, by the rows of its `history.csv`; none where no ground motion acts.
    ///
    /// # Errors
    /// Whatever the file system refuses, with the path in the message, or a file that no run has written.
    pub(crate) fn all(simulation: &Simulation, history: &Path) -> io::Result<Vec<Self>> {
        let case = simulation.case();
        let spans = history::spans(case);
        if spans.is_empty() {
            return Ok(Vec::new());
        }
        let read = history::read(history, simulation, &spans)?;
        Ok(spans.into_iter().zip(read).filter_map(|(stages, rows)| Self::of(case, stages, rows)).collect())
    }

    /// That of stages by their rows; none of stages that have not begun.
    fn of(case: &Case, stages: std::ops::Range<usize>, rows: history::Rows) -> Option<Self> {
        let time = [*rows.times.first()?, *rows.times.last()?];
        let interval = rows.times.windows(2).map(|two| two[1] - two[0]).fold(0.0, f64::max);
        let mut seismograms = records(case);
        seismograms.retain(|record| record.stage.is_some_and(|stage| stages.contains(&stage)));
        seismograms.extend(rows.seismograms());
        let motions = seismograms.iter().map(MotionRecord::of).collect();
        let stages = case.stages[stages].iter().map(|stage| stage.name.clone()).collect();
        Some(Self { stages, time, interval, motions, seismograms })
    }

    /// Periods (s), and pseudo-accelerations (m/s²) of each motion with 5 % of damping. Those of monitors are NaN for
    /// periods of fewer than four rows.
    pub fn spectra(&self) -> (Vec<f64>, Vec<Vec<f64>>) {
        let all = periods(0.0);
        let spectrum = |motion: &Seismogram| {
            let least = if motion.of == Place::Monitor { ROWS_OF_PERIOD * self.interval } else { 0.0 };
            let shown = periods((1.0 - 1e-6) * least);
            let mut values = vec![f64::NAN; all.len() - shown.len()];
            values.extend(motion.acceleration.spectrum(&shown, DAMPING));
            values
        };
        let values = self.seismograms.iter().map(spectrum).collect();
        (all, values)
    }

    /// A doubt about rows that are too far apart for the accelerations of an earthquake.
    pub(crate) fn doubt(&self) -> Option<String> {
        // Rows stand at whole steps.
        (self.interval > 4.0 * ROW_INTERVAL).then(|| {
            format!(
                "stage {:?}: rows of the history are {:.4} s apart, so that peaks of monitors are too low, and their \
                 spectra begin at {:.3} s: leave output.history_interval out, or give {ROW_INTERVAL} s",
                self.stages.join(", "),
                self.interval,
                ROWS_OF_PERIOD * self.interval
            )
        })
    }
}

impl MotionRecord {
    fn of(motion: &Seismogram) -> Self {
        let measures = motion.measures(STANDARD_GRAVITY);
        Self {
            name: motion.name.clone(),
            of: motion.of,
            axis: motion.axis_name(),
            pga: measures.acceleration,
            pga_g: measures.acceleration / STANDARD_GRAVITY,
            pgv: measures.velocity,
            pgd: measures.displacement,
            arias: measures.arias,
            duration: measures.duration,
        }
    }
}
