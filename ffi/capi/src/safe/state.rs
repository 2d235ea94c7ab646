//! Saved states behind handles.

use std::sync::Mutex;

use engine::cosimulation::Saved;

use super::failure::{Failure, Outcome};
use super::handles::Table;
use super::model::Model;

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
}

impl Model {
    /// Saves the state and returns its handle.
    ///
    /// # Errors
    /// When too many states are alive.
    pub fn save(&self) -> Result<usize, Failure> {
        STATES.insert(Kept::of(self.inner.save()))
    }

    /// Goes back to a state.
    ///
    /// # Errors
    /// A dead state, or one of another case.
    pub fn restore(&mut self, state: usize) -> Outcome {
        let kept = STATES.find(state)?;
        Ok(self.inner.restore(&kept.saved)?)
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

    /// Makes a state of bytes and returns its handle.
    ///
    /// # Errors
    /// Bytes that are damaged, or of another case or version.
    pub fn deserialize(&self, bytes: &[u8]) -> Result<usize, Failure> {
        STATES.insert(Kept::of(self.inner.deserialize(bytes)?))
    }
}
