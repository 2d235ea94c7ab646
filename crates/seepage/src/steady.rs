//! Steady flow: the order of attempts, and the flow that a state is.

use crate::descent::descend;
use crate::error::{Failure, Refused, Unsolved};
use crate::law::{DELTA, pressure_head};
use crate::net::{Condition, Flow, Net, finite, length};
use crate::newton::{Crossing, Plan, Solver};
use crate::problem::{Problem, State};

/// Newton's method, each time.
const NEWTON: Plan = Plan { steps: 20, crossing: Crossing::Empties, balances_from: 5 };
/// Solves of a descent, each time.
const DESCENT: u32 = 80;
/// Solves after which no further attempt begins.
const SOLVES_MAX: u32 = 500;

impl Net {
    /// Steady flow with a `conductance` (m²/s per m of head; 0: closed) of each pipe and a condition of each node.
    ///
    /// The water comes down from a full net. A stagnant pool, which hangs in a dead end below dry joints and has
    /// neither inflow nor outlet, has no level of its own in a steady state: it is left as full as it was, up to its
    /// brim, which is safe for the stability of a slope. Heads and flows where water moves do not depend on it. Pieces
    /// of the net without a head, air or rain are dry, and pumps there take nothing.
    ///
    /// # Errors
    /// [`Refused`] for lists of a wrong length, values that are not finite, negative conductances or rain, and sources
    /// in pieces that water cannot leave; [`Unsolved`] where 500 solves do not lead to a flow. Several hundred
    /// random nets with contrasts of conductance up to 8·10⁹ took less than 200, most of them about ten.
    pub fn steady(&self, conductance: &[f64], conditions: &[Condition]) -> Result<Flow, Failure> {
        self.check(conductance, conditions)?;
        solve(self, conductance, conditions, None)
    }

    /// Steady flow as [`Net::steady`] gives it, but from unknowns `start` (m) of the nodes, as those of another flow,
    /// in place of a full net. Water that moves is the same; a stagnant pool keeps the level that it starts with or
    /// gets on the way. From dry it takes more solves.
    ///
    /// # Errors
    /// Those of [`Net::steady`], and [`Refused`] for a start of a wrong length or with a value that is not finite.
    pub fn steady_from(&self, conductance: &[f64], conditions: &[Condition], start: &[f64]) -> Result<Flow, Failure> {
        self.check(conductance, conditions)?;
        length("start", start.len(), self.heights().len())?;
        finite("start", start)?;
        solve(self, conductance, conditions, Some(start))
    }
}

/// Steady flow in a net, from a start or from full.
///
/// Newton's method, which empties nodes that lose their pressure, takes about ten steps. Where it circles, two descents
/// go on by turns: one from where it has come to, with Newton's method again after it, and one from the start.
fn solve(net: &Net, conductance: &[f64], conditions: &[Condition], start: Option<&[f64]>) -> Result<Flow, Failure> {
    let (problem, full) = problem(net, conductance, conditions)?;
    let mut solver = Solver::of(net);
    let start = start.map_or_else(|| full.clone(), |start| within(&problem, &full, start));
    let start = State::of(start.iter().enumerate().map(|(node, &u)| problem.scaled(node, u)).collect());
    let (mut high, mut low) = (start.clone(), start);
    let mut first = None;
    while solver.solves < SOLVES_MAX {
        if solver.run(&problem, &mut low, NEWTON) {
            return Ok(polished(&problem, &mut solver, low));
        }
        first.get_or_insert(solver.worst(&problem, &low));
        for state in [&mut low, &mut high] {
            if descend(&mut solver, &problem, state, DESCENT) && solver.confine(&problem, state, NEWTON) {
                return Ok(polished(&problem, &mut solver, state.clone()));
            }
        }
    }
    let worst = solver.worst(&problem, &high);
    let found = first.filter(|first| first.residual.abs() < worst.residual.abs()).unwrap_or(worst);
    Err(Unsolved { solves: solver.solves, ..found }.into())
}

/// The flow of a state in balance.
fn polished(problem: &Problem, solver: &mut Solver, mut state: State) -> Flow {
    solver.polish(problem, &mut state);
    flow(problem, solver, state)
}

/// Unknowns (m) of a start, within the limits of each node; those without an equation as they are given.
fn within(problem: &Problem, given: &[f64], start: &[f64]) -> Vec<f64> {
    let of = |node: usize| match problem.unknown[node] {
        true => start[node].min(problem.tops[node].0).max(-DELTA),
        false => given[node],
    };
    (0..start.len()).map(of).collect()
}

/// The equations of steady flow, and the state in which each piece of the net is full up to its highest water.
fn problem<'a>(
    net: &'a Net,
    conductance: &'a [f64],
    conditions: &[Condition],
) -> Result<(Problem<'a>, Vec<f64>), Refused> {
    let labels = net.pieces(conductance);
    let waters = waters(net, &labels, conditions)?;
    let mut problem = Problem::of(net, conductance, conditions);
    let mut full = vec![-DELTA; labels.len()];
    for (node, (&label, &height)) in labels.iter().zip(net.heights()).enumerate() {
        let water = waters[label as usize];
        if !water.is_open {
            (problem.unknown[node], problem.sources[node]) = (false, 0.0);
        }
        let depth = water.level - height;
        let (top, runs_off) = &mut problem.tops[node];
        *top = if water.is_fed { *top } else { top.min(pressure_head(depth)) };
        full[node] = match conditions[node] {
            Condition::Free { .. } if problem.unknown[node] && depth > 0.0 => depth,
            Condition::Rain { .. } if *runs_off && depth >= 0.0 => 0.0,
            condition => held(condition, height).unwrap_or(-DELTA),
        };
    }
    Ok((problem, full))
}

/// Sources of water of a piece of a net.
#[derive(Debug, Clone, Copy)]
struct Water {
    /// Highest head, rain or, where there is a source, node (m).
    level: f64,
    /// Whether there is a head, air or rain.
    is_open: bool,
    /// Whether there is a source, whose water may stand higher than any node.
    is_fed: bool,
}

/// Waters of pieces, by label.
fn waters(net: &Net, labels: &[u32], conditions: &[Condition]) -> Result<Vec<Water>, Refused> {
    let mut waters = vec![Water { level: f64::NEG_INFINITY, is_open: false, is_fed: false }; labels.len()];
    for ((&label, &height), condition) in labels.iter().zip(net.heights()).zip(conditions) {
        let water = &mut waters[label as usize];
        match *condition {
            Condition::Held { head } if head >= height => water.level = water.level.max(head),
            Condition::Rain { .. } => water.level = water.level.max(height),
            Condition::Free { source } => water.is_fed |= source > 0.0,
            _ => {}
        }
        water.is_open |= !matches!(condition, Condition::Free { .. });
    }
    for (node, (&label, condition)) in labels.iter().zip(conditions).enumerate() {
        let water = &mut waters[label as usize];
        if !water.is_open && matches!(condition, Condition::Free { source } if *source > 0.0) {
            return Err(Refused::Enclosed { node });
        }
        if water.is_fed {
            water.level = water.level.max(net.heights()[node]);
        }
    }
    Ok(waters)
}

/// Unknown (m) of a node with a given one.
pub fn held(condition: Condition, height: f64) -> Option<f64> {
    match condition {
        Condition::Held { head } if head >= height => Some(head - height),
        Condition::Held { .. } | Condition::Air => Some(-DELTA),
        Condition::Free { .. } | Condition::Rain { .. } => None,
    }
}

/// The flow of a state, whose imbalances the solver has.
pub fn flow(problem: &Problem, solver: &Solver, state: State) -> Flow {
    let net = problem.net;
    let down = |pipe: usize| problem.flow(pipe, &state.u);
    let flow = (0..net.pipes().len()).map(|k| if net.pipes()[k] == net.ends[k] { down(k) } else { -down(k) });
    let flow = flow.collect();
    let nodes = state.u.len();
    let (mut inflow, mut run_off) = (problem.sources.clone(), vec![0.0; nodes]);
    for node in 0..nodes {
        let is_bound = solver.is_bound(problem, &state, node);
        if is_bound || !problem.unknown[node] {
            inflow[node] += solver.imbalance.values[node];
        }
        if is_bound && problem.tops[node].1 {
            run_off[node] = -solver.imbalance.values[node];
        }
    }
    let through_flow = inflow.iter().filter(|&&inflow| inflow > 0.0).sum();
    let residual = solver.worst(problem, &state).residual.abs();
    let u = (0..nodes).map(|node| problem.unscaled(node, state.u[node])).collect();
    Flow { u, flow, inflow, run_off, solves: solver.solves, residual, through_flow }
}
