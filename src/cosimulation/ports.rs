//! Ports by name and by number.

use crate::model::case::key::list;
use crate::state::Port;

use super::{Cosimulation, CosimulationError};

impl Cosimulation {
    /// Ports of the case, in its order.
    pub fn ports(&self) -> &[Port] {
        &self.simulation.model().ports
    }

    /// Number of the port with a name, from 0 in the order of the case.
    ///
    /// # Errors
    /// No port of the case has the name.
    pub fn find_port(&self, name: &str) -> Result<usize, CosimulationError> {
        self.ports().iter().position(|port| port.name == name).ok_or_else(|| CosimulationError::NoPort {
            name: name.to_owned(),
            ports: list(self.ports().iter().map(|port| port.name.as_str())),
        })
    }

    /// The port with a number.
    ///
    /// # Errors
    /// There is no such port.
    pub fn port(&self, port: usize) -> Result<&Port, CosimulationError> {
        self.ports().get(port).ok_or_else(|| {
            let limit = format!("less than the number of ports, {}", self.ports().len());
            CosimulationError::value("port", port, &limit, "name the place by `[[port]]` in the case")
        })
    }

    /// Block of a port: its own, or that of the first edge of a boundary or joint.
    ///
    /// # Errors
    /// There is no such port.
    pub fn port_block(&self, port: usize) -> Result<u32, CosimulationError> {
        Ok(self.simulation.model().labels[self.port(port)?.block])
    }
}
