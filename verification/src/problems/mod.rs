//! All problems in the order of the manual; one file each.

mod b4;
mod b7;
mod b8;
mod c1;
mod continuum;
mod d4;

use crate::Problem;

/// Every problem.
pub const ALL: &[Problem] = &[b4::PROBLEM, b7::PROBLEM, b8::PROBLEM, c1::PROBLEM, d4::PROBLEM];
