//! Communication steps: exactly [t, t + h], all or nothing, on a grid of internal steps that no host can shift.
//!
//! The grid is time 0 plus whole internal steps. A communication step that ends between two grid points takes a part of
//! an internal step to get there and keeps the state of the grid point before; the next step goes on from that grid
//! point as if nothing had been asked in between, unless an input has changed, which then acts from this very time.

use crate::state::Event;

use super::{Cosimulation, CosimulationError, Interpolation};

/// Part of an internal step below which two times are the same.
const SAME_TIME: f64 = 1e-6;
/// Relative difference of times that hosts sum up.
const SUM_ERROR: f64 = 1e-9;
/// Most internal steps of one communication step.
const STEPS_MAX: f64 = 1e12;

/// A communication step in progress.
#[derive(Debug, Clone)]
pub struct Interval {
    end: f64,
    info: StepInfo,
    events_before: usize,
}

impl Interval {
    /// What has happened so far.
    pub fn info(&self) -> &StepInfo {
        &self.info
    }

    /// End of the step (s).
    pub fn end(&self) -> f64 {
        self.end
    }
}

/// What happened in a communication step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StepInfo {
    /// Time that the model has reached (s).
    pub time: f64,
    /// Internal steps, parts included.
    pub steps: u64,
    /// Largest internal step (s); smaller sub-steps are counted by `halved`.
    pub dt: f64,
    /// Events in order, with times as [`Cosimulation::time`] counts.
    pub events: Vec<Event>,
    /// Internal steps that were redone in halves.
    pub halved: u64,
    /// Sub-steps whose open–close iteration ended unsettled.
    pub unsettled: u64,
}

impl Cosimulation {
    /// Advances from `t` to exactly `t + h` (s), or not at all.
    ///
    /// # Errors
    /// Times that do not fit, or a numerical failure; the model is then as it was at `t`.
    pub fn do_step(&mut self, t: f64, h: f64) -> Result<StepInfo, CosimulationError> {
        let mut interval = self.begin(t, h)?;
        while self.advance(&mut interval)? {}
        Ok(interval.info)
    }

    /// Begins a communication step that [`Cosimulation::advance`] then covers; it may be left early at any time.
    ///
    /// # Errors
    /// Times that do not fit, or a failure of [`Cosimulation::start`].
    pub fn begin(&mut self, t: f64, h: f64) -> Result<Interval, CosimulationError> {
        let end = self.check_times(t, h)?;
        self.start()?;
        self.keep_backup();
        self.return_to_grid();
        self.set_drive(end);
        let state = self.simulation.state();
        let info = StepInfo { time: self.time(), ..StepInfo::default() };
        let (halved, unsettled) = (state.counters.halved, state.counters.unsettled);
        let info = StepInfo { halved, unsettled, ..info };
        Ok(Interval { end, info, events_before: state.events.list.len() })
    }

    /// Takes one internal step of an interval; false when its end is reached.
    ///
    /// # Errors
    /// A numerical failure; the model is then as it was when the interval began.
    pub fn advance(&mut self, interval: &mut Interval) -> Result<bool, CosimulationError> {
        let left = interval.end - self.grid_time();
        let same = self.same_time(interval.end);
        if left <= same {
            self.arrive(interval);
            return Ok(false);
        }
        match self.internal(left, same) {
            Ok(dt) => {
                interval.info.steps += 1;
                interval.info.dt = interval.info.dt.max(dt);
                interval.info.time = self.grid_time();
                self.note_events(interval);
                let more = interval.end - self.grid_time() > same;
                if !more {
                    self.arrive(interval);
                }
                Ok(more)
            }
            Err(error) => {
                self.roll_back();
                Err(error)
            }
        }
    }

    /// One internal step, or the part of it that is `left` (s); returns its length. Times within `same` are the same.
    fn internal(&mut self, left: f64, same: f64) -> Result<f64, CosimulationError> {
        if self.simulation.stage_is_over(None) {
            self.next_stage()?;
        }
        let dt = self.internal_step();
        let rest = dt - self.simulation.state().part;
        if left >= rest - same {
            self.step(None, false)?;
            self.grid = None;
            return Ok(rest);
        }
        if self.simulation.state().part == 0.0 {
            self.grid = Some(Box::new(self.simulation.state().clone()));
        }
        self.step(Some(left), false)?;
        Ok(left)
    }

    fn note_events(&self, interval: &mut Interval) {
        let known = interval.events_before + interval.info.events.len();
        if self.simulation.state().events.list.len() > known {
            interval.info.events.extend(self.events().skip(known));
        }
    }

    /// Ends an interval at its end.
    fn arrive(&mut self, interval: &mut Interval) {
        self.standing.told = interval.end;
        self.finish(interval);
    }

    fn finish(&mut self, interval: &mut Interval) {
        let counters = &self.simulation.state().counters;
        interval.info.time = self.time();
        interval.info.halved = counters.halved.saturating_sub(interval.info.halved);
        interval.info.unsettled = counters.unsettled.saturating_sub(interval.info.unsettled);
        self.standing.changed = false;
    }

    /// Ends an interval before its end; inputs that were on their way go on from here in the next one.
    pub fn leave(&mut self, mut interval: Interval) -> StepInfo {
        self.finish(&mut interval);
        let now = self.simulation.time();
        let drive = self.simulation.drive();
        if drive.until > now {
            drive.pass(now);
            self.standing.changed = true;
        }
        interval.info
    }

    /// The end of a step from `t` over `h`.
    fn check_times(&self, t: f64, h: f64) -> Result<f64, CosimulationError> {
        let own = self.time();
        if !t.is_finite() || (t - own).abs() > self.same_time(own) {
            return Err(CosimulationError::Time { given: t, own });
        }
        let most = STEPS_MAX * self.internal_step();
        if !(h > 0.0 && h <= most) {
            let limit = format!("greater than 0 and at most {most:e} s");
            return Err(CosimulationError::value("h", format!("{h} s"), &limit, "give a positive, finite step"));
        }
        Ok(t + h)
    }

    /// Difference (s) below which two times near `t` are the same.
    pub(super) fn same_time(&self, t: f64) -> f64 {
        let dt = self.internal_step();
        (SAME_TIME * dt + SUM_ERROR * t.abs()).min(0.1 * dt)
    }

    /// Goes back to the grid point before, unless an input has changed since.
    fn return_to_grid(&mut self) {
        if let Some(grid) = self.grid.take()
            && !self.standing.changed
            && !self.simulation.state().drive.is_moving()
        {
            self.simulation.restore(*grid);
        }
    }

    /// Lets inputs jump or move to their new values.
    fn set_drive(&mut self, end: f64) {
        let (start, now) = (self.start_time(), self.simulation.time());
        let linear = self.standing.interpolation == Interpolation::Linear && self.standing.changed;
        let drive = self.simulation.drive();
        if linear {
            (drive.since, drive.until) = (now, start + end);
        } else {
            drive.from.copy_from(&drive.to);
            (drive.since, drive.until) = (now, now);
        }
    }

    fn keep_backup(&mut self) {
        self.backup.overwrite(self.simulation.state(), self.grid.as_deref(), self.standing);
    }

    fn roll_back(&mut self) {
        let backup = self.backup.clone();
        self.take(backup);
    }
}
