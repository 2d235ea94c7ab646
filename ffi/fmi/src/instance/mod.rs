//! One instance of an FMU: its life cycle. Both sets of C entry points are thin over it.
//!
//! A call either does all that it should or returns an error and leaves values and model as they were; the phase is
//! then [`Phase::Error`], except for calls that only handle saved states or logging, or that come within a step.

mod events;
mod ramps;
mod read;
mod record;
mod saved;
mod step;
mod write;

pub use step::{Step, Update};

use enmm::model::case::keys::Plain;
use std::path::Path;

use enmm::cosimulation::{Cosimulation, Event, Interpolation, Saved, apply};
use enmm::model::SlopeFailure;
use enmm_io::LoadedCase;

use crate::log::{Category, Filter, Message, Status};
use crate::phase::{Call, Phase, is_legal};
use crate::resource;
use crate::table::{Table, Version, check_blocks};
use crate::values::Values;

/// Why a call failed; the text goes to the log.
pub type Failure = String;

/// Arguments of an importer that makes an instance.
#[derive(Debug, Clone, Copy)]
pub struct Plan<'a> {
    /// Version of the standard.
    pub version: Version,
    /// Name of the instance.
    pub name: &'a str,
    /// Token of the model description.
    pub token: &'a str,
    /// Folder of resources.
    pub resources: &'a Path,
    /// Whether all categories of messages are on.
    pub logging: bool,
    /// Whether steps may end early (FMI 3).
    pub early_return: bool,
    /// Whether the importer uses event mode (FMI 3).
    pub event_mode: bool,
}

/// Times of an experiment.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Experiment {
    start: f64,
    stop: Option<f64>,
}

/// One instance.
#[derive(Debug)]
pub struct Instance {
    table: Table,
    loaded: LoadedCase,
    model: Cosimulation,
    /// The case that the model was built of: that of the FMU with other parameters.
    built_case: LoadedCase,
    /// State of the model of the case itself, as it was built.
    initial: Saved,
    /// Parameters that the model was built with.
    built: Vec<f64>,
    threads: usize,
    values: Values,
    phase: Phase,
    /// Whether a call within intermediate update mode has failed; the error shows when the mode is left.
    spoiled: bool,
    experiment: Experiment,
    time: f64,
    early_return: bool,
    event_mode: bool,
    /// Derivatives of inputs for the next step.
    rates: Vec<ramps::Rate>,
    /// Whether it was said that results can no longer be recorded.
    lost_record: bool,
    filter: Filter,
    messages: Vec<Message>,
    cache: read::Cache,
    states: saved::SavedStates,
}

impl Instance {
    /// Builds the model and checks the token.
    ///
    /// # Errors
    /// Data that are missing, damaged or do not fit.
    pub fn new(plan: Plan) -> Result<Self, Failure> {
        if plan.name.trim().is_empty() {
            return Err("the name of the instance is empty: give one".to_owned());
        }
        let loaded = resource::load(plan.resources).map_err(|error| error.to_string())?;
        let model = loaded.cosimulation().map_err(|error| error.to_string())?;
        let blocks = model.simulation().model().covers.block_count();
        check_blocks(&loaded.case, model.blocks_max())?;
        let table = Table::new(&loaded.case, model.blocks_max(), &loaded.hash, plan.version);
        if plan.token != table.token {
            let (given, own) = (plan.token, &table.token);
            return Err(format!("the token is {given}, must be {own}: give that of the model description of this FMU"));
        }
        let values = Values::of(&table);
        let mut instance = Self {
            initial: model.save(),
            built: values.parameters(&table),
            built_case: loaded.clone(),
            threads: 1,
            values,
            phase: Phase::Instantiated,
            spoiled: false,
            experiment: Experiment { start: 0.0, stop: None },
            time: 0.0,
            early_return: plan.early_return,
            event_mode: plan.event_mode,
            rates: Vec::new(),
            lost_record: false,
            filter: Filter::new(plan.logging),
            messages: Vec::new(),
            cache: read::Cache::default(),
            states: saved::SavedStates::default(),
            table,
            loaded,
            model,
        };
        instance.log(Status::Ok, Category::All, format!("built a model of {blocks} blocks"));
        Ok(instance)
    }

    /// The variables.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The model.
    pub fn model(&self) -> &Cosimulation {
        &self.model
    }

    /// State of the instance.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Time of the importer at which the model stands (s).
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Messages since the last call of this function, those left out that the importer did not ask for.
    pub fn take_messages(&mut self) -> Vec<Message> {
        std::mem::take(&mut self.messages)
    }

    fn log(&mut self, status: Status, category: Category, text: String) {
        if self.filter.passes(category) {
            self.messages.push(Message { status, category, text });
        }
    }

    /// Ends a call that failed. One that comes within a step, from another thread say, does not touch the step.
    fn fail(&mut self, failure: Failure) -> Status {
        match self.phase {
            Phase::Stepping => {}
            Phase::Intermediate => self.spoiled = true,
            _ => self.phase = Phase::Error,
        }
        self.complain(failure)
    }

    /// Ends a call that failed but touches nothing that the rest depends on.
    fn complain(&mut self, failure: Failure) -> Status {
        self.log(Status::Error, Category::Error, failure);
        Status::Error
    }

    fn end(&mut self, outcome: Result<(), Failure>) -> Status {
        match outcome {
            Ok(()) => Status::Ok,
            Err(failure) => self.fail(failure),
        }
    }

    fn allow(&self, call: Call) -> Result<(), Failure> {
        if is_legal(self.table.version, call, self.phase) {
            return Ok(());
        }
        let state = self.phase.name();
        Err(format!("this call is illegal in the state `{state}`; see the calling sequence of the standard"))
    }

    /// Whether a call is legal now; if not, the call has failed.
    pub fn permits(&mut self, call: Call) -> Status {
        let outcome = self.allow(call);
        self.end(outcome)
    }

    /// Fails a call for a reason that the entry point has found, such as a missing pointer.
    pub fn refuse(&mut self, reason: &str) -> Status {
        self.fail(reason.to_owned())
    }

    /// setDebugLogging.
    pub fn set_logging(&mut self, on: bool, categories: &[&str]) -> Status {
        let legal = self.allow(Call::Logging);
        match legal.and_then(|()| Filter::of(on, categories).map_err(unknown_category)) {
            Ok(filter) => {
                self.filter = filter;
                Status::Ok
            }
            Err(failure) => self.complain(failure),
        }
    }

    /// setupExperiment of FMI 2.
    pub fn set_up(&mut self, start: f64, stop: Option<f64>) -> Status {
        let outcome = self.allow(Call::Setup).and_then(|()| self.take_times(start, stop));
        self.end(outcome)
    }

    /// enterInitializationMode; FMI 3 gives the times here.
    pub fn enter_initialization(&mut self, times: Option<(f64, Option<f64>)>) -> Status {
        let legal = self.allow(Call::EnterInitialization);
        let outcome = legal.and_then(|()| times.map_or(Ok(()), |(start, stop)| self.take_times(start, stop)));
        if outcome.is_ok() {
            self.phase = Phase::Initialization;
        }
        self.end(outcome)
    }

    fn take_times(&mut self, start: f64, stop: Option<f64>) -> Result<(), Failure> {
        if !start.is_finite() {
            return Err(format!("the start time is {} s, must be finite", Plain(start)));
        }
        if let Some(stop) = stop
            && !(stop.is_finite() && stop >= start)
        {
            return Err(format!(
                "the stop time is {} s, must be finite and not before the start, {} s",
                Plain(stop),
                Plain(start)
            ));
        }
        self.experiment = Experiment { start, stop };
        self.time = start;
        Ok(())
    }

    /// exitInitializationMode: rebuilds the model if parameters have changed, and seeks the initial equilibrium. A
    /// warning when that was not reached.
    pub fn exit_initialization(&mut self) -> Status {
        let legal = self.allow(Call::ExitInitialization);
        let outcome = legal.and_then(|()| self.start_model());
        if outcome.is_ok() {
            self.phase = if self.event_mode { Phase::Event } else { Phase::Step };
        }
        match self.end(outcome) {
            Status::Ok if self.model.initial_residual().is_some() => Status::Warning,
            status => status,
        }
    }

    fn start_model(&mut self) -> Result<(), Failure> {
        if self.model.is_started() {
            return Ok(());
        }
        self.rebuild_if_changed()?;
        for warning in self.loaded.warnings.iter().chain(self.model.warnings()).cloned().collect::<Vec<_>>() {
            self.log(Status::Warning, Category::Warning, warning);
        }
        self.use_threads(self.values.threads(&self.table))?;
        let linear = self.values.interpolates(&self.table);
        self.model.set_interpolation(if linear { Interpolation::Linear } else { Interpolation::Hold });
        self.cache.clear();
        self.begin_record()?;
        let started = self.model.start();
        started.map_err(|error| format!("the initial equilibrium was not found: {error}"))?;
        let steps = self.model.simulation().state().step;
        self.log(Status::Ok, Category::All, format!("the initial equilibrium took {steps} internal steps"));
        let before: Vec<Event> = self.model.events().collect();
        before.iter().for_each(|event| self.log_event(event));
        if let Some(ratio) = self.model.initial_residual() {
            let text = format!(
                "the model is not at rest at time 0 (unbalanced ratio {ratio:.2e}): the slope moves, or its static \
                 stage needs a longer duration"
            );
            self.log(Status::Warning, Category::Warning, text);
        }
        self.warn_of_failure(self.model.failure());
        self.warn_of(self.model.doubt());
        Ok(())
    }

    /// Warns of a slope that has failed: how much of it, how far and in which way.
    fn warn_of_failure(&mut self, failure: Option<SlopeFailure>) {
        self.warn_of(failure.map(|failure| format!("the slope has failed {failure}")));
    }

    /// Warns of a motion that is worthless: no status says so.
    fn warn_of(&mut self, doubt: Option<String>) {
        if let Some(text) = doubt {
            self.log(Status::Warning, Category::Warning, text);
        }
    }

    fn use_threads(&mut self, threads: usize) -> Result<(), Failure> {
        if threads != self.threads {
            self.model.set_threads(threads).map_err(|error| error.to_string())?;
            self.threads = threads;
        }
        Ok(())
    }

    /// Builds the model of the parameters that hold, with the inputs that hold.
    fn rebuild_if_changed(&mut self) -> Result<(), Failure> {
        let wanted = self.values.parameters(&self.table);
        if same_bits(&wanted, &self.built) {
            return Ok(());
        }
        self.rebuild(wanted)
    }

    /// Takes the initial equilibrium back, since a value of which it depends is about to change.
    fn take_back_start(&mut self) -> Result<(), Failure> {
        if self.phase != Phase::Initialization || !self.model.is_started() {
            return Ok(());
        }
        self.rebuild(self.built.clone())
    }

    /// Builds a model of these parameters, with the inputs that hold. What was recorded is recorded again.
    fn rebuild(&mut self, parameters: Vec<f64>) -> Result<(), Failure> {
        let (case, mut model) = self.model_of(&parameters)?;
        self.values.push_changed(&self.table, &mut model).map_err(|error| error.to_string())?;
        self.take_model(case, model, parameters);
        Ok(())
    }

    /// The case with these parameters, and a new model of it.
    fn model_of(&self, parameters: &[f64]) -> Result<(LoadedCase, Cosimulation), Failure> {
        let mut case = self.loaded.case.clone();
        let mut changed = Vec::new();
        for (parameter, &value) in self.table.parameters.iter().zip(parameters) {
            apply(&mut case, parameter, value).map_err(|error| error.to_string())?;
            if value.to_bits() != parameter.start.to_bits() {
                changed.push(format!("{} = {value}", parameter.name));
            }
        }
        if changed.is_empty() {
            let model = self.loaded.cosimulation().map_err(|error| error.to_string())?;
            return Ok((self.loaded.clone(), model));
        }
        let located = |problem: String| format!("no model can be built with {}: {problem}", changed.join(", "));
        let loaded = LoadedCase::of(case, self.loaded.source.file()).map_err(|error| located(error.to_string()))?;
        let model = loaded.cosimulation().map_err(|error| located(error.to_string()))?;
        Ok((loaded, model))
    }

    fn take_model(&mut self, case: LoadedCase, model: Cosimulation, built: Vec<f64>) {
        self.built_case = case;
        self.model = model;
        self.built = built;
        self.threads = 1;
        self.cache.clear();
    }

    /// terminate.
    pub fn terminate(&mut self) -> Status {
        let outcome = self.allow(Call::Terminate);
        if outcome.is_ok() {
            self.warn_of(self.model.doubt());
            self.phase = Phase::Terminated;
        }
        let outcome = outcome.and_then(|()| self.end_record());
        self.end(outcome)
    }

    /// reset: everything is as after instantiate, but for saved states and logging.
    pub fn reset(&mut self) -> Status {
        let legal = self.allow(Call::Reset);
        let outcome = legal.and_then(|()| {
            let recorded = self.end_record();
            self.renew().and(recorded)
        });
        self.end(outcome)
    }

    fn renew(&mut self) -> Result<(), Failure> {
        let values = Values::of(&self.table);
        let start = values.parameters(&self.table);
        if same_bits(&start, &self.built) {
            self.use_threads(1)?;
            self.model.restore(&self.initial).map_err(|error| error.to_string())?;
        } else {
            let (case, model) = self.model_of(&start)?;
            self.take_model(case, model, start);
        }
        self.cache.clear();
        self.values = values;
        self.rates.clear();
        self.experiment = Experiment { start: 0.0, stop: None };
        self.time = 0.0;
        self.phase = Phase::Instantiated;
        Ok(())
    }
}

fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

fn unknown_category(name: &str) -> Failure {
    let known = crate::log::LOG_CATEGORIES.map(|(name, _)| name).join(", ");
    format!("the log category is `{name}`, must be one of {known}")
}
