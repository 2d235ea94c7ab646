//! Verification problems with exact answers: each builds its models from its parameters, runs them and sets computed
//! values beside exact ones. Nothing here knows a number that the formula of the problem does not give.

pub mod comparison;
mod model;
mod outcome;
mod problem;
pub mod problems;

pub use model::{Setup, Trouble, at_rest_by_end, run_all, run_stage};
pub use outcome::{Origin, Outcome, Plot, Row, Series, Tolerance};
pub use problem::{Parameter, Problem, Values};
