//! A model that a host drives through communication steps: inputs, transactional steps, events, ports, saved states.
//! The C ABI and the FMUs are thin over [`Cosimulation`].
//!
//! A host that holds the toe of a slope, whose case names it by `[[port]]`:
//!
//! ```
//! use enmm::geometry::Vector;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let case = std::path::Path::new("examples/cases/coupled_slope.toml");
//! let mut slope = enmm_io::load_case(case)?.cosimulation()?;
//! let toe = slope.find_port("toe")?;
//! let block = slope.port_block(toe)?;
//! let held = Vector::new(0.9e6, 0.56e6); // N/m; [0.9e6, 0.56e6] would do as well.
//! slope.set_block_force(block, held, 0.0)?;
//! slope.start()?;
//! slope.set_block_force(block, held * 0.5, 0.0)?;
//! slope.do_step(0.0, 0.01)?;
//! assert!(slope.port_state(toe).displacement.x < 0.0, "the toe moves out of the slope");
//! # Ok(())
//! # }
//! ```

mod error;
mod inputs;
mod interval;
mod names;
mod observe;
mod parameter;
mod ports;
mod rollout;
mod saved;
mod threads;
mod tuning;
mod watch;
mod witness;

pub use crate::mechanics::SectionFailure;
pub use crate::state::{Cut, Event, EventKind, Input, PortKind, Quantity};
pub use error::CosimulationError;
pub use interval::{Interval, StepInfo};
pub use names::Named;
pub use observe::{ContactCounts, PORT_QUANTITIES, PortState, TOTALS, Totals};
pub use parameter::{Parameter, ParameterError, apply, parameters};
pub use rollout::{RolledOut, Rollout};
pub use saved::Saved;
pub use watch::{Pace, Watch};
pub use witness::Witness;

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::geometry::Vector;
pub use crate::model::case::limits;
use crate::model::case::{Case, Invalid, StageKind};
use crate::model::settle;
use crate::model::{BlockState, Simulation, SlopeFailure};
use crate::state::{Inputs, State};
use crate::step::{StepReport, THREADS_FROM, Wanted};
use threads::Pool;
use tuning::Parameters;
use watch::Watcher;
use witness::Attendance;

/// How inputs go through a communication step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interpolation {
    /// A new value acts from the start of the next communication step on (zero-order hold).
    #[default]
    Hold,
    /// A new value is reached at the end of the next communication step, linearly from the one before.
    Linear,
}

/// Where a model stands beside its state.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct Progress {
    /// Steps of all stages before time 0.
    origin: u64,
    /// Simulated time of the model at time 0 (s).
    start: f64,
    /// Whether the initial equilibrium has been sought.
    started: bool,
    /// Net over applied force at the end of the last initial stage when it did not come to rest; 0 when it did.
    initial_residual: f64,
    /// Whether an input has changed since the last step ended.
    changed: bool,
    interpolation: Interpolation,
    /// End of the last communication step by the host's clock (s).
    host_time: f64,
    /// Results of the forces of the last internal step; none where nobody has looked.
    forces: Option<Forces>,
}

/// Results of the forces of an internal step, at its start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Forces {
    /// Net over applied force.
    unbalanced: f64,
    /// Energy stored in springs of contacts and supports (J/m).
    stored: f64,
    /// Energy stored in bolts (J/m).
    in_bolts: f64,
}

impl Forces {
    fn of(report: &StepReport) -> Self {
        let StepReport { unbalanced, ledger, .. } = *report;
        Self { unbalanced, stored: ledger.stored, in_bolts: ledger.bolts.stored }
    }
}

/// Interpolation of single inputs.
type Ways = BTreeMap<Input, Interpolation>;

/// Displacements (m) by port.
type Aims = BTreeMap<usize, Vector>;

impl Progress {
    /// That of a model that takes up the state of a run.
    fn of(state: &State, model: &Cosimulation) -> Self {
        let (first, dt) = (initial_stages(model.case()), model.internal_step());
        let started = state.stage as usize >= first;
        let begun = state.stage_starts.get(first).copied().unwrap_or_default();
        let since = ((state.stage_start - begun) / dt).round().max(0.0) as u64 + state.stage_step;
        let (origin, start) = match started {
            true => (state.step.saturating_sub(since), begun),
            false => (state.step, state.stage_start + state.stage_step as f64 * dt),
        };
        let host_time = state.step.saturating_sub(origin) as f64 * dt + state.part;
        Self { origin, start, started, host_time, ..Self::default() }
    }
}

/// A model in the hands of a host.
///
/// Time 0 is the start of the first dynamic stage: static stages before it are the initial equilibrium, which
/// [`Cosimulation::start`] (or the first step) seeks under the inputs that were set before. A case of static stages
/// alone starts at time 0 with the first of them. After the last stage of the case the model goes on in it.
#[derive(Debug, Clone)]
pub struct Cosimulation {
    simulation: Simulation,
    hash: String,
    parameters: Parameters,
    /// Displacements (m) that the fixities of ports reach at the end of the next communication step.
    aims: Aims,
    /// Inputs that go their own way through a communication step.
    ways: Ways,
    /// State from which the part of an internal step was taken, when the model stands between two grid points.
    grid: Option<Box<State>>,
    progress: Progress,
    /// State to which a failed step returns.
    backup: Saved,
    /// Number of the interval in progress; one with another number is over.
    serial: u64,
    /// Threads of steps, when they are more than the caller's own and the model is worth them.
    pool: Option<Arc<Pool>>,
    /// Looks at calls in progress, and may end them.
    watcher: Watcher,
    attendance: Attendance,
}

impl Cosimulation {
    /// Builds the model of a case.
    ///
    /// # Errors
    /// The first value of the case that does not fit, with its key.
    pub fn new(case: Case) -> Result<Self, Invalid> {
        let hash = case.fingerprint()?;
        let mut simulation = Simulation::new(case)?;
        simulation.set_serial(true);
        let parameters = Parameters::of(simulation.case())?;
        let backup = Saved::first(&simulation, &hash, &parameters);
        Ok(Self {
            simulation,
            hash,
            parameters,
            aims: Aims::new(),
            ways: Ways::new(),
            grid: None,
            progress: Progress::default(),
            backup,
            serial: 0,
            pool: None,
            watcher: Watcher::default(),
            attendance: Attendance::default(),
        })
    }

    /// The case.
    pub fn case(&self) -> &Case {
        self.simulation.case()
    }

    /// Fingerprint of the case, part of every serialised state.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Warnings about the model as built; the warnings of reading its case come with the case.
    pub fn warnings(&self) -> &[String] {
        &self.simulation.built().warnings
    }

    /// The model and its state.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Time (s) since the start of the first dynamic stage; after a communication step exactly its t + h.
    pub fn time(&self) -> f64 {
        let (own, host) = (self.grid_time(), self.progress.host_time);
        if (own - host).abs() <= self.same_time(own) { host } else { own }
    }

    /// Time (s) as whole internal steps and a part of one make it.
    fn grid_time(&self) -> f64 {
        let state = self.simulation.state();
        state.step.saturating_sub(self.progress.origin) as f64 * self.internal_step() + state.part
    }

    /// Internal step (s).
    pub fn internal_step(&self) -> f64 {
        self.simulation.model().dt
    }

    /// Communication step (s) that the case suggests.
    pub fn communication_step(&self) -> f64 {
        self.case().solver.communication_step.unwrap_or(10.0 * self.internal_step())
    }

    /// Time (s) that the stages of the case cover together, static ones before the first dynamic one left out.
    pub fn stop_time(&self) -> f64 {
        stop_time(self.case())
    }

    /// Events so far, in order; their times count as [`Cosimulation::time`] does.
    pub fn events(&self) -> impl ExactSizeIterator<Item = Event> + '_ {
        let start = self.progress.start;
        self.simulation.state().events.list.iter().map(move |event| Event { time: event.time - start, ..*event })
    }

    /// Whether the initial equilibrium has been sought.
    pub fn is_started(&self) -> bool {
        self.progress.started
    }

    /// Internal steps that the initial equilibrium took.
    pub fn initial_steps(&self) -> u64 {
        self.progress.origin
    }

    /// Net over applied force of the initial equilibrium, when its stage was over before the model came to rest: the
    /// slope moves, or the stage needs a longer duration.
    pub fn initial_residual(&self) -> Option<f64> {
        Some(self.progress.initial_residual).filter(|ratio| *ratio > 0.0)
    }

    /// The failure of the slope since it was built, if it has failed: rock is beyond `solver.failure_displacement`, or
    /// the initial equilibrium was not reached and rock is beyond a hundredth of the height of the model.
    pub fn failure(&self) -> Option<SlopeFailure> {
        self.simulation.failure(self.initial_residual().is_none())
    }

    /// Why the motion so far is worthless, when energy has come from nowhere: its residual is as large as the largest
    /// term of the ledger. A look costs as much as an internal step.
    pub fn doubt(&self) -> Option<String> {
        self.simulation.doubt(&self.look(Simulation::report_on).ledger)
    }

    /// Seeks the initial equilibrium: runs the static stages before the first dynamic one. Does nothing later.
    ///
    /// # Errors
    /// A numerical failure, or an end by the watch; the model is then as it was before.
    pub fn start(&mut self) -> Result<(), CosimulationError> {
        if !self.progress.started {
            self.keep();
            self.seek()?;
        }
        Ok(())
    }

    /// Seeks the initial equilibrium; where that fails the model goes back to what was kept.
    fn seek(&mut self) -> Result<(), CosimulationError> {
        self.simulation.drive().arrive();
        let shaking = self.clear_base_motion();
        self.run_initial_stages().inspect_err(|error| self.take_back(error))?;
        let drive = self.simulation.drive();
        (drive.from.base_acceleration, drive.to.base_acceleration) = (shaking, shaking);
        self.progress.origin = self.simulation.state().step;
        self.progress.start = self.simulation.time();
        self.progress.started = true;
        self.progress.changed = false;
        Ok(())
    }

    /// Takes the acceleration of the base, which is no part of the initial equilibrium, out of the inputs; returns it.
    fn clear_base_motion(&mut self) -> Vector {
        let drive = self.simulation.drive();
        let shaking = drive.to.base_acceleration;
        (drive.from.base_acceleration, drive.to.base_acceleration) = (Vector::zeros(), Vector::zeros());
        shaking
    }

    fn run_initial_stages(&mut self) -> Result<(), CosimulationError> {
        // The state of a run may be in one of them.
        for _ in self.simulation.state().stage as usize..initial_stages(self.case()) {
            let mut unbalanced = None;
            let step = |model: &mut Self| {
                model.watch_equilibrium(unbalanced)?;
                let wanted = model.simulation.rest_due();
                let report = model.step(None, if wanted { Wanted::Report } else { Wanted::Nothing })?;
                unbalanced = if wanted { Some(report.unbalanced) } else { unbalanced };
                Ok::<_, CosimulationError>(wanted.then_some(report))
            };
            let last = settle::until_over(self, Self::simulation, step)?;
            let report = last.unwrap_or_else(|| self.look(Simulation::report_on));
            self.progress.forces = Some(Forces::of(&report));
            self.progress.initial_residual = if self.simulation.at_rest(&report) { 0.0 } else { report.unbalanced };
            self.next_stage(last.as_ref())?;
        }
        Ok(())
    }

    /// Begins the next stage of the case, if there is one, behind the `last` report of the one before.
    fn next_stage(&mut self, last: Option<&StepReport>) -> Result<(), CosimulationError> {
        if self.simulation.state().stage as usize + 1 >= self.case().stages.len() {
            return Ok(());
        }
        if let Some(witness) = &mut self.attendance.0 {
            witness.stage_ends(&self.simulation, last);
        }
        self.simulation.next_stage().map_err(CosimulationError::Stage)?;
        self.check_block_count()?;
        if self.progress.started {
            self.note_stage();
        }
        if let Some(witness) = &mut self.attendance.0 {
            witness.stage_begins(&self.simulation);
        }
        Ok(())
    }

    /// State of every block, by number.
    pub fn block_states(&self) -> Vec<BlockState> {
        self.blocks().into_iter().copied().collect()
    }

    /// The same, worked out at the first look after a step.
    pub fn blocks(&self) -> Vec<&BlockState> {
        self.simulation.blocks_by_number()
    }

    /// Sections of rock that have broken so far, in order; their times count as [`Cosimulation::time`] does.
    pub fn cuts(&self) -> impl ExactSizeIterator<Item = Cut> + '_ {
        let start = self.progress.start;
        self.simulation.cuts().iter().map(move |cut| Cut { time: cut.time - start, ..*cut })
    }

    /// Most blocks that the model can have: those of its last stage, and `fracture.parts_max` more where rock can
    /// break.
    pub fn blocks_max(&self) -> usize {
        self.simulation.blocks_max()
    }

    /// Refuses more blocks than hosts have been told of.
    fn check_block_count(&self) -> Result<(), CosimulationError> {
        let (count, most) = (self.simulation.model().covers.block_count(), self.blocks_max());
        if count <= most {
            return Ok(());
        }
        let stage = self.simulation.state().stage;
        let message = format!(
            "parts blocks that have broken, so that the model has {count} of them and not the {most} that hosts have \
             been told of; raise fracture.parts_max by {} or more",
            count - most
        );
        Err(CosimulationError::Stage(Invalid { key: format!("stage[{stage}].cut"), message }))
    }

    /// Values that the host has set, or the case's own.
    pub fn inputs(&self) -> &Inputs {
        &self.simulation.state().drive.to
    }

    /// How all inputs go through a communication step from now on.
    pub fn set_interpolation(&mut self, interpolation: Interpolation) {
        self.progress.interpolation = interpolation;
        self.ways.clear();
    }

    /// How one input goes through a communication step from now on; that of a port of a block is the input of its
    /// block.
    ///
    /// # Errors
    /// A block or a port that does not exist.
    pub fn set_interpolation_of(
        &mut self,
        input: Input,
        interpolation: Interpolation,
    ) -> Result<(), CosimulationError> {
        let input = self.own_input(input)?;
        if interpolation == self.progress.interpolation {
            self.ways.remove(&input);
        } else {
            self.ways.insert(input, interpolation);
        }
        Ok(())
    }

    /// How one input goes through a communication step.
    pub fn interpolation_of(&self, input: Input) -> Interpolation {
        self.ways.get(&input).copied().unwrap_or(self.progress.interpolation)
    }

    /// How inputs go through a communication step.
    pub fn interpolation(&self) -> Interpolation {
        self.progress.interpolation
    }

    /// Sets the number of threads that steps use (1 at the start: the caller's own); the bits do not depend on it.
    /// Small models keep to the caller's thread: handing a step over would cost more than it saves. A forked process
    /// starts as many of its own at its first step.
    ///
    /// # Errors
    /// No thread at all, more than 1024, or threads that the system refuses.
    pub fn set_threads(&mut self, threads: usize) -> Result<(), CosimulationError> {
        if !(1..=limits::THREADS_MAX).contains(&threads) {
            let limit = format!("at least 1 and at most {}", limits::THREADS_MAX);
            return Err(CosimulationError::value("threads", threads, &limit, "1 suits all small models"));
        }
        let is_small = self.simulation.model().covers.cover_count() < THREADS_FROM;
        self.pool = if threads == 1 || is_small { None } else { Some(Arc::new(Pool::new(threads)?)) };
        self.simulation.set_serial(self.pool.is_none());
        Ok(())
    }

    /// Advances the model by an internal step, or the `part` (s) of one, on the threads that have been set; the report
    /// holds what is `wanted` of its start.
    fn step(&mut self, part: Option<f64>, wanted: Wanted) -> Result<StepReport, CosimulationError> {
        if let Some(foreign) = self.pool.as_ref().filter(|pool| pool.here().is_none()) {
            self.set_threads(foreign.threads())?;
        }
        let is_whole = part.is_none() && self.simulation.state().part == 0.0;
        let witness = self.attendance.0.as_mut().filter(|_| is_whole);
        let is_seen = witness.is_some_and(|witness| witness.step_begins(&self.simulation));
        let wanted = if is_seen { Wanted::Report } else { wanted };
        let simulation = &mut self.simulation;
        let mut act = || match part {
            Some(dt) => simulation.advance_part(dt, wanted),
            None => simulation.advance_for(wanted),
        };
        let advanced = match self.pool.as_ref().and_then(|pool| pool.here()) {
            Some(pool) => pool.install(act),
            None => act(),
        };
        let report = advanced?;
        self.progress.forces = (wanted != Wanted::Nothing).then(|| Forces::of(&report));
        if let Some(witness) = self.attendance.0.as_mut().filter(|_| wanted == Wanted::Report) {
            witness.step_ends(&self.simulation, &report);
        }
        Ok(report)
    }

    /// Sets who sees the steps of the model, or nobody; returns who did so before. Copies of the model have none.
    pub fn set_witness(&mut self, witness: Option<Box<dyn Witness>>) -> Option<Box<dyn Witness>> {
        std::mem::replace(&mut self.attendance.0, witness)
    }

    /// Who sees the steps of the model.
    pub fn witness(&self) -> Option<&dyn Witness> {
        self.attendance.0.as_deref()
    }

    /// The state from which the model goes on: where it stands between two points of the grid and no input has changed,
    /// the last point of the grid.
    pub fn onward(&self) -> &State {
        saved::kept(self.grid.as_deref(), self.progress).unwrap_or(self.simulation.state())
    }

    /// Result of `look` at the model on the threads of steps or, by its second argument, on the caller's alone, as in a
    /// forked process before its first step.
    fn look<T: Send>(&self, look: impl FnOnce(&Simulation, bool) -> T + Send) -> T {
        match self.pool.as_ref().and_then(|pool| pool.here()) {
            Some(pool) => pool.install(|| look(&self.simulation, false)),
            None => look(&self.simulation, true),
        }
    }
}

/// Number of static stages before the first dynamic one; 0 when there is no dynamic one.
fn initial_stages(case: &Case) -> usize {
    case.stages.iter().position(|stage| stage.kind == StageKind::Dynamic).unwrap_or(0)
}

/// See [`Cosimulation::stop_time`].
pub fn stop_time(case: &Case) -> f64 {
    case.stages[initial_stages(case)..].iter().map(|stage| stage.duration).sum()
}
