//! Verification problems with exact answers: each builds its models from its parameters, runs them and sets computed
//! values beside exact ones. Nothing here knows a number that the formula of the problem does not give.
//!
//! [`choose`] makes jobs from the request of a user, [`solve_all`] solves them, [`Record`] is what came out as data,
//! [`report`] writes the manual from it, and [`comparison`] sets both integrators side by side. [`mod@bench`] times
//! standard models.
#![forbid(unsafe_code)]

pub mod bench;
pub mod comparison;
mod lines;
mod model;
mod outcome;
pub mod parts;
pub mod plot;
mod problem;
pub mod problems;
pub mod random;
mod record;
pub mod report;
mod runner;
mod selection;
mod slope;
pub mod text;

pub(crate) use model::wider_open;
pub use model::{Setup, Trouble, run_all};
pub use outcome::{Origin, Outcome, Plot, Row, Series, Tolerance};
pub use problem::{Parameter, Problem, Values};
pub use record::{ParameterRecord, ProblemRecord, Record, RowRecord, ToleranceKind};
pub use runner::{Job, Solved, solve, solve_all, write_cases};
pub use selection::{Request, choose};
