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
    /// Hash of the model.
    hash: String,
    state: State,
    grid: Option<Box<State>>,
    progress: Progress,
    /// Whether it is of a model of this process, or was found to be as if it were; bytes from elsewhere are not.
    #[serde(skip)]
    checked: bool,
}

impl Saved {
    pub(super) fn of(state: &State, hash: &str) -> Self {
        Self { hash: hash.to_owned(), state: state.clone(), grid: None, progress: Progress::default(), checked: true }
    }

    /// Takes another state of the same model, into the memory of the old one.
    pub(super) fn overwrite(&mut self, state: &State, grid: Option<&State>, progress: Progress) {
        self.state.clone_from(state);
        overwrite(&mut self.grid, grid);
        self.progress = progress;
    }

    /// Copies the state into a model, into the memory of its own, and returns where it stood.
    fn give(&self, simulation: &mut Simulation, grid: &mut Option<Box<State>>) -> Progress {
        simulation.return_to(&self.state);
        overwrite(grid, self.grid.as_deref());
        self.progress
    }
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
        let (state, grid) = (self.simulation.state().clone(), self.grid.clone());
        Saved { hash: self.hash.clone(), state, grid, progress: self.progress, checked: true }
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
        let Saved { hash: _, state, grid, progress, checked: _ } = saved;
        let Progress { origin, start, started: _, initial_residual, changed: _, interpolation: _, host_time } =
            *progress;
        self.simulation.check(state)?;
        fit::at_most("origin", origin, state.step)?;
        fit::between("start", start, 0.0, fit::TIME)?;
        fit::between("initial_residual", initial_residual, 0.0, f64::INFINITY)?;
        fit::number("host_time", host_time, fit::TIME)?;
        let Some(grid) = grid else { return Ok(()) };
        let named = |unfit: Unfit| Unfit { what: format!("grid: {}", unfit.what), ..unfit };
        self.simulation.check(grid).map_err(named)?;
        fit::at_most("grid: the difference of steps", grid.step.abs_diff(state.step), 0)?;
        fit::between("grid: part", grid.part, 0.0, state.part)
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

    /// The saved state in bytes that [`Cosimulation::serialize`] made, in this process or another.
    ///
    /// # Errors
    /// The bytes are damaged, or of another model or version, or hold what cannot be (see [`Cosimulation::check`]).
    pub fn deserialize(&self, bytes: &[u8]) -> Result<Saved, CosimulationError> {
        let mut saved = bytes::decode(Keeper::Model, bytes, &self.hash)?;
        self.check(&mut saved)?;
        Ok(saved)
    }
}
