//! All problems in the order of the manual; one file each.

mod block;
mod c1;
mod c11;
mod c6;
mod c7;
mod d5;

use crate::Problem;

/// Every problem.
pub const ALL: &[Problem] = &[c1::PROBLEM, c6::PROBLEM, c7::PROBLEM, c11::PROBLEM, d5::PROBLEM];
