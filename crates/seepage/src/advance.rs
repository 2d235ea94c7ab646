//! Implicit steps in time.

use crate::descent::descend;
use crate::error::{Failure, Refused, Unsolved};
use crate::net::{Condition, Flow, Net, Storage};
use crate::newton::{Crossing, Plan, Solver};
use crate::problem::{Hold, Problem, State};
use crate::steady::{self, held};

/// Newton's method in a step.
const NEWTON: Plan = Plan { steps: 15, crossing: Crossing::Goes, balances_from: u32::MAX };
/// Solves of the descent from where it has come to.
const DESCENT: u32 = 40;
/// How often a step is halved at most.
const DEPTH_MAX: u32 = 8;

impl Net {
    /// Flow at the end of an implicit step of a `time` (s) from unknowns `old` (m) at its start, as those of another
    /// flow. Conditions hold all through the step. All nodes take part, those of pieces without a condition too.
    ///
    /// The result has the unknowns at the end; its flow, inflow and run-off are means over the step, so that what
    /// enters is what the pipes hold more, see [`Net::stored`]. At nodes with a head or air the water that the ends of
    /// pipes take there is part of the inflow. A step that is too long for the solver is done in halves.
    ///
    /// # Errors
    /// [`Refused`] for lists of a wrong length, values that are not finite, negative conductances, rain or storage, and
    /// a time that is not positive; [`Unsolved`] where parts of 1/256 are too long still.
    pub fn advance(
        &self,
        conductance: &[f64],
        conditions: &[Condition],
        storage: Storage,
        old: &[f64],
        time: f64,
    ) -> Result<Flow, Failure> {
        self.check(conductance, conditions)?;
        self.check_stored(&storage, old)?;
        if !(time.is_finite() && time > 0.0) {
            return Err(Refused::Value { name: "time", index: 0, value: time }.into());
        }
        Ok(advance(self, conductance, conditions, storage, (old, time))?)
    }
}

/// A step in time (s), in halves where it is too long to be solved.
struct Step<'a, 'b> {
    problem: &'b mut Problem<'a>,
    solver: &'b mut Solver,
    storage: Storage<'a>,
    /// Time of the whole step (s).
    time: f64,
    /// Means of the parts so far; unknowns of the last.
    mean: Flow,
}

/// Flow at the end of a step of a `time` (s), with its means over the step, from unknowns of its start (m).
fn advance(
    net: &Net,
    conductance: &[f64],
    conditions: &[Condition],
    storage: Storage,
    (old, time): (&[f64], f64),
) -> Result<Flow, Unsolved> {
    let mut problem = Problem::of(net, conductance, conditions);
    let mut solver = Solver::of(net);
    let old: Vec<f64> = old.iter().enumerate().map(|(node, &u)| problem.scaled(node, u)).collect();
    let nodes = old.len();
    let mean = Flow {
        u: Vec::new(),
        flow: vec![0.0; net.pipes().len()],
        inflow: vec![0.0; nodes],
        run_off: vec![0.0; nodes],
        solves: 0,
        residual: 0.0,
        through_flow: 0.0,
    };
    let given: Vec<Option<f64>> = conditions.iter().zip(net.heights()).map(|(&c, &height)| held(c, height)).collect();
    let mut step = Step { problem: &mut problem, solver: &mut solver, storage, time, mean };
    step.go(old, &given, 0)?;
    let mut mean = step.mean;
    mean.solves = solver.solves;
    mean.through_flow = mean.inflow.iter().filter(|&&inflow| inflow > 0.0).sum();
    Ok(mean)
}

impl Step<'_, '_> {
    /// Goes on from unknowns (m), by the step halved so often, where nodes have given unknowns; returns those at its
    /// end.
    fn go(&mut self, old: Vec<f64>, given: &[Option<f64>], depth: u32) -> Result<Vec<f64>, Unsolved> {
        let start = old.iter().zip(given).enumerate().map(|(node, (&u, given))| {
            let limited = u.min(self.problem.tops[node].0).max(-self.problem.scales[node]);
            given.map_or(limited, |u| self.problem.scaled(node, u))
        });
        let mut state = State::of(start.collect());
        let share = 0.5_f64.powi(depth as i32);
        self.problem.hold = Hold::Store(self.storage, old, self.time * share);
        let (problem, solver) = (&*self.problem, &mut *self.solver);
        let is_found = solver.run(problem, &mut state, NEWTON)
            || descend(solver, problem, &mut state, DESCENT) && solver.confine(problem, &mut state, NEWTON);
        if is_found {
            solver.polish(problem, &mut state);
            let u = state.u.clone();
            let part = steady::flow(problem, solver, state);
            self.add(part, share);
            return Ok(u);
        }
        if depth == DEPTH_MAX {
            problem.imbalance(&state.u, &mut solver.imbalance);
            return Err(solver.worst(problem, &state));
        }
        let Hold::Store(_, old, _) = std::mem::replace(&mut self.problem.hold, Hold::Nothing) else {
            return Err(self.solver.worst(self.problem, &state));
        };
        let middle = self.go(old, given, depth + 1)?;
        self.go(middle, given, depth + 1)
    }

    /// Adds a part that takes a share of the time.
    fn add(&mut self, part: Flow, share: f64) {
        let sums = [&mut self.mean.flow, &mut self.mean.inflow, &mut self.mean.run_off];
        for (sum, values) in sums.into_iter().zip([&part.flow, &part.inflow, &part.run_off]) {
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += share * value);
        }
        self.mean.u = part.u;
        self.mean.residual = self.mean.residual.max(part.residual);
    }
}
