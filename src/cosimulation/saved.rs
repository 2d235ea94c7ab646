//! Saved states: all that a model needs to go on with the same bits, in memory or as bytes for another process.

use serde::{Deserialize, Serialize};

use crate::io::checkpoint::{self, CheckpointError};
use crate::model::Simulation;
use crate::state::State;

use super::{Cosimulation, CosimulationError, Standing};

/// The state of a model at one instant, with the inputs that hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// Hash of the model.
    hash: String,
    state: State,
    grid: Option<Box<State>>,
    standing: Standing,
}

impl Saved {
    pub(super) fn of(state: &State, hash: &str) -> Self {
        Self { hash: hash.to_owned(), state: state.clone(), grid: None, standing: Standing::default() }
    }

    /// Takes another state of the same model, into the memory of the old one.
    pub(super) fn overwrite(&mut self, state: &State, grid: Option<&State>, standing: Standing) {
        self.state.copy_from(state);
        overwrite(&mut self.grid, grid);
        self.standing = standing;
    }

    /// Copies the state into a model, into the memory of its own, and returns where it stood.
    fn give(&self, simulation: &mut Simulation, grid: &mut Option<Box<State>>) -> Standing {
        simulation.return_to(&self.state);
        overwrite(grid, self.grid.as_deref());
        self.standing
    }
}

/// Takes over a state of the same model, into the memory of the old one where there was one.
fn overwrite(own: &mut Option<Box<State>>, new: Option<&State>) {
    match (own.as_mut(), new) {
        (Some(own), Some(new)) => own.copy_from(new),
        (_, new) => *own = new.cloned().map(Box::new),
    }
}

impl Cosimulation {
    /// The state now.
    pub fn save(&self) -> Saved {
        let (state, grid) = (self.simulation.state().clone(), self.grid.clone());
        Saved { hash: self.hash.clone(), state, grid, standing: self.standing }
    }

    /// Goes back to a saved state of this model.
    ///
    /// # Errors
    /// The state is of another model.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), CosimulationError> {
        self.check_case(saved)?;
        if !self.fits(saved) {
            let damage = "its state does not fit the model";
            return Err(CheckpointError::Damaged(damage.to_owned()).into());
        }
        self.return_to(saved);
        Ok(())
    }

    fn check_case(&self, saved: &Saved) -> Result<(), CheckpointError> {
        if saved.hash == self.hash {
            return Ok(());
        }
        Err(CheckpointError::OtherCase { found: saved.hash.clone(), own: self.hash.clone() })
    }

    /// Whether every index and time of a saved state makes sense for this model.
    fn fits(&self, saved: &Saved) -> bool {
        let Saved { state, grid, standing, .. } = saved;
        let dt = self.internal_step();
        let on_grid = |state: &State| (0.0..dt).contains(&state.part) && standing.origin <= state.step;
        standing.told.is_finite()
            && standing.start.is_finite()
            && std::iter::once(state).chain(grid.as_deref()).all(|state| on_grid(state) && self.simulation.fits(state))
    }

    /// Keeps the state that a failure goes back to.
    pub(super) fn keep(&mut self) {
        self.backup.overwrite(self.simulation.state(), self.grid.as_deref(), self.standing);
    }

    /// Goes back to the state that was kept.
    pub(super) fn roll_back(&mut self) {
        self.serial += 1;
        self.standing = self.backup.give(&mut self.simulation, &mut self.grid);
    }

    /// Goes back to a saved state.
    fn return_to(&mut self, saved: &Saved) {
        self.serial += 1;
        self.standing = saved.give(&mut self.simulation, &mut self.grid);
    }

    /// Bytes of a saved state: magic, versions, model hash, length, checksum, payload (see [`checkpoint`]).
    ///
    /// # Errors
    /// The state is of another model, or cannot be serialised.
    pub fn serialize(&self, saved: &Saved) -> Result<Vec<u8>, CosimulationError> {
        self.check_case(saved)?;
        checkpoint::encode(saved, &self.hash)
            .map_err(|error| CosimulationError::State(CheckpointError::Damaged(error.to_string())))
    }

    /// The saved state in bytes that [`Cosimulation::serialize`] made, in this process or another.
    ///
    /// # Errors
    /// The bytes are damaged, or of another model or version.
    pub fn deserialize(&self, bytes: &[u8]) -> Result<Saved, CosimulationError> {
        Ok(checkpoint::decode(bytes, &self.hash)?)
    }
}
