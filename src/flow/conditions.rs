//! Conditions at the nodes of a net: heads, rain, drains, the reservoir, air.

use enmm_seepage::{Condition, Flow};

use super::network::{FlowNet, Outcrop};

/// Where water enters and leaves a net.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Inlet {
    /// A head by its index.
    Head(u32),
    /// Rain by its index.
    Rain(u32),
    /// A drain by its index.
    Drain(u32),
    /// Outcrops below the surface of the reservoir.
    Reservoir,
    /// Outcrops open to the air.
    Air,
}

/// Surroundings of a net.
#[derive(Debug, Clone, Copy)]
pub struct Outside<'a> {
    /// Level of each head (m).
    pub heads: &'a [f64],
    /// Rate of each rain (m/s).
    pub rains: &'a [f64],
    /// Whether each drain acts.
    pub drains: &'a [bool],
    /// Nodes at blocks that have been dug out, and what has come there.
    pub dug: &'a [Outcrop],
    /// Depth (m) below the surface of the reservoir at each node; negative above it, or where there is none.
    pub depths: &'a [f64],
    /// Whether joints conduct at each node.
    pub conducts: &'a [bool],
}

/// Share of the flow through a net below which what leaves at an outcrop is round-off.
const SEEPS: f64 = 1e-9;

/// Whether water can leave or enter a piece of net at a node with a condition; pumps take what others give.
pub fn is_open(condition: &Condition) -> bool {
    !matches!(condition, Condition::Free { .. })
}

impl FlowNet {
    /// Names of inlets, in the order of [`FlowNet::sums`].
    pub fn inlet_names(&self) -> impl Iterator<Item = &str> {
        let heads = self.heads.iter().map(|head| head.name.as_str());
        let rains = self.rains.iter().map(|rain| rain.name.as_str());
        heads.chain(rains).chain(self.drains.iter().map(|drain| drain.name.as_str())).chain(["reservoir", "air"])
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
        for (k, (held, &head)) in self.heads.iter().zip(outside.heads).enumerate() {
            for &node in &held.nodes {
                let condition = &mut found[node as usize];
                if head >= self.places[node as usize].y {
                    *condition = (Condition::Held { head }, Some(Inlet::Head(k as u32)));
                } else if condition.1.is_some() {
                    *condition = (Condition::Air, Some(Inlet::Head(k as u32)));
                }
            }
        }
        self.add_rain(outside.rains, &mut found);
        self.add_drains(outside, &mut found);
        found
    }

    /// Drains that act, where joints within the rock cross them.
    fn add_drains(&self, Outside { drains, conducts, .. }: Outside, found: &mut [(Condition, Option<Inlet>)]) {
        for (k, drain) in self.drains.iter().enumerate().filter(|(k, _)| drains[*k]) {
            let is_free = |&&node: &&u32| found[node as usize].1.is_none() && conducts[node as usize];
            let nodes: Vec<u32> = drain.nodes.iter().filter(is_free).copied().collect();
            for &node in &nodes {
                let condition = match drain.pump {
                    Some(pump) => Condition::Free { source: -pump / nodes.len() as f64 },
                    None if drain.mouth > self.places[node as usize].y => Condition::Held { head: drain.mouth },
                    None => Condition::Air,
                };
                found[node as usize] = (condition, Some(Inlet::Drain(k as u32)));
            }
        }
    }

    /// Rain on outcrops that are open to the air.
    fn add_rain(&self, rates: &[f64], found: &mut [(Condition, Option<Inlet>)]) {
        for (k, (rain, rate)) in self.rains.iter().zip(rates).enumerate() {
            for &(node, width) in &rain.outcrops {
                let condition = &mut found[node as usize];
                if condition.0 == Condition::Air {
                    let rate = rate * width;
                    *condition = (Condition::Rain { rate }, Some(Inlet::Rain(k as u32)));
                }
            }
        }
    }

    /// Height (m) of the highest outcrop from which water seeps, more than the round-off of flows; none where none
    /// does.
    pub fn seeps(&self, conditions: &[(Condition, Option<Inlet>)], flow: &Flow) -> Option<f64> {
        let is_outcrop = |(condition, inlet): &(Condition, Option<Inlet>)| {
            let is_drain = matches!(inlet, Some(Inlet::Drain(_)));
            matches!(condition, Condition::Air | Condition::Rain { .. }) && !is_drain
        };
        let nodes = conditions.iter().zip(&flow.inflow).zip(&self.places);
        let seeping = nodes.filter(|((at, inflow), _)| is_outcrop(at) && -**inflow > SEEPS * flow.through_flow);
        seeping.map(|(_, place)| place.y).reduce(f64::max)
    }

    /// Number of inlets.
    pub fn inlet_count(&self) -> usize {
        self.heads.len() + self.rains.len() + self.drains.len() + 2
    }

    /// Water (m²/s) that enters and leaves at each inlet, and that of rain which runs off: heads, rain, drains, the
    /// reservoir, air.
    pub fn sums(&self, conditions: &[(Condition, Option<Inlet>)], flow: &Flow) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; self.inlet_count()];
        let heads = self.heads.len();
        let after = [heads, heads + self.rains.len(), heads + self.rains.len() + self.drains.len()];
        for ((condition, inlet), inflow) in conditions.iter().zip(&flow.inflow) {
            let place = match inlet {
                Some(Inlet::Head(head)) => *head as usize,
                Some(Inlet::Rain(rain)) => after[0] + *rain as usize,
                Some(Inlet::Drain(drain)) => after[1] + *drain as usize,
                Some(Inlet::Reservoir) => after[2],
                Some(Inlet::Air) => after[2] + 1,
                None => continue,
            };
            let sum = &mut sums[place];
            sum[usize::from(*inflow < 0.0)] += inflow.abs();
            if let Condition::Rain { rate } = condition {
                // Water that wells up leaves as well, but is no rain.
                sum[2] += (rate - inflow.max(0.0)).max(0.0);
            }
        }
        sums
    }
}
