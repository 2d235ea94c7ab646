//! Saved states: all that a model needs to go on with the same bits, in memory or as bytes for another process.

use serde::{Deserialize, Serialize};

use crate::model::Simulation;
use crate::model::fit::{self, Unfit};
use crate::state::State;
use crate::state::bytes::{self, BytesError, Keeper};

use super::{Cosimulation, CosimulationError, Progress};

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
    /// Whether it is of a model of this process, or was found to be as if it were; bytes from elsewhere are not.
    #[serde(skip)]
    checked: bool,
}

impl Saved {
    pub(super) fn of(state: &State, hash: &str) -> Self {
        let (hash, progress) = (hash.to_owned(), Progress::default());
        Self { state: state.clone(), between: None, progress, hash, checked: true }
    }

    /// Takes another state of the same model, into the memory of the old one.
    pub(super) fn overwrite(&mut self, state: &State, grid: Option<&State>, progress: Progress) {
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
        Self { state, between: None, progress, hash: model.hash.clone(), checked: false }
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
        Saved { state, between, progress: self.progress, hash: self.hash.clone(), checked: true }
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
        let Saved { state, between, progress, hash: _, checked: _ } = saved;
        let Progress { origin, start, started: _, initial_residual, changed: _, interpolation: _, host_time } =
            *progress;
        self.simulation.check(state)?;
        fit::at_most("origin", origin, state.step)?;
        fit::between("start", start, 0.0, fit::TIME)?;
        fit::between("initial_residual", initial_residual, 0.0, f64::INFINITY)?;
        fit::number("host_time", host_time, fit::TIME)?;
        let Some(between) = between else { return Ok(()) };
        let named = |unfit: Unfit| Unfit { what: format!("between: {}", unfit.what), ..unfit };
        self.simulation.check(between).map_err(named)?;
        fit::at_most("between: the difference of steps", between.step.abs_diff(state.step), 0)?;
        fit::between("between: part", between.part, state.part, self.internal_step())
    }

    /// Keeps the state that a failure goes back to.
    pub(super) fn keep(&mut self) {
        self.backup.overwrite(self.simulation.state(), self.grid.as_deref(), self.progress);
    }

    /// Goes back to the state that was kept.
    pub(super) fn roll_back(&mut self) {
        self.serial += 1;
        self.progress = self.backup.give(&mut self.simulation, &mut self.grid);
        self.show_return();
    }

    fn show_return(&mut self) {
        if let Some(witness) = &mut self.watch.0 {
            witness.returns(&self.simulation);
        }
    }

    /// Goes back to a saved state.
    fn return_to(&mut self, saved: &Saved) {
        self.serial += 1;
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
        let mut saved = match bytes::head(Keeper::Model, bytes, &self.hash)?.keeper {
            Keeper::Run => Saved::of_run(bytes::decode_state(Keeper::Model, bytes, &self.hash)?, self),
            Keeper::Model | Keeper::Fmu => bytes::decode(Keeper::Model, bytes, &self.hash)?,
        };
        self.check(&mut saved)?;
        Ok(saved)
    }
}
