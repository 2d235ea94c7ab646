//! Names and monitors of a model.

use engine::cosimulation::Named;

use super::failure::Failure;
use super::model::Model;
use crate::numbers::enmm_monitor_state;
use crate::types::enmm_name_kind;

/// Kinds by their numbers.
const KINDS: [(enmm_name_kind, Named); 7] = [
    (enmm_name_kind::ENMM_NAME_JOINT, Named::Joint),
    (enmm_name_kind::ENMM_NAME_LAW, Named::Law),
    (enmm_name_kind::ENMM_NAME_ROCK, Named::Rock),
    (enmm_name_kind::ENMM_NAME_STAGE, Named::Stage),
    (enmm_name_kind::ENMM_NAME_BLOCK, Named::Block),
    (enmm_name_kind::ENMM_NAME_MONITOR, Named::Monitor),
    (enmm_name_kind::ENMM_NAME_PORT, Named::Port),
];

/// The kind of a number.
fn kind_of(number: i32) -> Result<Named, Failure> {
    let found = KINDS.into_iter().find(|(kind, _)| *kind as i32 == number);
    found.map(|(_, kind)| kind).ok_or_else(|| {
        let last = KINDS.len() - 1;
        Failure::invalid(format!("kind: is {number}, must be at least 0 and at most {last}; use enmm_name_kind"))
    })
}

impl Model {
    /// Number of things of a kind, a value of `enmm_name_kind`.
    ///
    /// # Errors
    /// An unknown kind.
    pub fn name_count(&self, kind: i32) -> Result<usize, Failure> {
        Ok(self.inner.name_count(kind_of(kind)?))
    }

    /// Name of a thing by kind and number.
    ///
    /// # Errors
    /// An unknown kind, or a number that is too large.
    pub fn name(&self, kind: i32, index: u32) -> Result<String, Failure> {
        Ok(self.inner.name(kind_of(kind)?, index as usize)?)
    }

    /// State of a monitor.
    ///
    /// # Errors
    /// No such monitor.
    pub fn monitor_state(&self, monitor: u32) -> Result<enmm_monitor_state, Failure> {
        Ok(enmm_monitor_state::from(&self.inner.monitor_state(monitor as usize)?))
    }
}
