//! Names and monitors of a model.

use engine::cosimulation::Named;

use super::failure::Failure;
use super::model::Model;
use crate::numbers::{enmm_inlet_state, enmm_joint_monitor_state, enmm_monitor_state, enmm_monitor_stress};
use crate::types::{enmm_name_kind, enmm_status};

/// Kinds by their numbers.
const KINDS: [(enmm_name_kind, Named); 11] = [
    (enmm_name_kind::ENMM_NAME_JOINT, Named::Joint),
    (enmm_name_kind::ENMM_NAME_LAW, Named::Law),
    (enmm_name_kind::ENMM_NAME_ROCK, Named::Rock),
    (enmm_name_kind::ENMM_NAME_STAGE, Named::Stage),
    (enmm_name_kind::ENMM_NAME_BLOCK, Named::Block),
    (enmm_name_kind::ENMM_NAME_MONITOR, Named::Monitor),
    (enmm_name_kind::ENMM_NAME_PORT, Named::Port),
    (enmm_name_kind::ENMM_NAME_HEAD, Named::Head),
    (enmm_name_kind::ENMM_NAME_RAIN, Named::Rain),
    (enmm_name_kind::ENMM_NAME_DRAIN, Named::Drain),
    (enmm_name_kind::ENMM_NAME_JOINT_MONITOR, Named::JointMonitor),
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

    /// Number of the thing of a kind with a name.
    ///
    /// # Errors
    /// An unknown kind, or a name that none has.
    pub fn find_name(&self, kind: i32, name: &str) -> Result<u32, Failure> {
        let kind = kind_of(kind)?;
        let found = self.inner.find_name(kind, name);
        Ok(found.map_err(|error| Failure::new(enmm_status::ENMM_NOT_FOUND, error.to_string()))? as u32)
    }

    /// Water at a head, in rain or at a drain.
    ///
    /// # Errors
    /// Another kind, or a number that is too large.
    pub fn inlet_state(&self, kind: i32, index: u32) -> Result<enmm_inlet_state, Failure> {
        Ok(enmm_inlet_state::from(&self.inner.inlet(kind_of(kind)?, index as usize)?))
    }

    /// Level (m) of a head, rate (m/s) of rain, or 1 for a drain that acts, as it is set.
    ///
    /// # Errors
    /// Another kind, or a number that is too large.
    pub fn inlet_input(&self, kind: i32, index: u32) -> Result<f64, Failure> {
        let (kind, index) = (kind_of(kind)?, index as usize);
        self.inner.inlet(kind, index)?;
        let inputs = self.inner.inputs();
        Ok(match kind {
            Named::Head => inputs.head[index],
            Named::Rain => inputs.rain[index],
            _ => f64::from(u8::from(inputs.drain[index])),
        })
    }

    /// State of a monitor.
    ///
    /// # Errors
    /// No such monitor.
    pub fn monitor_state(&self, monitor: u32) -> Result<enmm_monitor_state, Failure> {
        Ok(enmm_monitor_state::from(&self.inner.monitor_state(monitor as usize)?))
    }

    /// Stress at a monitor.
    ///
    /// # Errors
    /// No such monitor, or one that reads no stress.
    pub fn monitor_stress(&self, monitor: u32) -> Result<enmm_monitor_stress, Failure> {
        Ok(enmm_monitor_stress::from(&self.inner.monitor_stress(monitor as usize)?))
    }

    /// State of a monitor of a joint.
    ///
    /// # Errors
    /// No such monitor.
    pub fn joint_monitor_state(&self, monitor: u32) -> Result<enmm_joint_monitor_state, Failure> {
        Ok(enmm_joint_monitor_state::from(&self.inner.joint_monitor_state(monitor as usize)?))
    }
}
