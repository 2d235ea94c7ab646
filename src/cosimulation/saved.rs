//! Saved states: all that a model needs to go on with the same bits, in memory or as bytes for another process.

use enmm_case::keys::Plain;
use serde::{Deserialize, Serialize};

use crate::model::Simulation;
use crate::model::fit::{self, Unfit};
use crate::state::State;
use crate::state::bytes::{self, BytesError, Keeper};

use super::tuning::Parameters;
use super::{Aims, Cosimulation, CosimulationError, Forces, Input, PortKind, Progress, Ways};

/// The state of a model at one instant, with the inputs that hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// State from which the model goes on; the first in its bytes, as in those of other keepers.
    state: State,
    /// State in which the model stands, when that is between two points of the grid and it goes on from the first.
    between: Option<Box<State>>,
    progress: Progress,
    /// Hash of the model.
    hash: String,
    /// The same without the values of parameters.
    family: String,
    /// Internal step (s).
    dt: f64,
    /// Values of the parameters.
    parameters: Vec<f64>,
    aims: Aims,
    ways: Ways,
    /// Whether it is of a model of this process, or was found to be as if it were; bytes from elsewhere are not.
    #[serde(skip)]
    checked: bool,
}

impl Saved {
    /// The first state of a model.
    pub(super) fn first(simulation: &Simulation, hash: &str, parameters: &Parameters) -> Self {
        Self {
            state: simulation.state().clone(),
            between: None,
            progress: Progress::default(),
            hash: hash.to_owned(),
            family: parameters.family.clone(),
            dt: simulation.model().dt,
            parameters: parameters.values.clone(),
            aims: Aims::new(),
            ways: Ways::new(),
            checked: true,
        }
    }

    /// Takes another state of the same model, into the memory of the old one.
    pub(super) fn overwrite(&mut self, state: &State, grid: Option<&State>, progress: Progress, parameters: &[f64]) {
        self.parameters.clear();
        self.parameters.extend_from_slice(parameters);
        let grid = kept(grid, progress);
        self.state.clone_from(grid.unwrap_or(state));
        overwrite(&mut self.between, grid.map(|_| state));
        self.progress = progress;
    }

    /// Copies the state into a model, into the memory of its own, and returns where it stood.
    fn give(&self, simulation: &mut Simulation, grid: &mut Option<Box<State>>) -> Progress {
        simulation.return_to(self.between.as_deref().unwrap_or(&self.state));
        overwrite(grid, self.between.as_ref().map(|_| &self.state));
        self.progress
    }

    /// The state of a run as a host of the same model takes it up: without a clock of its own, at rest at time 0, and
    /// with inputs that hold.
    fn of_run(state: State, model: &Cosimulation) -> Self {
        let progress = Progress::of(&state, model);
        let parameters = model.parameters_in(state.stage as usize);
        let first = Self::first(&model.simulation, &model.hash, &model.parameters);
        Self { state, progress, parameters, checked: false, ..first }
    }
}

/// The last point of the grid, unless the model goes on from where it stands, because an input has changed.
pub(super) fn kept(grid: Option<&State>, progress: Progress) -> Option<&State> {
    grid.filter(|_| !progress.changed)
}

/// Takes over a state of the same model, into the memory of the old one where there was one.
fn overwrite(own: &mut Option<Box<State>>, new: Option<&State>) {
    match (own.as_mut(), new) {
        (Some(own), Some(new)) => (**own).clone_from(new),
        (_, new) => *own = new.cloned().map(Box::new),
    }
}

impl Cosimulation {
    /// The state now.
    pub fn save(&self) -> Saved {
        let (here, grid) = (self.simulation.state(), kept(self.grid.as_deref(), self.progress));
        let (state, between) = (grid.unwrap_or(here).clone(), grid.map(|_| Box::new(here.clone())));
        Saved {
            state,
            between,
            progress: self.progress,
            hash: self.hash.clone(),
            family: self.parameters.family.clone(),
            dt: self.internal_step(),
            parameters: self.parameters.values.clone(),
            aims: self.aims.clone(),
            ways: self.ways.clone(),
            checked: true,
        }
    }

    /// Goes back to a saved state of this model. The numbers of one that [`Cosimulation::save`] made, or that was
    /// checked before, are not checked again.
    ///
    /// # Errors
    /// As [`Cosimulation::check`].
    pub fn restore(&mut self, saved: &Saved) -> Result<(), CosimulationError> {
        self.check_case(saved)?;
        if !saved.checked {
            self.check_numbers(saved)?;
        }
        self.return_to(saved);
        Ok(())
    }

    /// Goes back to a saved state of this model, or of one that differs from it in values of parameters alone, and
    /// keeps the parameters that hold now.
    ///
    /// # Errors
    /// As [`Cosimulation::check`], but for the parameters; a model with another internal step.
    pub fn restore_keeping_parameters(&mut self, saved: &Saved) -> Result<(), CosimulationError> {
        let own = self.adopt(saved)?;
        if !own.checked {
            self.check_numbers(&own)?;
        }
        self.return_to(&own);
        self.progress.changed = true;
        Ok(())
    }

    /// A saved state of a model that differs in values of parameters alone as one of this model, with the parameters
    /// that hold now.
    fn adopt(&self, saved: &Saved) -> Result<Saved, CosimulationError> {
        if saved.family != self.parameters.family {
            let (found, own) = (saved.family.clone(), self.parameters.family.clone());
            return Err(BytesError::OtherCase { found, own }.into());
        }
        let own = self.internal_step();
        if saved.dt.to_bits() != own.to_bits() {
            let limit = format!("{} s, that of this model", Plain(own));
            let remedy = "keep what changes the internal step, such as Young's moduli, or give the case a shorter one";
            return Err(CosimulationError::value(
                "internal step of the state",
                format!("{} s", Plain(saved.dt)),
                &limit,
                remedy,
            ));
        }
        let mut adopted =
            Saved { hash: self.hash.clone(), parameters: self.parameters.values.clone(), ..saved.clone() };
        for state in std::iter::once(&mut adopted.state).chain(adopted.between.as_deref_mut()) {
            if state.stage as usize >= self.case().stages.len() {
                return self.check(&mut adopted).map(|()| adopted);
            }
            self.give_parameters(state);
        }
        Ok(adopted)
    }

    /// Whether a saved state can be one of this model; notes in the state that it can.
    ///
    /// # Errors
    /// The state is of another model, or one of its numbers, indices or lengths cannot be.
    pub fn check(&self, saved: &mut Saved) -> Result<(), CosimulationError> {
        self.check_case(saved)?;
        self.check_numbers(saved)?;
        saved.checked = true;
        Ok(())
    }

    fn check_numbers(&self, saved: &Saved) -> Result<(), CosimulationError> {
        self.check_saved(saved).map_err(|unfit| BytesError::Damaged(unfit.to_string()).into())
    }

    fn check_case(&self, saved: &Saved) -> Result<(), BytesError> {
        if saved.hash == self.hash {
            return Ok(());
        }
        Err(BytesError::OtherCase { found: saved.hash.clone(), own: self.hash.clone() })
    }

    fn check_saved(&self, saved: &Saved) -> Result<(), Unfit> {
        let Saved { state, between, progress, hash: _, family: _, dt: _, parameters, aims, ways, checked: _ } = saved;
        fit::length("parameters", parameters.len(), self.parameters.list.len())?;
        for (parameter, &value) in self.parameters.list.iter().zip(parameters) {
            let (low, high) = (parameter.low.min(parameter.start), parameter.high.max(parameter.start));
            fit::between(&parameter.name, value, low, high)?;
        }
        let Progress { origin, start, started: _, initial_residual, changed: _, interpolation: _, host_time, forces } =
            *progress;
        for input in ways.keys() {
            let (what, index, count) = match *input {
                Input::Block(block) => ("block", block as usize, state.removed.len()),
                Input::Port(port) => ("port", port as usize, self.ports().len()),
                _ => continue,
            };
            fit::at_most(format_args!("interpolation of {what}"), index as u64 + 1, count as u64)?;
        }
        for (&port, aim) in aims {
            let is_fix = self.ports().get(port).is_some_and(|port| port.kind == PortKind::Fix);
            fit::between("port of a displacement", f64::from(u8::from(is_fix)), 1.0, 1.0)?;
            fit::number("displacement of a port", aim.norm(), fit::LENGTH)?;
        }
        self.simulation.check(state)?;
        fit::at_most("origin", origin, state.step)?;
        fit::between("start", start, 0.0, fit::TIME)?;
        fit::between("initial_residual", initial_residual, 0.0, f64::INFINITY)?;
        fit::number("host_time", host_time, fit::TIME)?;
        if let Some(Forces { unbalanced, stored, in_bolts }) = forces {
            fit::between("forces: unbalanced", unbalanced, 0.0, f64::INFINITY)?;
            fit::number("forces: stored", stored, fit::FORCE)?;
            fit::number("forces: in_bolts", in_bolts, fit::FORCE)?;
        }
        let Some(between) = between else { return Ok(()) };
        let named = |unfit: Unfit| Unfit { what: format!("between: {}", unfit.what), ..unfit };
        self.simulation.check(between).map_err(named)?;
        fit::at_most("between: the difference of steps", between.step.abs_diff(state.step), 0)?;
        fit::between("between: part", between.part, state.part, self.internal_step())
    }

    /// Keeps the state that a failure goes back to.
    pub(super) fn keep(&mut self) {
        let values = &self.parameters.values;
        self.backup.aims.clone_from(&self.aims);
        self.backup.ways.clone_from(&self.ways);
        self.backup.overwrite(self.simulation.state(), self.grid.as_deref(), self.progress, values);
    }

    /// Goes back to the state that was kept.
    pub(super) fn roll_back(&mut self) {
        self.serial += 1;
        self.parameters.values.clone_from(&self.backup.parameters);
        self.aims.clone_from(&self.backup.aims);
        self.ways.clone_from(&self.backup.ways);
        self.progress = self.backup.give(&mut self.simulation, &mut self.grid);
        self.show_return();
    }

    fn show_return(&mut self) {
        if let Some(witness) = &mut self.attendance.0 {
            witness.returns(&self.simulation);
        }
    }

    /// Goes back to a saved state.
    fn return_to(&mut self, saved: &Saved) {
        self.serial += 1;
        self.parameters.values.clone_from(&saved.parameters);
        self.aims.clone_from(&saved.aims);
        self.ways.clone_from(&saved.ways);
        self.progress = saved.give(&mut self.simulation, &mut self.grid);
        self.show_return();
    }

    /// Bytes of a saved state: magic, versions, model hash, length, checksum, payload (see [`bytes`]).
    ///
    /// # Errors
    /// The state is of another model, or cannot be serialised.
    pub fn serialize(&self, saved: &Saved) -> Result<Vec<u8>, CosimulationError> {
        self.check_case(saved)?;
        Ok(bytes::encode(Keeper::Model, saved, &self.hash)?)
    }

    /// The saved state in bytes that [`Cosimulation::serialize`] made, in this process or another, or in those of a
    /// checkpoint of `enmm run`. A run in a static stage before the first dynamic one is a model that has not been
    /// started, and goes on there; of a later one the first dynamic stage begins at time 0, and inputs are held.
    ///
    /// # Errors
    /// The bytes are damaged, or of another model or version, or hold what cannot be (see [`Cosimulation::check`]).
    pub fn deserialize(&self, bytes: &[u8]) -> Result<Saved, CosimulationError> {
        let mut saved = self.decoded(bytes)?;
        self.check(&mut saved)?;
        Ok(saved)
    }

    /// The state in bytes of this model, unchecked.
    fn decoded(&self, bytes: &[u8]) -> Result<Saved, BytesError> {
        match bytes::head(Keeper::Model, bytes, &self.hash)?.keeper {
            Keeper::Run => Ok(Saved::of_run(bytes::decode_state(Keeper::Model, bytes, &self.hash)?, self)),
            Keeper::Model | Keeper::Fmu => bytes::decode(Keeper::Model, bytes, &self.hash),
        }
    }

    /// The saved state in bytes, as one of this model, whose parameters it then has: that of a model that differs from
    /// it in values of parameters alone will do, too.
    ///
    /// # Errors
    /// As [`Cosimulation::deserialize`] and [`Cosimulation::restore_keeping_parameters`].
    pub fn deserialize_keeping_parameters(&self, bytes: &[u8]) -> Result<Saved, CosimulationError> {
        let hash = bytes::case_hash(Keeper::Model, bytes)?;
        let mut saved =
            if hash == self.hash { self.decoded(bytes)? } else { bytes::decode(Keeper::Model, bytes, &hash)? };
        saved = self.adopt(&saved)?;
        self.check(&mut saved)?;
        Ok(saved)
    }
}
