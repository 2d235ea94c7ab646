//! Joints that soften, such as rock bridges: which hold, and which have broken.

use enmm::model::Simulation;

pub use enmm::model::BondState;

/// State of the bond of each edge of the boundary.
pub fn bond_states(simulation: &Simulation) -> Vec<BondState> {
    enmm::model::bond_states(simulation.model(), simulation.state())
}
