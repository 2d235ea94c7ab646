//! How much simulated time a run still needs. A static stage ends when its unbalanced ratio has fallen to the target.
//! The fall is exponential once the ramp is over: a line through its logarithm shows when that will be. Without a ramp
//! it begins slowly and follows a curve of its own.

use enmm::model::case::StageKind;
use enmm::model::{Simulation, StepReport};

use super::load_at_once;

/// Reports after the ramp from which on a line is drawn through them.
const FEWEST: usize = 6;
/// Share of the reports after the ramp that the line is drawn through: the last ones.
const LAST: f64 = 0.5;
/// Ramps that a static stage lasts, about, as long as nothing else is known of it.
const RAMPS: f64 = 2.0;

/// The fall of the unbalanced ratio in the static stage in progress, and what earlier stages took.
#[derive(Debug, Default)]
pub struct Outlook {
    stage: u32,
    /// Times (s) since the start of the stage and logarithms of the ratio, after the ramp.
    fall: Vec<[f64; 2]>,
    /// Time (s) since the start of the stage at which it will be at rest.
    rest: Option<f64>,
    /// Simulated times (s) of the static stages that are over.
    taken: Vec<f64>,
}

impl Outlook {
    /// Takes note of a report.
    pub fn note(&mut self, simulation: &Simulation, report: &StepReport) {
        let state = simulation.state();
        if state.stage != self.stage {
            self.stage = state.stage;
            self.fall.clear();
            self.rest = None;
        }
        let now = report.time - state.stage_start;
        let Some((ramp, target)) = simulation.rest_target() else { return };
        if now > ramp && report.unbalanced > 0.0 {
            self.fall.push([now, libm::log(report.unbalanced)]);
            self.rest = self.rest_time(ramp, target);
        }
    }

    /// Takes note of a static stage that is over, after so much simulated time (s).
    pub fn end(&mut self, time: f64) {
        self.taken.push(time);
    }

    /// Simulated time (s) that the run still needs, as far as can be expected; none while nothing is known of the
    /// stage in progress.
    pub fn left(&self, simulation: &Simulation) -> Option<f64> {
        let state = simulation.state();
        let time = simulation.time() - state.stage_start;
        let most = (simulation.stage().duration - time).max(0.0);
        let own = match simulation.rest_target() {
            None => most,
            Some((ramp, _)) => {
                let line = self.rest.filter(|_| self.stage == state.stage);
                let end = line.or_else(|| (ramp > 0.0).then_some(RAMPS * ramp)).or_else(|| self.usual())?;
                (end - time).clamp(0.0, most)
            }
        };
        let number = state.stage as usize + 1;
        let settled = self.usual().unwrap_or(time + own);
        let later = simulation.case().stages[number..].iter().map(|stage| match stage.kind {
            StageKind::Static => settled.min(stage.duration),
            StageKind::Dynamic => stage.duration,
        });
        Some(own + later.sum::<f64>())
    }

    /// Mean time (s) of the static stages so far.
    fn usual(&self) -> Option<f64> {
        (!self.taken.is_empty()).then(|| self.taken.iter().sum::<f64>() / self.taken.len() as f64)
    }

    /// Time (s) since the start of the stage at which the ratio will have reached the target.
    fn rest_time(&self, ramp: f64, target: f64) -> Option<f64> {
        if self.fall.len() < FEWEST {
            return None;
        }
        let last = &self.fall[((1.0 - LAST) * self.fall.len() as f64) as usize..];
        let count = last.len() as f64;
        let mean = |k: usize| last.iter().map(|point| point[k]).sum::<f64>() / count;
        let (time, ratio) = (mean(0), mean(1));
        let square: f64 = last.iter().map(|point| (point[0] - time).powi(2)).sum();
        let product: f64 = last.iter().map(|point| (point[0] - time) * (point[1] - ratio)).sum();
        let slope = product / square;
        let line = (slope < 0.0).then(|| time + (libm::log(target) - ratio) / slope)?;
        let at_once = if ramp > 0.0 { None } else { load_at_once::rest_time(time, ratio, slope, libm::log(target)) };
        Some(at_once.unwrap_or(line))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exponential_fall_ends_where_it_meets_the_target() {
        let fall = (1..20).map(|k| 0.1 * f64::from(k)).map(|t| [t, 2.0 - 5.0 * t]).collect();
        let outlook = Outlook { fall, ..Outlook::default() };
        let end = outlook.rest_time(0.1, (-18.0f64).exp()).expect("a line");
        assert!((end - 4.0).abs() < 1e-12, "{end}");
    }

    #[test]
    fn a_ratio_that_grows_gives_no_time() {
        let fall = (1..20).map(f64::from).map(|t| [t, t]).collect();
        assert_eq!(Outlook { fall, ..Outlook::default() }.rest_time(0.1, 1e-5), None);
    }
}
