//! Communication steps, one internal step at a time, so that the importer can be told and asked in between.

use enmm::cosimulation::{CosimulationError, Event, EventKind, Interval};
use enmm::model::case::keys::{Plain, rounded};

use crate::log::{Category, Status};
use crate::phase::{Call, Phase};

use super::ramps::Rate;
use super::{Failure, Instance};

/// Part of the experiment by which sums of steps may pass the stop time.
const STOP_TOLERANCE: f64 = 1e-9;
/// Rounding of times, relative.
const STOP_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A communication step in progress.
#[derive(Debug)]
pub struct Step {
    interval: Interval,
    /// Begin and end as the importer counts (s).
    begin: f64,
    end: f64,
    events_seen: usize,
    /// Values at the end of inputs that have a derivative.
    ramps: Vec<Rate>,
    /// Whether it ends before the end that was asked for.
    early: bool,
    done: bool,
}

impl Step {
    /// Whether there is nothing left to do.
    pub fn is_done(&self) -> bool {
        self.done
    }

    /// Whether it ended before its end.
    pub fn is_early(&self) -> bool {
        self.early
    }
}

/// Messages to the importer in between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Update {
    /// Time that the model has reached (s).
    pub time: f64,
    /// Whether the importer may ask for an early return.
    pub can_return_early: bool,
}

impl Instance {
    /// Begins a step from `t` over `h`.
    ///
    /// # Errors
    /// The status of the call.
    pub fn begin_step(&mut self, t: f64, h: f64) -> Result<Step, Status> {
        let begun = self.allow(Call::DoStep).and_then(|()| self.begin(t, h));
        begun.map_err(|failure| self.fail(failure))
    }

    fn begin(&mut self, t: f64, h: f64) -> Result<Step, Failure> {
        let end = t + h;
        if let Some(stop) = self.experiment.stop
            && end > stop + STOP_TOLERANCE * (stop - self.experiment.start) + STOP_ROUNDING * stop.abs()
        {
            return Err(format!(
                "the step ends at {} s, must not end after the stop time, {} s",
                Plain(end),
                Plain(stop)
            ));
        }
        let now = (t - self.time).abs() <= self.same_time(self.time);
        if !now {
            return Err(CosimulationError::Time { given: t, own: self.time }.to_string());
        }
        let ramps = self.begin_ramps(h)?;
        let interval = self.model.begin(self.model.time(), h).map_err(|error| error.to_string())?;
        self.cache.clear();
        self.phase = Phase::Stepping;
        Ok(Step { interval, begin: self.time, end, events_seen: 0, ramps, early: false, done: false })
    }

    /// Difference (s) below which two times of the importer near `t` are the same: the digits that its sums lose. Far
    /// from time 0 these are more than the model, which counts from its own start, could bear.
    fn same_time(&self, t: f64) -> f64 {
        self.model.same_time(t).max(4.0 * f64::EPSILON * t.abs())
    }

    /// Takes one internal step.
    pub fn advance_step(&mut self, step: &mut Step) -> Status {
        let advanced = self.model.advance(&mut step.interval);
        self.cache.clear();
        match advanced {
            Ok(more) => {
                self.log_events(step);
                let event = step.events_seen < step.interval.info().events.len();
                step.events_seen = step.interval.info().events.len();
                match (more, event && self.early_return) {
                    (true, true) => self.leave(step),
                    (true, false) => Status::Ok,
                    (false, _) => self.finish(step),
                }
            }
            Err(error) => self.discard(step, &error),
        }
    }

    fn finish(&mut self, step: &mut Step) -> Status {
        step.done = true;
        (self.phase, self.time) = (Phase::Step, step.end);
        self.end_ramps(&step.ramps);
        let unsettled = step.interval.info().unsettled;
        if unsettled > 0 {
            let text = format!("the contacts of {unsettled} sub-steps did not settle; they went on unsettled");
            self.log(Status::Warning, Category::Warning, text);
        }
        self.warn_of(step.interval.info().doubt.clone());
        self.warn_of_failure(step.interval.info().failure);
        self.warn_of_lost_record();
        Status::Ok
    }

    /// Ends the step where the model stands.
    fn leave(&mut self, step: &mut Step) -> Status {
        let info = self.model.leave(step.interval.clone());
        self.warn_of(info.doubt);
        self.warn_of_failure(info.failure);
        (step.done, step.early) = (true, true);
        self.phase = Phase::Step;
        self.time = self.time_of_model();
        Status::Ok
    }

    /// The model has gone back to where the step began. Only a numerical failure can go better with a shorter step.
    fn discard(&mut self, step: &mut Step, error: &CosimulationError) -> Status {
        (step.done, step.early) = (true, false);
        (self.phase, self.time) = (Phase::Step, step.begin);
        if !matches!(error, CosimulationError::Step(_)) {
            return self.fail(error.to_string());
        }
        if self.table.version == crate::table::Version::Two {
            self.phase = Phase::StepFailed;
        }
        self.log(Status::Discard, Category::Discard, format!("the step was discarded: {error}"));
        Status::Discard
    }

    fn log_events(&mut self, step: &Step) {
        for event in &step.interval.info().events[step.events_seen..] {
            self.log_event(event);
        }
    }

    /// Logs an event; an overlap is a warning.
    pub(super) fn log_event(&mut self, event: &Event) {
        let (status, category) = match event.kind {
            EventKind::Overlapped => (Status::Warning, Category::Warning),
            EventKind::Detached | EventKind::Slipped | EventKind::Failed | EventKind::Broken | EventKind::Cut => {
                (Status::Ok, Category::Events)
            }
        };
        self.log(status, category, event_text(event, self.experiment.start, self.model.case().mesh.size));
    }

    /// Time that the model itself has reached (s).
    pub fn time_of_model(&self) -> f64 {
        self.experiment.start + self.model.time()
    }

    /// Enters intermediate update mode.
    pub fn enter_update(&mut self, step: &Step) -> Update {
        self.phase = Phase::Intermediate;
        if !step.done {
            self.time = self.time_of_model();
        }
        Update { time: self.time, can_return_early: self.early_return && !step.done }
    }

    /// Leaves intermediate update mode; `wanted` is the time (s) of an early return.
    pub fn leave_update(&mut self, step: &mut Step, wanted: Option<f64>) -> Status {
        self.phase = if step.done { Phase::Step } else { Phase::Stepping };
        if std::mem::take(&mut self.spoiled) {
            if !step.done {
                self.leave(step);
            }
            return self.fail("an illegal call within intermediate update mode has ended the step".to_owned());
        }
        match wanted.filter(|_| self.early_return && !step.done) {
            Some(wanted) => self.return_at(step, wanted),
            None => Status::Ok,
        }
    }

    /// Makes a step end at a time (s) that the importer wants, but neither before now nor after its end.
    fn return_at(&mut self, step: &mut Step, wanted: f64) -> Status {
        let (left, same) = (wanted - self.time, self.same_time(self.time));
        if left <= same {
            return self.leave(step);
        }
        if wanted < step.end - same {
            self.model.shorten(&mut step.interval, self.model.time() + left);
            (step.end, step.early) = (wanted, true);
        }
        Status::Ok
    }
}

/// An event in words, for an experiment that starts at `start` (s); the mesh size (m) is what depths are compared with.
fn event_text(event: &Event, start: f64, mesh_size: f64) -> String {
    let time = start + event.time;
    let what = match event.kind {
        EventKind::Detached => format!("block {} detached", event.subject),
        EventKind::Slipped if event.subject == u32::MAX => "a contact away from joints slipped".to_owned(),
        EventKind::Slipped => format!("joint {} slipped", event.subject),
        EventKind::Broken => format!("the last bond of joint {} broke", event.subject),
        EventKind::Failed => format!("block {} failed", event.subject),
        EventKind::Cut => format!("block {} broke in two; the other part is block {}", event.subject, event.other),
        EventKind::Overlapped => event.overlap_text(mesh_size),
    };
    let meaning = if event.kind == EventKind::Overlapped { ": results about them are wrong from here on" } else { "" };
    format!("{what} at t = {} s{meaning}", rounded(time))
}
