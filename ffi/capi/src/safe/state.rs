//! Saved states behind handles.

use std::sync::Mutex;

use engine::cosimulation::Saved;

use super::failure::{Failure, Outcome};
use super::handles::Table;
use super::model::Model;
use crate::types::ENMM_KEEP_PARAMETERS;

/// States that are alive.
pub static STATES: Table<Kept> = Table::new(0x20, "state");

/// A saved state, and its bytes between the question for their number and their copy.
pub struct Kept {
    saved: Saved,
    bytes: Mutex<Option<Vec<u8>>>,
}

impl Kept {
    fn of(saved: Saved) -> Self {
        Self { saved, bytes: Mutex::new(None) }
    }

    /// The state.
    pub fn saved(&self) -> &Saved {
        &self.saved
    }
}

impl Model {
    /// Saves the state and returns its handle.
    ///
    /// # Errors
    /// When too many states are alive.
    pub fn save(&self) -> Result<usize, Failure> {
        STATES.insert(Kept::of(self.inner.save()))
    }

    /// Goes back to a state in the way of the flags.
    ///
    /// # Errors
    /// A dead state, one of another case, or flags that do not exist.
    pub fn restore_with(&mut self, state: usize, flags: u32) -> Outcome {
        let kept = STATES.find(state)?;
        if keeps_parameters(flags)? {
            self.inner.restore_keeping_parameters(&kept.saved)?;
        } else {
            self.inner.restore(&kept.saved)?;
        }
        Ok(())
    }

    /// Hands the bytes of a state to `copy`, and keeps them when only their number is `asked` for.
    ///
    /// # Errors
    /// A dead state, one of another case, or what `copy` says.
    pub fn serialize(&self, state: usize, asked: bool, copy: impl FnOnce(&[u8]) -> Outcome) -> Outcome {
        let kept = STATES.find(state)?;
        // Another thread that serializes the same state has the lock, or had it when this process was forked.
        let mut bytes = kept.bytes.try_lock().ok();
        let own = match bytes.as_mut().and_then(|bytes| bytes.take()) {
            Some(own) => own,
            None => self.inner.serialize(&kept.saved)?,
        };
        let outcome = copy(&own);
        if let Some(bytes) = bytes.as_mut().filter(|_| asked || outcome.is_err()) {
            **bytes = Some(own);
        }
        outcome
    }

    /// Makes a state of bytes in the way of the flags and returns its handle.
    ///
    /// # Errors
    /// Bytes that are damaged, of another case or version, or flags that do not exist.
    pub fn deserialize_with(&self, bytes: &[u8], flags: u32) -> Result<usize, Failure> {
        STATES.insert(Kept::of(if keeps_parameters(flags)? {
            self.inner.deserialize_keeping_parameters(bytes)?
        } else {
            self.inner.deserialize(bytes)?
        }))
    }
}

/// Whether the flags choose that a model keeps its parameters.
fn keeps_parameters(flags: u32) -> Result<bool, Failure> {
    match flags {
        0 => Ok(false),
        ENMM_KEEP_PARAMETERS => Ok(true),
        _ => Err(Failure::invalid(format!("flags: is {flags}, must be 0 or ENMM_KEEP_PARAMETERS (1)"))),
    }
}
