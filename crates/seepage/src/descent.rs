//! The way down where Newton's method circles: its steps, shortened so that the imbalance falls.

use crate::newton::Solver;
use crate::problem::{Problem, State};

/// Share of a step that is tried last.
const LEAST: f64 = 1.0 / 64.0;
/// Decrease of the imbalance that is asked of a step, over that of a step without kinks.
const DECREASE: f64 = 0.02;
/// Share of the way to a kink that is gone beyond it.
const BEYOND: f64 = 1e-6;

/// Goes from a state to one in balance within so many solves; whether it has come there.
///
/// Imbalances are linear between kinks, so that a step of Newton's method lowers all of them alike up to the first
/// kink on its way. Since the whole is monotone, the way goes on from kink to kink to the flow (Katzenelson, An
/// algorithm for solving nonlinear resistor networks, 1965). A step goes further as long as the sum of imbalances
/// falls.
pub fn descend(solver: &mut Solver, problem: &Problem, state: &mut State, solves: u32) -> bool {
    let end = solver.solves + solves;
    let mut next = state.clone();
    loop {
        if solver.is_balanced(problem, state) {
            return true;
        }
        if solver.solves >= end {
            return false;
        }
        let before = solver.off_by(problem, state);
        solver.direct(problem, state);
        let mut share = 1.0;
        loop {
            solver.step(problem, state, &mut next, share);
            problem.imbalance(&next.u, &mut solver.imbalance);
            if solver.off_by(problem, &next) <= (1.0 - DECREASE * share) * before {
                break;
            }
            share *= 0.5;
            if share < LEAST {
                let kink = solver.first_kink(problem, state);
                solver.step(problem, state, &mut next, kink * (1.0 + BEYOND) + 1e-12);
                problem.imbalance(&next.u, &mut solver.imbalance);
                break;
            }
        }
        std::mem::swap(state, &mut next);
    }
}
