//! The equations of a net: imbalances of nodes and their slopes.

use crate::law::{self, DELTA, LEVEL, pressure_head};
use crate::net::{Condition, Net, Storage};

/// Share of the sum of conductances at a node that holds it where no equation does.
const HOLD: f64 = 1e-13;
/// Greatest imbalance of a node that is in balance, over the greatest flow in a pipe.
const BALANCE: f64 = 1e-12;
/// Round-off of a head, over heads and drops.
const ROUND_OFF: f64 = 4e-15;

/// Unknowns of a net, and on which branch of its laws each node is: its water has pressure, or runs as a film.
#[derive(Debug, Clone)]
pub struct State {
    /// Unknowns (m).
    pub u: Vec<f64>,
    /// Whether slopes are those of a node with pressure.
    pub wet: Vec<bool>,
}

impl State {
    /// Of unknowns, each on its own branch.
    pub fn of(u: Vec<f64>) -> Self {
        let wet = u.iter().map(|&u| u > 0.0).collect();
        Self { u, wet }
    }
}

/// Hold of nodes to an older state.
#[derive(Debug)]
pub enum Hold<'a> {
    /// Nothing: the flow is steady.
    Nothing,
    /// Water stored since older unknowns (m), within a time (s).
    Store(Storage<'a>, Vec<f64>, f64),
}

/// The equations.
#[derive(Debug)]
pub struct Problem<'a> {
    pub net: &'a Net,
    pub conductance: &'a [f64],
    /// Sum of the conductances at each node (m²/s per m).
    pub sums: Vec<f64>,
    /// Water given to each node (m²/s).
    pub sources: Vec<f64>,
    /// Whether each node has an equation; others keep their unknown.
    pub unknown: Vec<bool>,
    /// Greatest unknown that each node can have (m), and whether water runs off there.
    pub tops: Vec<(f64, bool)>,
    pub hold: Hold<'a>,
    /// Scale of the unknown of each node below 0 (m), in place of `DELTA`: the mean drop of the pipes that lead down
    /// from it, by their conductances, so that the slope of its outflow is the same above 0.
    pub scales: Vec<f64>,
}

/// Pressure head (m) and filling of the upper and of the lower node of a pipe.
type Waters = [(f64, f64); 2];

/// Terms of a pipe.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// Parts of the imbalances of its upper and its lower node (m²/s).
    imbalance: [f64; 2],
    /// Flow down the pipe (m²/s).
    flow: f64,
}

/// Imbalance of each node, what flows out and is stored less what flows in (m²/s), and the greatest allowed.
#[derive(Debug, Clone)]
pub struct Imbalance {
    pub values: Vec<f64>,
    pub allowed: Vec<f64>,
    /// Imbalance that is allowed everywhere (m²/s), apart from round-off.
    pub least_allowed: f64,
}

impl<'a> Problem<'a> {
    /// Of steady flow, in a net all of whose pieces water reaches.
    pub fn of(net: &'a Net, conductance: &'a [f64], conditions: &[Condition]) -> Self {
        let mut sums = vec![0.0; conditions.len()];
        for (&[a, b], &conducts) in net.ends.iter().zip(conductance) {
            sums[a as usize] += conducts;
            sums[b as usize] += conducts;
        }
        let source = |condition: &Condition| match *condition {
            Condition::Free { source } => source,
            Condition::Rain { rate } => rate,
            Condition::Held { .. } | Condition::Air => 0.0,
        };
        let is_unknown = |condition: &Condition| matches!(condition, Condition::Free { .. } | Condition::Rain { .. });
        let top = |condition: &Condition| match condition {
            Condition::Rain { .. } => (0.0, true),
            _ => (f64::INFINITY, false),
        };
        Self {
            net,
            conductance,
            sums,
            sources: conditions.iter().map(source).collect(),
            unknown: conditions.iter().map(is_unknown).collect(),
            tops: conditions.iter().map(top).collect(),
            hold: Hold::Nothing,
            scales: scales(net, conductance),
        }
    }

    /// Unknown (m) by the scale of its node of one by `DELTA`.
    pub fn scaled(&self, node: usize, u: f64) -> f64 {
        if u < 0.0 { u / DELTA * self.scales[node] } else { u }
    }

    /// Unknown (m) by `DELTA` of one by the scale of its node.
    pub fn unscaled(&self, node: usize, u: f64) -> f64 {
        if u < 0.0 { (u / self.scales[node]).max(-1.0) * DELTA } else { u }
    }

    /// Share of its capacity with which a film leaves a node. On the way to a flow an unknown may be below the scale:
    /// there is no kink, so that fewer stand in the way. No flow has such unknowns.
    fn filling(&self, node: usize, u: f64) -> f64 {
        (1.0 + u / self.scales[node]).min(1.0)
    }

    /// Waters at the ends of a pipe, of the unknowns of its upper and lower node.
    fn waters(&self, pipe: usize, u: [f64; 2]) -> Waters {
        let ends = self.net.ends[pipe];
        [0, 1].map(|k| (pressure_head(u[k]), self.filling(ends[k] as usize, u[k])))
    }

    /// Waters at the ends of a pipe.
    fn waters_of(&self, pipe: usize, u: &[f64]) -> Waters {
        self.waters(pipe, self.net.ends[pipe].map(|end| u[end as usize]))
    }

    /// Flow (m²/s) down a pipe, of the unknowns of its upper and lower node.
    fn flow_between(&self, pipe: usize, u: [f64; 2]) -> f64 {
        let upper = (pressure_head(u[0]), self.filling(self.net.ends[pipe][0] as usize, u[0]));
        law::flow_of(self.conductance[pipe], self.net.drops[pipe], upper, pressure_head(u[1]))
    }

    /// Flow (m²/s) down each pipe.
    pub fn flow(&self, pipe: usize, u: &[f64]) -> f64 {
        let [a, b] = self.net.ends[pipe];
        self.flow_between(pipe, [u[a as usize], u[b as usize]])
    }

    /// Imbalances of all nodes, those without an equation too.
    pub fn imbalance(&self, u: &[f64], out: &mut Imbalance) {
        out.values.iter_mut().zip(&self.sources).for_each(|(value, source)| *value = -source);
        out.allowed.fill(0.0);
        let mut most = self.sources.iter().fold(0.0_f64, |most, source| most.max(source.abs()));
        for (pipe, &[a, b]) in self.net.ends.iter().enumerate() {
            let (a, b) = (a as usize, b as usize);
            let part = self.part(pipe, [u[a], u[b]]);
            most = most.max(part.flow.abs());
            out.values[a] += part.imbalance[0];
            out.values[b] += part.imbalance[1];
            let [at_a, at_b] = self.round_off(pipe, [u[a], u[b]]);
            out.allowed[a] += at_a;
            out.allowed[b] += at_b;
        }
        out.least_allowed = BALANCE * most;
        out.allowed.iter_mut().for_each(|allowed| *allowed = ROUND_OFF * *allowed + out.least_allowed);
    }

    /// Imbalance of one node with an unknown of its own (m²/s), and its slope on a branch.
    pub fn imbalance_of(&self, node: usize, own: f64, wet: bool, state: &State) -> (f64, f64) {
        let (mut value, mut slope) = (-self.sources[node], 0.0);
        for &pipe in self.net.pipes_of(node) {
            let pipe = pipe as usize;
            let [a, b] = self.net.ends[pipe].map(|end| end as usize);
            let at = usize::from(b == node);
            let (mut u, mut branch) = ([state.u[a], state.u[b]], [state.wet[a], state.wet[b]]);
            (u[at], branch[at]) = (own, wet);
            value += self.part(pipe, u).imbalance[at];
            slope += self.slopes(pipe, u, branch)[at][at];
        }
        (value, slope)
    }

    /// Round-off of imbalances of one node (m²/s).
    pub fn allowed_of(&self, node: usize, state: &State) -> f64 {
        let sum = self.net.pipes_of(node).iter().fold(0.0, |sum, &pipe| {
            let [a, b] = self.net.ends[pipe as usize].map(|end| end as usize);
            sum + self.round_off(pipe as usize, [state.u[a], state.u[b]])[usize::from(b == node)]
        });
        ROUND_OFF * sum
    }

    /// Slope that holds a node where no pipe does, as in stagnant pools.
    pub fn own_slope(&self, node: usize) -> f64 {
        self.sums[node] * HOLD
    }

    /// Imbalances by a pipe with the unknowns of its upper and lower node.
    fn part(&self, pipe: usize, [upper, lower]: [f64; 2]) -> Part {
        let drop = self.net.drops[pipe];
        let flow = self.flow_between(pipe, [upper, lower]);
        let mut imbalance = [flow, -flow];
        if let Hold::Store(storage, old, time) = &self.hold {
            let stored = stored(storage, pipe, drop, self.waters(pipe, [upper, lower]), self.waters_of(pipe, old));
            imbalance[0] += stored[0] / time;
            imbalance[1] += stored[1] / time;
        }
        Part { imbalance, flow }
    }

    /// Slopes of the imbalances of the upper and lower node of a pipe, by the unknown of the upper and of the lower.
    pub fn slopes(&self, pipe: usize, u: [f64; 2], wet: [bool; 2]) -> [[f64; 2]; 2] {
        let (drop, conductance) = (self.net.drops[pipe], self.conductance[pipe]);
        let a = self.net.ends[pipe][0] as usize;
        let (falls, room) = (self.filling(a, u[0]) * drop, drop - pressure_head(u[1]));
        let is_film = falls < room || (falls <= room && !wet[1]);
        let by_upper = match (wet[0], is_film) {
            (true, _) => conductance,
            (false, true) => conductance * drop / self.scales[a],
            (false, false) => 0.0,
        };
        let by_lower = if is_film || !wet[1] { 0.0 } else { -conductance };
        let mut slopes = [[by_upper, by_lower], [-by_upper, -by_lower]];
        if let Hold::Store(storage, old, time) = &self.hold {
            let waters = [self.waters(pipe, u), self.waters_of(pipe, old)];
            let ([aa, ab], bb) = stored_slopes(
                storage,
                pipe,
                drop,
                waters,
                (wet, [self.scales[a], self.scales[self.net.ends[pipe][1] as usize]]),
            );
            slopes[0][0] += aa / time;
            slopes[0][1] += ab / time;
            slopes[1][1] += bb / time;
        }
        slopes
    }

    /// Size of the terms of a pipe, of which round-off is a share, at its upper and lower node (m²/s).
    fn round_off(&self, pipe: usize, u: [f64; 2]) -> [f64; 2] {
        let flows = u.map(|u| self.conductance[pipe] * (u.abs() + self.net.drops[pipe]));
        match &self.hold {
            Hold::Store(storage, _, time) => {
                let (volume, compliance) = (storage.volume[pipe], storage.compliance[pipe]);
                [0, 1].map(|k| flows[k] + (volume + compliance * u[k].abs()) / time)
            }
            _ => flows,
        }
    }
}

/// Scales of the unknowns of nodes below 0 (m).
fn scales(net: &Net, conductance: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); net.heights().len()];
    for (pipe, &[upper, _]) in net.ends.iter().enumerate() {
        let (drops, conducts) = &mut sums[upper as usize];
        *drops += conductance[pipe] * net.drops[pipe];
        *conducts += if net.drops[pipe] > 0.0 { conductance[pipe] } else { 0.0 };
    }
    sums.into_iter().map(|(drops, conducts)| if drops > 0.0 { drops / conducts } else { DELTA }).collect()
}

/// Water (m²) that a pipe books to its upper and to its lower node as its waters change: below the surface it is full,
/// above it the film stands in it. The two add up to what it holds more.
fn stored(storage: &Storage, pipe: usize, drop: f64, now: Waters, was: Waters) -> [f64; 2] {
    let (volume, half) = (storage.volume[pipe], 0.5 * storage.compliance[pipe]);
    let filled = [0, 1].map(|k| now[k].1 - was[k].1);
    let [top, foot] = if drop < LEVEL {
        filled.map(|filled| 0.5 * volume * filled)
    } else {
        let (full, was_full) = (law::wet_share(now[1].0, drop), law::wet_share(was[1].0, drop));
        [volume * (1.0 - full) * filled[0], volume * (1.0 - was[0].1) * (full - was_full)]
    };
    [top + half * (now[0].0 - was[0].0), foot + half * (now[1].0 - was[1].0)]
}

/// Slopes of what a pipe books: of the upper node by both unknowns, of the lower one by its own. `wet` says which ends
/// have pressure; scales are those of both.
fn stored_slopes(
    storage: &Storage,
    pipe: usize,
    drop: f64,
    [now, was]: [Waters; 2],
    (wet, scales): ([bool; 2], [f64; 2]),
) -> ([f64; 2], f64) {
    let (volume, half) = (storage.volume[pipe], 0.5 * storage.compliance[pipe]);
    let by_film = [0, 1].map(|k| if wet[k] { 0.0 } else { volume / scales[k] });
    let pressed = wet.map(|wet| if wet { half } else { 0.0 });
    if drop < LEVEL {
        return ([0.5 * by_film[0] + pressed[0], 0.0], 0.5 * by_film[1] + pressed[1]);
    }
    let fills = if wet[1] && now[1].0 < drop { 1.0 / drop } else { 0.0 };
    let empty = 1.0 - law::wet_share(now[1].0, drop);
    let upper = [by_film[0] * empty + pressed[0], -volume * (now[0].1 - was[0].1) * fills];
    (upper, volume * (1.0 - was[0].1) * fills + pressed[1])
}
