//! Communication steps: exactly [t, t + h], all or nothing, on a grid of internal steps that no host can shift.
//!
//! The grid is time 0 plus whole internal steps. A communication step that ends between two grid points takes a part of
//! an internal step to get there and keeps the state from which that part was taken; the next step goes on from that
//! state as if nothing had been read in between, unless an input has changed, which then acts from this very time.

use crate::model::SlopeFailure;
use crate::state::{Counters, Event, EventKind, Input};
use crate::step::Wanted;
use enmm_case::keys::Plain;

use super::{Cosimulation, CosimulationError, Interpolation};

/// Part of an internal step below which two times are the same.
const SAME_TIME: f64 = 1e-6;
/// Relative difference of times that hosts sum up.
const SUM_ERROR: f64 = 1e-9;
/// Internal steps before which energies say nothing: a step from rest does half of its work.
const JUDGED_FROM: u64 = 4;
/// Most internal steps of one communication step.
const STEPS_MAX: f64 = 1e12;

/// A communication step in progress.
#[derive(Debug, Clone)]
pub struct Interval {
    end: f64,
    info: StepInfo,
    events_before: usize,
    before: Counters,
    /// Internal steps of all stages before it.
    steps_before: u64,
    /// Number of the interval; a model has one in progress at most.
    serial: u64,
}

impl Interval {
    /// Outcome so far.
    pub fn info(&self) -> &StepInfo {
        &self.info
    }

    /// End of the step (s).
    pub fn end(&self) -> f64 {
        self.end
    }
}

/// Outcome of a communication step.
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
    /// [`Cosimulation::doubt`], which is looked at when four internal steps have been taken since time 0, and whenever
    /// their number has doubled.
    pub doubt: Option<String>,
    /// [`Cosimulation::failure`] at the end of the communication step in which so much rock has failed that the slope
    /// has.
    pub failure: Option<SlopeFailure>,
}

impl Cosimulation {
    /// Advances from `t` to exactly `t + h` (s), or not at all.
    ///
    /// # Errors
    /// Times that do not fit, a numerical failure, or an end by the watch ([`Cosimulation::set_watch`]); the model is
    /// then as it was, to the bit. A first step then takes the initial equilibrium back as well, unless
    /// [`Cosimulation::start`] has sought it.
    pub fn do_step(&mut self, t: f64, h: f64) -> Result<StepInfo, CosimulationError> {
        let mut interval = self.begin(t, h)?;
        while self.advance(&mut interval)? {}
        Ok(interval.info)
    }

    /// Begins a communication step that [`Cosimulation::advance`] then covers. Until it has ended, by its last advance
    /// or by [`Cosimulation::leave`], the model may be observed only.
    ///
    /// # Errors
    /// Times that do not fit, or a failure of [`Cosimulation::start`].
    pub fn begin(&mut self, t: f64, h: f64) -> Result<Interval, CosimulationError> {
        let end = self.check_times(t, h)?;
        self.keep();
        if !self.progress.started {
            self.seek()?;
        }
        if self.progress.changed {
            self.grid = None;
            self.set_drive(end);
        } else if let Some(kept) = self.grid.take() {
            self.simulation.restore(*kept);
        }
        if let Some(witness) = &mut self.attendance.0 {
            witness.communication_step_begins(&self.simulation);
        }
        self.serial += 1;
        let state = self.simulation.state();
        let info = StepInfo { time: self.time(), ..StepInfo::default() };
        let (events_before, before, steps_before) = (state.events.list.len(), state.counters, state.step);
        Ok(Interval { end, info, events_before, before, steps_before, serial: self.serial })
    }

    /// Takes one internal step of an interval; false when its end is reached.
    ///
    /// # Errors
    /// A numerical failure or an end by the watch; the model is then as it was when the interval began. An interval
    /// that is over, or that the model has left by going back to a saved state or by beginning another.
    pub fn advance(&mut self, interval: &mut Interval) -> Result<bool, CosimulationError> {
        if interval.serial != self.serial {
            return Err(CosimulationError::Stale);
        }
        let same = self.same_time(interval.end);
        let left = interval.end - self.grid_time();
        if left > same {
            self.watch_step(interval.end).map_err(|error| self.fail(error))?;
            let dt = self.internal(left, same).map_err(|error| self.fail(error))?;
            interval.info.steps += 1;
            interval.info.dt = interval.info.dt.max(dt);
            self.note(interval);
        }
        let more = interval.end - self.grid_time() > same;
        if !more {
            self.progress.host_time = interval.end;
            self.end(interval);
        }
        Ok(more)
    }

    /// Makes an interval end earlier; inputs on their linear way will not have arrived then.
    pub fn shorten(&self, interval: &mut Interval, end: f64) {
        interval.end = end.min(interval.end);
    }

    /// Ends an interval before its end, where the model stands; one that has not moved yet changes nothing. Inputs on
    /// their linear way go on from here in the next one.
    pub fn leave(&mut self, mut interval: Interval) -> StepInfo {
        if interval.serial == self.serial {
            if interval.info.steps == 0 {
                self.roll_back();
            } else {
                self.end(&mut interval);
            }
        }
        interval.info
    }

    /// One internal step, or the part of it that is `left` (s); returns its length. Times within `same` are the same.
    fn internal(&mut self, left: f64, same: f64) -> Result<f64, CosimulationError> {
        if self.simulation.stage_is_over(None) {
            self.next_stage(None)?;
        }
        let rest = self.simulation.state().rest_of_step(self.simulation.model());
        let wanted = if left <= rest + same { Wanted::Forces } else { Wanted::Nothing };
        if left >= rest - same {
            self.step(None, wanted)?;
            self.grid = None;
            return Ok(rest);
        }
        if self.grid.is_none() {
            self.grid = Some(Box::new(self.simulation.state().clone()));
        }
        self.step(Some(left), wanted)?;
        Ok(left)
    }

    /// Notes what an internal step has brought.
    fn note(&self, interval: &mut Interval) {
        let known = interval.events_before + interval.info.events.len();
        let state = self.simulation.state();
        if state.events.list.len() > known {
            interval.info.events.extend(self.events().skip(known));
        }
        interval.info.time = self.grid_time();
        interval.info.halved = state.counters.halved - interval.before.halved;
        interval.info.unsettled = state.counters.unsettled - interval.before.unsettled;
    }

    /// Ends an interval where the model stands.
    fn end(&mut self, interval: &mut Interval) {
        self.serial += 1;
        interval.info.time = self.time();
        let (now, same) = (self.simulation.time(), self.same_time(interval.end));
        let drive = self.simulation.drive();
        // A way that is not over goes on in the next interval.
        self.progress.changed = drive.until - now > same;
        if self.progress.changed {
            drive.pass(now);
        } else {
            drive.arrive();
        }
        if interval.end - self.grid_time() <= same {
            self.progress.changed |= self.stop_aimed();
        }
        let doublings = |steps: u64| (steps.saturating_sub(self.progress.origin) / JUDGED_FROM).checked_ilog2();
        if doublings(self.simulation.state().step) > doublings(interval.steps_before) {
            interval.info.doubt = self.doubt();
        }
        if self.fails_within(interval) {
            interval.info.failure = self.failure();
        }
    }

    /// Whether the blocks that have failed have been few ([`Simulation::mass_of_few`]) until an interval, and are no
    /// longer.
    ///
    /// [`Simulation::mass_of_few`]: crate::model::Simulation::mass_of_few
    fn fails_within(&self, interval: &Interval) -> bool {
        let (model, events) = (self.simulation.model(), &self.simulation.state().events.list);
        let mass = |events: &[Event]| -> f64 {
            let failed = events.iter().filter(|event| event.kind == EventKind::Failed);
            failed
                .filter_map(|event| self.simulation.block_labelled(event.subject))
                .map(|block| model.mass_matrix.total[block])
                .sum()
        };
        let before = mass(&events[..interval.events_before.min(events.len())]);
        let is_new = events.iter().skip(interval.events_before).any(|event| event.kind == EventKind::Failed);
        let few = || self.simulation.mass_of_few();
        is_new && before <= few() && mass(events) > few()
    }

    /// Rolls back after a failure, and shows it to the witness.
    pub(super) fn take_back(&mut self, error: &CosimulationError) {
        self.roll_back();
        if let (Some(witness), CosimulationError::Step(error)) = (&mut self.attendance.0, error) {
            witness.fails(error);
        }
    }

    /// Rolls back and converts times to those that hosts count.
    fn fail(&mut self, error: CosimulationError) -> CosimulationError {
        let start = self.progress.start;
        self.take_back(&error);
        match error {
            CosimulationError::Step(mut error) => {
                error.time -= start;
                error.into()
            }
            other => other,
        }
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
            return Err(CosimulationError::value(
                "h",
                format!("{} s", Plain(h)),
                &limit,
                "give a positive, finite step",
            ));
        }
        Ok(t + h)
    }

    /// Difference (s) below which two times near `t` are the same.
    pub fn same_time(&self, t: f64) -> f64 {
        let dt = self.internal_step();
        (SAME_TIME * dt + SUM_ERROR * t.abs()).min(0.1 * dt)
    }

    /// Lets inputs that have changed jump or move to their new values, and fixities go where they are to be.
    fn set_drive(&mut self, end: f64) {
        let (start, now) = (self.progress.start, self.simulation.time());
        let common = self.progress.interpolation;
        let others = self.ways.iter().filter(|(_, way)| **way != common);
        let others: Vec<Input> = others.map(|(&input, _)| self.model_input(input)).collect();
        let drive = self.simulation.drive();
        match common {
            Interpolation::Linear => {
                (drive.since, drive.until) = (now, start + end);
                others.into_iter().for_each(|input| drive.from.take_over(input, &drive.to));
            }
            Interpolation::Hold if self.ways.is_empty() => drive.jump(),
            Interpolation::Hold => {
                let before = drive.from.clone();
                drive.jump();
                for input in others {
                    drive.from.take_over(input, &before);
                    (drive.since, drive.until) = (now, start + end);
                }
            }
        }
        for (&port, &aim) in &self.aims {
            let velocity = (aim - drive.moved[port]) / (start + end - now);
            (drive.from.port_velocity[port], drive.to.port_velocity[port]) = (velocity, velocity);
        }
    }

    /// Stops the fixities that have gone where they were to be; returns whether there were any.
    fn stop_aimed(&mut self) -> bool {
        let aims = std::mem::take(&mut self.aims);
        let drive = self.simulation.drive();
        for &port in aims.keys() {
            (drive.from.port_velocity[port], drive.to.port_velocity[port]) = Default::default();
        }
        !aims.is_empty()
    }
}
