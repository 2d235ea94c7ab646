//! Tables of models and states, with messages for handles that lead to none.

use std::sync::Arc;

use enmm_handles::Missing;

use super::failure::{Failure, Outcome};
use crate::types::enmm_status;

/// A table of objects of one kind.
pub struct Table<T> {
    kind: &'static str,
    alive: enmm_handles::Table<T>,
}

impl<T: Send + Sync + 'static> Table<T> {
    /// An empty table; `tag` is part of its handles, `kind` of messages.
    pub const fn new(tag: u8, kind: &'static str) -> Self {
        Self { kind, alive: enmm_handles::Table::new(tag) }
    }

    /// Takes an object and returns its handle.
    ///
    /// # Errors
    /// When millions of objects are alive.
    pub fn insert(&'static self, object: T) -> Result<usize, Failure> {
        self.alive.insert(object).map_err(|_| {
            let message = format!("too many {}s are alive; destroy those that are no longer needed", self.kind);
            Failure::new(enmm_status::ENMM_INVALID_ARGUMENT, message)
        })
    }

    /// The object of a handle.
    ///
    /// # Errors
    /// The handle is NULL, or dead, or was never one of this table.
    pub fn find(&self, handle: usize) -> Result<Arc<T>, Failure> {
        self.alive.find(handle).map_err(|missing| self.failure(missing))
    }

    /// Gives a handle free; the object goes when the last call that uses it ends.
    ///
    /// # Errors
    /// As [`Table::find`].
    pub fn remove(&self, handle: usize) -> Outcome {
        self.alive.remove(handle).map_err(|missing| self.failure(missing))
    }

    fn failure(&self, missing: Missing) -> Failure {
        let kind = self.kind;
        match missing {
            Missing::Null => {
                let message = format!("the {kind} is NULL; create it first and check the status");
                Failure::new(enmm_status::ENMM_NULL_ARGUMENT, message)
            }
            Missing::Dead => {
                let message =
                    format!("the {kind} is dead: it was destroyed, or this never was a {kind}; use a living one");
                Failure::new(enmm_status::ENMM_DEAD_HANDLE, message)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_without_an_object_is_refused_by_name() {
        static TABLE: Table<i32> = Table::new(0x10, "thing");
        let handle = TABLE.insert(1).expect("room");
        TABLE.remove(handle).expect("alive");
        let [null, dead] = [0, handle].map(|handle| TABLE.find(handle).expect_err("no such thing"));
        assert_eq!([null.status, dead.status], [enmm_status::ENMM_NULL_ARGUMENT, enmm_status::ENMM_DEAD_HANDLE]);
        assert!(null.message.starts_with("the thing is NULL") && dead.message.starts_with("the thing is dead"));
    }
}
