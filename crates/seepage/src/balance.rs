//! Nodes balanced one by one: where many change between pressure and film at once, Newton's method circles.

use crate::problem::{Problem, State};

/// Most sweeps over the nodes.
const SWEEPS_MAX: u32 = 200;
/// Change of an unknown (m) below which sweeps end.
const CHANGE: f64 = 1e-9;
/// Most steps to the root of one node.
const STEPS_MAX: u32 = 60;

/// Balances nodes and those two pipes round them one after the other, from the top down, until they rest. `least` is
/// the imbalance (m²/s) that is allowed everywhere.
pub fn around(problem: &Problem, state: &mut State, crossed: &[u32], least: f64) {
    let nodes = near(problem, crossed);
    for _ in 0..SWEEPS_MAX {
        let mut change = 0.0_f64;
        for &node in &nodes {
            let to = root(problem, state, node as usize, least);
            change = change.max((to - state.u[node as usize]).abs());
            state.u[node as usize] = to;
            state.wet[node as usize] = to > 0.0;
        }
        if change <= CHANGE {
            break;
        }
    }
}

/// Nodes with an equation within two pipes of others, the highest first.
fn near(problem: &Problem, crossed: &[u32]) -> Vec<u32> {
    let net = problem.net;
    let mut seen = vec![false; net.heights().len()];
    let mut nodes = crossed.to_vec();
    nodes.iter().for_each(|&node| seen[node as usize] = true);
    let mut reached = 0;
    for _ in 0..2 {
        let from = std::mem::replace(&mut reached, nodes.len());
        for at in from..reached {
            for &pipe in net.pipes_of(nodes[at] as usize) {
                if problem.conductance[pipe as usize] > 0.0 {
                    let ends = net.ends[pipe as usize];
                    nodes.extend(ends.into_iter().filter(|&end| !std::mem::replace(&mut seen[end as usize], true)));
                }
            }
        }
    }
    nodes.retain(|&node| problem.unknown[node as usize]);
    let heights = net.heights();
    nodes.sort_unstable_by(|&a, &b| heights[b as usize].total_cmp(&heights[a as usize]).then(a.cmp(&b)));
    nodes
}

/// The unknown (m) with which a node is in balance, those of its neighbours being as they are: its own where that will
/// do, else within its limits. The imbalance rises with the unknown, in straight pieces.
fn root(problem: &Problem, state: &State, node: usize, least: f64) -> f64 {
    let allowed = least + problem.allowed_of(node, state);
    let at = |u: f64| problem.imbalance_of(node, u, u > 0.0, state);
    let mut u = state.u[node];
    let (mut value, mut slope) = at(u);
    if value.abs() <= allowed {
        return u;
    }
    let (mut low, mut high) = (-problem.scales[node], u);
    if value > 0.0 {
        if at(low).0 >= -allowed {
            return low;
        }
    } else {
        low = u;
        high = match ceiling(problem, node, u, &|u| at(u).0) {
            Ok(high) => high,
            Err(top) => return top,
        };
    }
    for _ in 0..STEPS_MAX {
        let newton = u - value / slope;
        u = if slope > 0.0 && newton > low && newton < high { newton } else { 0.5 * (low + high) };
        (value, slope) = at(u);
        if value.abs() <= allowed {
            break;
        }
        *(if value > 0.0 { &mut high } else { &mut low }) = u;
    }
    u
}

/// An unknown (m) above `u` with which more flows out of a node than in, or its greatest one, as an error, where it
/// has none.
fn ceiling(problem: &Problem, node: usize, u: f64, value: &dyn Fn(f64) -> f64) -> Result<f64, f64> {
    let top = problem.tops[node].0;
    if top.is_finite() {
        return if value(top) > 0.0 { Ok(top) } else { Err(top) };
    }
    let mut reach = 1.0;
    for _ in 0..STEPS_MAX {
        if value(u + reach) > 0.0 {
            return Ok(u + reach);
        }
        reach *= 2.0;
    }
    Err(u)
}
