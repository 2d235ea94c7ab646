//! Newton's method on the branches of the laws, with its matrix and its room.

use crate::balance;
use crate::error::Unsolved;
use crate::lu::{Factors, Matrix};
use crate::net::Net;
use crate::problem::{Imbalance, Problem, State};

/// Unknown that a node gets which falls below 0, or rises above it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Crossing {
    /// A node that loses its pressure is dry.
    Empties,
    /// The one that the step gives.
    Goes,
}

/// How far Newton's method goes.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    /// Most steps.
    pub steps: u32,
    pub crossing: Crossing,
    /// First step, from 0, after which nodes that have changed their branch are balanced one by one.
    pub balances_from: u32,
}

/// Room for Newton's method in one net.
#[derive(Debug)]
pub struct Solver {
    matrix: Matrix,
    factors: Factors,
    pub imbalance: Imbalance,
    right: Vec<f64>,
    /// Nodes whose unknown a step changes.
    active: Vec<bool>,
    crossed: Vec<u32>,
    /// Linear systems that have been solved.
    pub solves: u32,
}

impl Solver {
    /// For a net.
    pub fn of(net: &Net) -> Self {
        let nodes = net.heights().len();
        Self {
            matrix: net.symbolic.matrix(),
            factors: net.symbolic.factors(),
            imbalance: Imbalance { values: vec![0.0; nodes], allowed: vec![0.0; nodes], least_allowed: 0.0 },
            right: vec![0.0; nodes],
            active: vec![false; nodes],
            crossed: Vec::new(),
            solves: 0,
        }
    }

    /// Goes from a state to one in balance; whether it has come there.
    pub fn run(&mut self, problem: &Problem, state: &mut State, plan: Plan) -> bool {
        for step in 0..=plan.steps {
            problem.imbalance(&state.u, &mut self.imbalance);
            if self.is_settled(problem, state) {
                return true;
            }
            if step == plan.steps {
                break;
            }
            self.direct(problem, state);
            self.go(problem, state, plan.crossing);
            if step >= plan.balances_from && !self.crossed.is_empty() {
                balance::around(problem, state, &self.crossed, self.imbalance.least_allowed);
            }
        }
        false
    }

    /// Brings the unknowns of a state in balance within their limits, and the state into balance again where that was
    /// due to round-off of unknowns beyond them; whether it is in balance.
    pub fn confine(&mut self, problem: &Problem, state: &mut State, plan: Plan) -> bool {
        for (node, u) in state.u.iter_mut().enumerate() {
            if problem.unknown[node] {
                *u = u.min(problem.tops[node].0).max(-problem.scales[node]);
            }
        }
        self.run(problem, state, plan)
    }

    /// Takes one more step from a state in balance, and keeps it where it brings a better one: what is allowed at
    /// each node may add up over many.
    pub fn polish(&mut self, problem: &Problem, state: &mut State) {
        let before = self.off_by(problem, state);
        self.linearize(problem, state);
        self.solve(problem);
        let mut next = state.clone();
        self.go(problem, &mut next, Crossing::Goes);
        problem.imbalance(&next.u, &mut self.imbalance);
        if self.off_by(problem, &next) <= before {
            *state = next;
        } else {
            problem.imbalance(&state.u, &mut self.imbalance);
        }
    }

    /// Whether all nodes are in balance.
    pub fn is_balanced(&mut self, problem: &Problem, state: &State) -> bool {
        problem.imbalance(&state.u, &mut self.imbalance);
        self.is_settled(problem, state)
    }

    /// Finds the step of Newton's method from a state.
    pub fn direct(&mut self, problem: &Problem, state: &mut State) {
        self.linearize(problem, state);
        if self.wake(problem, state) {
            problem.imbalance(&state.u, &mut self.imbalance);
            self.linearize(problem, state);
        }
        self.solve(problem);
    }

    /// Takes a share of that step.
    pub fn step(&self, problem: &Problem, state: &State, next: &mut State, share: f64) {
        for node in 0..self.active.len() {
            let (top, runs_off) = problem.tops[node];
            let mut to = state.u[node];
            if self.active[node] {
                to -= share * self.right[node];
            }
            if runs_off {
                to = to.min(top);
            }
            if problem.sources[node] < 0.0 {
                to = to.max(-problem.scales[node]);
            }
            next.u[node] = to;
            next.wet[node] = if self.active[node] { to > 0.0 } else { state.wet[node] };
        }
    }

    /// Share of that step at which the slopes change first; 1 where they do not.
    pub fn first_kink(&self, problem: &Problem, state: &State) -> f64 {
        let mut first = 1.0_f64;
        let mut at = |value: f64, change: f64| {
            let share = -value / change;
            if share > 0.0 && share < first {
                first = share;
            }
        };
        for node in 0..self.active.len() {
            if self.active[node] && !problem.tops[node].1 {
                at(state.u[node], -self.right[node]);
            }
        }
        for (pipe, ends) in problem.net.ends.iter().enumerate() {
            let [a, b] = ends.map(|end| end as usize);
            if problem.conductance[pipe] > 0.0 && !state.wet[a] && state.wet[b] {
                let slope = problem.net.drops[pipe] / problem.scales[a];
                at(state.u[a] * slope + state.u[b], -self.right[a] * slope - self.right[b]);
            }
        }
        first
    }

    /// Sum of the imbalances of nodes (m²/s).
    pub fn off_by(&self, problem: &Problem, state: &State) -> f64 {
        let counts = |node: &usize| problem.unknown[*node] && !self.is_bound(problem, state, *node);
        (0..state.u.len()).filter(counts).map(|node| self.imbalance.values[node].abs()).sum()
    }

    /// Whether a node's unknown is at an end that water cannot pass: it runs off, or a pump has taken all.
    pub fn is_bound(&self, problem: &Problem, state: &State, node: usize) -> bool {
        let (value, (top, runs_off)) = (self.imbalance.values[node], problem.tops[node]);
        let overflows = runs_off && state.u[node] >= top && value <= 0.0;
        overflows || state.u[node] <= -problem.scales[node] && problem.sources[node] < 0.0 && value >= 0.0
    }

    /// Whether a node is out of balance.
    fn is_off(&self, problem: &Problem, state: &State, node: usize) -> bool {
        let off = self.imbalance.values[node].abs() > self.imbalance.allowed[node];
        problem.unknown[node] && off && !self.is_bound(problem, state, node)
    }

    fn is_settled(&self, problem: &Problem, state: &State) -> bool {
        (0..state.u.len()).all(|node| !self.is_off(problem, state, node))
    }

    /// The node with the greatest imbalance.
    pub fn worst(&self, problem: &Problem, state: &State) -> Unsolved {
        let mut worst = Unsolved { node: 0, residual: 0.0, solves: self.solves };
        for (node, &residual) in self.imbalance.values.iter().enumerate() {
            let counts = problem.unknown[node] && !self.is_bound(problem, state, node);
            if counts && residual.abs() > worst.residual.abs() {
                (worst.node, worst.residual) = (node, residual);
            }
        }
        worst
    }

    /// Slopes of the imbalances of nodes that a step changes; rows and columns of others are those of 1.
    fn linearize(&mut self, problem: &Problem, state: &State) {
        for node in 0..self.active.len() {
            self.active[node] = problem.unknown[node] && !self.is_bound(problem, state, node);
        }
        let Matrix { diagonal, low, high } = &mut self.matrix;
        [&mut *diagonal, low, high].into_iter().for_each(|values| values.fill(0.0));
        let net = problem.net;
        for (pipe, (&[a, b], &(pair, upper_is_later))) in net.ends.iter().zip(&net.symbolic.pairs).enumerate() {
            let [a, b] = [a as usize, b as usize];
            let (u, wet) = ([state.u[a], state.u[b]], [state.wet[a], state.wet[b]]);
            let [[aa, ab], [ba, bb]] = problem.slopes(pipe, u, wet);
            diagonal[a] += aa;
            diagonal[b] += bb;
            if self.active[a] && self.active[b] {
                let (later, sooner) = if upper_is_later { (ab, ba) } else { (ba, ab) };
                low[pair as usize] += later;
                high[pair as usize] += sooner;
            }
        }
    }

    /// Films that no slope answers: where water arrives they are wet, where they give too much they are dry. Returns
    /// whether a node has changed.
    fn wake(&self, problem: &Problem, state: &mut State) -> bool {
        let mut changed = false;
        for node in 0..self.active.len() {
            let (value, allowed) = (self.imbalance.values[node], self.imbalance.allowed[node]);
            let is_flat = self.active[node] && !state.wet[node] && self.matrix.diagonal[node] <= 0.0;
            if is_flat && value.abs() > allowed {
                let to = if value < 0.0 { 0.0 } else { -problem.scales[node] };
                changed |= state.u[node] != to || (value < 0.0 && !problem.tops[node].1);
                state.u[node] = to;
                state.wet[node] = value < 0.0 && !problem.tops[node].1;
            }
        }
        changed
    }

    /// Changes of the unknowns, into `right`.
    fn solve(&mut self, problem: &Problem) {
        for (node, &active) in self.active.iter().enumerate() {
            let diagonal = &mut self.matrix.diagonal[node];
            (*diagonal, self.right[node]) = match active {
                true => (*diagonal + problem.own_slope(node), self.imbalance.values[node]),
                false => (1.0, 0.0),
            };
            if *diagonal <= 0.0 {
                (*diagonal, self.right[node]) = (1.0, 0.0);
            }
        }
        self.factors.factor(&problem.net.symbolic, &self.matrix);
        self.factors.solve(&problem.net.symbolic, &mut self.right);
        self.solves += 1;
    }

    /// Takes the step, within the limits of each node, and notes the nodes that change their branch.
    fn go(&mut self, problem: &Problem, state: &mut State, crossing: Crossing) {
        self.crossed.clear();
        for node in 0..self.active.len() {
            if !self.active[node] {
                continue;
            }
            let (top, runs_off) = problem.tops[node];
            let mut to = state.u[node] - self.right[node];
            let (was, wet) = (state.wet[node], to > 0.0 && !runs_off);
            if was != wet {
                self.crossed.push(node as u32);
                to = match crossing {
                    Crossing::Empties if was => -problem.scales[node],
                    _ => to,
                };
            }
            self.right[node] = to.min(top).max(-problem.scales[node]);
        }
        for node in 0..self.active.len() {
            if self.active[node] {
                state.u[node] = self.right[node];
                state.wet[node] = self.right[node] > 0.0;
            }
        }
    }
}
