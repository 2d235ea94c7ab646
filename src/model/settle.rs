//! A stage run to its end: the one loop that runs, co-simulation, benchmarks, factors of safety and tests share.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::step::{StepError, StepReport};

use super::Simulation;
use super::case::StageKind;

/// Steps between reports of a static stage, which show whether it is at rest.
pub const REST_STEPS: u64 = 10;

/// Steps between two looks of a run whether a static stage has run away ([`Simulation::has_run_away`]).
pub const RUNAWAY_STEPS: u64 = 100;

/// Takes steps until the stage in progress of a simulation is over; `of` finds it in its `host`. `step` takes one
/// step, and returns its report when it requested one. Returns that of the last step, or the error that ended it.
///
/// # Errors
/// The first one of `step`.
pub fn until_over<H, E>(
    host: &mut H,
    of: impl Fn(&H) -> &Simulation,
    mut step: impl FnMut(&mut H) -> Result<Option<StepReport>, E>,
) -> Result<Option<StepReport>, E> {
    let mut last = None;
    while !of(host).stage_is_over(last.as_ref()) {
        last = step(host)?;
    }
    Ok(last)
}

impl Simulation {
    /// Whether the report of the next step says if a static stage is at rest. Reports for outputs do not: how often
    /// they are written changes no result.
    pub fn rest_due(&self) -> bool {
        self.stage().kind == StageKind::Static && self.state().stage_step.is_multiple_of(REST_STEPS)
    }

    /// Runs the stage in progress to its end; returns the last report.
    ///
    /// # Errors
    /// A numerical failure.
    pub fn run_stage(&mut self) -> Result<StepReport, StepError> {
        Ok(self.run_stage_with(REST_STEPS, None)?.unwrap_or_default())
    }

    /// As [`Simulation::run_stage`], with a report at every `every`th step of the stage; none when a flag was raised.
    ///
    /// # Errors
    /// A numerical failure.
    pub fn run_stage_with(
        &mut self,
        every: u64,
        interrupt: Option<&AtomicBool>,
    ) -> Result<Option<StepReport>, StepError> {
        let mut last = StepReport::default();
        let step = |simulation: &mut Self| {
            if interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
                return Err(None);
            }
            let wanted = simulation.state().stage_step.is_multiple_of(every);
            let report = simulation.advance(wanted).map_err(Some)?;
            if wanted {
                last = report;
            }
            Ok(wanted.then_some(report))
        };
        match until_over(self, |simulation| simulation, step) {
            Ok(_) => Ok(Some(last)),
            Err(None) => Ok(None),
            Err(Some(error)) => Err(error),
        }
    }
}
