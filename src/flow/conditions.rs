//! Conditions at the nodes of a net: heads, the reservoir, air.

use enmm_seepage::{Condition, Flow};

use super::network::{FlowNet, Outcrop};

/// Where water enters and leaves a net.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Inlet {
    /// A head by its index.
    Head(u32),
    /// Outcrops below the surface of the reservoir.
    Reservoir,
    /// Outcrops open to the air.
    Air,
}

/// Surroundings of a net at the start of a stage.
#[derive(Debug, Clone, Copy)]
pub struct Outside<'a> {
    /// Stage, for the levels of heads.
    pub stage: usize,
    /// Nodes at blocks that have been dug out, and what has come there.
    pub dug: &'a [Outcrop],
    /// Depth (m) below the surface of the reservoir at each node; negative above it, or where there is none.
    pub depths: &'a [f64],
}

impl FlowNet {
    /// Names of inlets, in the order of [`FlowNet::sums`].
    pub fn inlet_names(&self) -> impl Iterator<Item = &str> {
        self.heads.iter().map(|head| head.name.as_str()).chain(["reservoir", "air"])
    }

    /// Condition at each node, and which inlet it is.
    pub fn conditions(&self, outside: Outside) -> Vec<(Condition, Option<Inlet>)> {
        let free = (Condition::Free { source: 0.0 }, None);
        let at = |node: usize| {
            let [y, depth] = [self.places[node].y, outside.depths[node]];
            match self.outcrops[node].max(outside.dug[node]) {
                Outcrop::None => free,
                Outcrop::Reservoir if depth > 0.0 => (Condition::Held { head: y + depth }, Some(Inlet::Reservoir)),
                Outcrop::Air | Outcrop::Reservoir => (Condition::Air, Some(Inlet::Air)),
            }
        };
        let mut found: Vec<_> = (0..self.places.len()).map(at).collect();
        for (k, held) in self.heads.iter().enumerate() {
            let head = held.levels[outside.stage];
            for &node in &held.nodes {
                let condition = &mut found[node as usize];
                if head >= self.places[node as usize].y {
                    *condition = (Condition::Held { head }, Some(Inlet::Head(k as u32)));
                } else if condition.1.is_some() {
                    *condition = (Condition::Air, Some(Inlet::Head(k as u32)));
                }
            }
        }
        found
    }

    /// Water (m²/s) that enters and leaves at each inlet: heads, the reservoir, air.
    pub fn sums(&self, conditions: &[(Condition, Option<Inlet>)], flow: &Flow) -> Vec<[f64; 2]> {
        let mut sums = vec![[0.0; 2]; self.heads.len() + 2];
        for ((_, inlet), inflow) in conditions.iter().zip(&flow.inflow) {
            let place = match inlet {
                Some(Inlet::Head(head)) => *head as usize,
                Some(Inlet::Reservoir) => self.heads.len(),
                Some(Inlet::Air) => self.heads.len() + 1,
                None => continue,
            };
            sums[place][usize::from(*inflow < 0.0)] += inflow.abs();
        }
        sums
    }
}
