//! Saved states: all that a model needs to go on with the same bits, in memory or as bytes for another process.

use serde::{Deserialize, Serialize};

use crate::io::checkpoint::{self, CheckpointError};
use crate::state::State;

use super::{Cosimulation, CosimulationError, Standing};

/// The state of a model at one instant, with the inputs that hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    state: State,
    grid: Option<Box<State>>,
    standing: Standing,
}

impl Saved {
    pub(super) fn of(state: &State) -> Self {
        Self { state: state.clone(), grid: None, standing: Standing::default() }
    }

    /// Takes another state of the same model without allocating.
    pub(super) fn overwrite(&mut self, state: &State, grid: Option<&State>, standing: Standing) {
        self.state.copy_from(state);
        self.grid = grid.cloned().map(Box::new);
        self.standing = standing;
    }
}

impl Cosimulation {
    /// The state now.
    pub fn save(&self) -> Saved {
        Saved { state: self.simulation.state().clone(), grid: self.grid.clone(), standing: self.standing }
    }

    /// Goes back to a saved state of this model.
    ///
    /// # Errors
    /// The state is of another model.
    pub fn restore(&mut self, saved: &Saved) -> Result<(), CosimulationError> {
        let grid_fits = saved.grid.as_ref().is_none_or(|grid| self.simulation.fits(grid));
        if !self.simulation.fits(&saved.state) || !grid_fits {
            let damage = "its state does not fit the model";
            return Err(CheckpointError::Damaged(damage.to_owned()).into());
        }
        self.take(saved.clone());
        Ok(())
    }

    pub(super) fn take(&mut self, saved: Saved) {
        self.simulation.restore(saved.state);
        self.grid = saved.grid;
        self.standing = saved.standing;
    }

    /// Bytes of a saved state: magic, versions, model hash, length, checksum, payload (see [`checkpoint`]).
    ///
    /// # Errors
    /// When the state cannot be serialised.
    pub fn serialize(&self, saved: &Saved) -> Result<Vec<u8>, CosimulationError> {
        checkpoint::encode(saved, &self.hash)
            .map_err(|error| CosimulationError::State(CheckpointError::Damaged(error.to_string())))
    }

    /// The saved state in bytes that [`Cosimulation::serialize`] made, in this process or another.
    ///
    /// # Errors
    /// The bytes are damaged, or of another model or version.
    pub fn deserialize(&self, bytes: &[u8]) -> Result<Saved, CosimulationError> {
        let saved: Saved = checkpoint::decode(bytes, &self.hash)?;
        Ok(saved)
    }
}
