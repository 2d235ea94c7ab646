//! The net, the conditions at its nodes and the flow in it.

use crate::error::Refused;
use crate::law;
use crate::lu::Symbolic;
use crate::pieces;

/// Condition at a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Condition {
    /// As much flows out as flows in, and as the source gives.
    Free {
        /// Water that a source gives (m²/s); negative: that a pump takes. A pump whose node runs dry takes only what
        /// arrives there, see [`Flow::inflow`].
        source: f64,
    },
    /// The head is given (m, a height); where that is below the node, it is open to the air.
    Held {
        /// Height to which water would rise (m).
        head: f64,
    },
    /// Open to the air, or a drain: there is no pressure, and whatever arrives leaves the net. No water enters.
    Air,
    /// Open to the air, and water is offered; what the net does not take runs off, see [`Flow::run_off`].
    Rain {
        /// Water that is offered (m²/s, 0 or more): rain on the ground around the node.
        rate: f64,
    },
}

/// Room for water in pipes, for steps in time.
#[derive(Debug, Clone, Copy)]
pub struct Storage<'a> {
    /// Volume (m²) of each pipe, see [`crate::law::volume`].
    pub volume: &'a [f64],
    /// Water that a full pipe takes as the pressure head in it rises (m² per m), by water that is compressed and faces
    /// that part: length · γ · (1/kn + e/K). Half of it counts at each end.
    pub compliance: &'a [f64],
}

/// Flow in a net.
#[derive(Debug, Clone, PartialEq)]
pub struct Flow {
    /// Unknown (m) of each node: pressure head above 0, filling of the film below. Dry nodes, and those of pieces that
    /// no condition gives water, have `-DELTA`.
    pub u: Vec<f64>,
    /// Flow (m²/s) in each pipe, from its first node to its second.
    pub flow: Vec<f64>,
    /// Water (m²/s) that enters the net at each node, and leaves where it is negative: at nodes with a head, air or
    /// rain, and at sources. A pump that takes less than it should since its node is dry has here what it does take.
    pub inflow: Vec<f64>,
    /// Water (m²/s) that is offered as rain, or that wells up there, and runs off; 0 at nodes without rain.
    pub run_off: Vec<f64>,
    /// Linear systems that have been solved.
    pub solves: u32,
    /// Greatest imbalance of a node (m²/s).
    pub residual: f64,
    /// Water that goes through the net (m²/s): the sum of what enters.
    pub through_flow: f64,
}

/// Nodes with heights, and pipes between two nodes each: the topology, and the order in which systems are solved.
///
/// Conductances and conditions are given with each solve, so that a net is built once for a model.
#[derive(Debug, Clone)]
pub struct Net {
    heights: Vec<f64>,
    pipes: Vec<[u32; 2]>,
    /// Upper and lower node of each pipe.
    pub(crate) ends: Vec<[u32; 2]>,
    /// Height (m) of the upper node of each pipe above the lower one.
    pub(crate) drops: Vec<f64>,
    /// Where the pipes of each node start in `around`.
    pub(crate) first: Vec<u32>,
    /// Pipes of nodes, node after node.
    pub(crate) around: Vec<u32>,
    pub(crate) symbolic: Symbolic,
}

impl Net {
    /// Of nodes with `heights` (m) and pipes between two of them each.
    ///
    /// # Errors
    /// A height that is not finite, a pipe without two different nodes of the net, or more than 2³⁰ nodes and pipes.
    pub fn new(heights: &[f64], pipes: &[[u32; 2]]) -> Result<Self, Refused> {
        let nodes = heights.len();
        let count = nodes + pipes.len();
        if count > 1 << 30 {
            return Err(Refused::Size { count });
        }
        finite("heights", heights)?;
        let outside = |ends: &[u32; 2]| ends[0] == ends[1] || ends.iter().any(|&node| node as usize >= nodes);
        if let Some(pipe) = pipes.iter().position(outside) {
            return Err(Refused::Ends { pipe, ends: pipes[pipe], nodes });
        }
        let sorted = |&[a, b]: &[u32; 2]| if heights[a as usize] < heights[b as usize] { [b, a] } else { [a, b] };
        let ends: Vec<[u32; 2]> = pipes.iter().map(sorted).collect();
        let drops = ends.iter().map(|&[a, b]| heights[a as usize] - heights[b as usize]).collect();
        let (first, around) = pipes_around(nodes, &ends);
        let symbolic = Symbolic::of(nodes, &ends)?;
        Ok(Self { heights: heights.to_vec(), pipes: pipes.to_vec(), ends, drops, first, around, symbolic })
    }

    /// Heights of the nodes (m).
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// First and second node of each pipe.
    pub fn pipes(&self) -> &[[u32; 2]] {
        &self.pipes
    }

    /// Label of the connected piece of each node, over pipes that conduct: the least node of the piece. Pipes that
    /// `conductance` does not name are closed.
    pub fn pieces(&self, conductance: &[f64]) -> Vec<u32> {
        pieces::labels(self.heights.len(), &self.ends, conductance)
    }

    /// Pipes at a node.
    pub(crate) fn pipes_of(&self, node: usize) -> &[u32] {
        &self.around[self.first[node] as usize..self.first[node + 1] as usize]
    }

    /// Water (m²) in each pipe, of unknowns `u` (m) of the nodes: full below a free surface, a film above it.
    ///
    /// # Errors
    /// Lists of a wrong length, values that are not finite, and negative storage.
    pub fn stored(&self, storage: Storage, u: &[f64]) -> Result<Vec<f64>, Refused> {
        self.check_stored(&storage, u)?;
        let of = |(pipe, &[upper, lower]): (usize, &[u32; 2])| {
            let (upper, lower) = (u[upper as usize], u[lower as usize]);
            law::stored(storage.volume[pipe], storage.compliance[pipe], self.drops[pipe], [upper, lower])
        };
        Ok(self.ends.iter().enumerate().map(of).collect())
    }

    /// Whether storage and unknowns have the right length and values that make sense.
    pub(crate) fn check_stored(&self, storage: &Storage, u: &[f64]) -> Result<(), Refused> {
        length("volume", storage.volume.len(), self.pipes.len())?;
        length("compliance", storage.compliance.len(), self.pipes.len())?;
        length("unknowns", u.len(), self.heights.len())?;
        not_negative("volume", storage.volume)?;
        not_negative("compliance", storage.compliance)?;
        finite("unknowns", u)
    }

    /// Lists of the right length with finite values, and none negative that must not be.
    pub(crate) fn check(&self, conductance: &[f64], conditions: &[Condition]) -> Result<(), Refused> {
        length("conductance", conductance.len(), self.pipes.len())?;
        length("conditions", conditions.len(), self.heights.len())?;
        not_negative("conductance", conductance)?;
        let bad = |condition: &Condition| match *condition {
            Condition::Free { source } if !source.is_finite() => Some(("source", source)),
            Condition::Held { head } if !head.is_finite() => Some(("head", head)),
            Condition::Rain { rate } if !(rate.is_finite() && rate >= 0.0) => Some(("rate", rate)),
            _ => None,
        };
        let found = conditions.iter().enumerate().find_map(|(index, condition)| Some((index, bad(condition)?)));
        found.map_or(Ok(()), |(index, (name, value))| Err(Refused::Value { name, index, value }))
    }
}

/// Whether a list has the length that the net needs.
pub(crate) fn length(name: &'static str, length: usize, needed: usize) -> Result<(), Refused> {
    if length == needed { Ok(()) } else { Err(Refused::Length { name, length, needed }) }
}

/// Whether all values are finite.
pub(crate) fn finite(name: &'static str, values: &[f64]) -> Result<(), Refused> {
    let bad = values.iter().position(|value| !value.is_finite());
    bad.map_or(Ok(()), |index| Err(Refused::Value { name, index, value: values[index] }))
}

/// Whether all values are finite and none is negative.
pub(crate) fn not_negative(name: &'static str, values: &[f64]) -> Result<(), Refused> {
    let bad = values.iter().position(|&value| !(value.is_finite() && value >= 0.0));
    bad.map_or(Ok(()), |index| Err(Refused::Value { name, index, value: values[index] }))
}

/// Pipes at each node in rising order, node after node, and where those of each node start.
fn pipes_around(nodes: usize, ends: &[[u32; 2]]) -> (Vec<u32>, Vec<u32>) {
    let mut first = vec![0u32; nodes + 1];
    ends.iter().flatten().for_each(|&node| first[node as usize + 1] += 1);
    for node in 0..nodes {
        first[node + 1] += first[node];
    }
    let mut next = first.clone();
    let mut around = vec![0u32; 2 * ends.len()];
    for (pipe, pair) in ends.iter().enumerate() {
        for &node in pair {
            around[next[node as usize] as usize] = pipe as u32;
            next[node as usize] += 1;
        }
    }
    (first, around)
}
