//! How much of their strength the bolts of a model use.

use enmm::model::Simulation;
use enmm::model::case::Support;
use enmm_observe::bolts;

/// A bolt that is installed.
#[derive(Debug, Clone, PartialEq)]
pub struct BoltUse {
    /// Its name, or its number in the case.
    pub name: String,
    /// Force that it has in a search for the factor of safety; none where the rock stretches it.
    pub support: Option<Support>,
    /// Greatest tension of a bar along its length (N).
    pub force: f64,
    /// Force at which a bar yields (N); none for never.
    pub yield_force: Option<f64>,
}

impl BoltUse {
    /// Force over yield force.
    pub fn utilisation(&self) -> Option<f64> {
        self.yield_force.map(|limit| self.force / limit)
    }
}

/// The bolts of a model that are there, in their order.
pub fn bolt_uses(simulation: &Simulation) -> Vec<BoltUse> {
    let mut forces = vec![None::<f64>; simulation.case().bolts.len()];
    for line in bolts(simulation).iter().filter(|line| line.condition.number() != 0) {
        let force = &mut forces[line.bolt as usize];
        *force = Some(force.map_or(line.force, |other| other.max(line.force)));
    }
    let of = |(k, (bolt, force)): (usize, (&enmm::model::case::Bolt, Option<f64>))| {
        Some(BoltUse {
            name: bolt.name.clone().unwrap_or_else(|| format!("bolt {k}")),
            support: bolt.support,
            force: force? * bolt.spacing,
            yield_force: bolt.yield_force,
        })
    };
    simulation.case().bolts.iter().zip(forces).enumerate().filter_map(of).collect()
}
