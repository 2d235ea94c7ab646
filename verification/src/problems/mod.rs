//! All problems in the order of the manual; one file each.

mod b5;
mod b6;
mod c1;
mod c4;
mod c5;
mod d1;
mod d2;
mod newmark;
mod slider;
mod strip;

use crate::Problem;

/// Every problem.
pub const ALL: &[Problem] =
    &[b5::PROBLEM, b6::PROBLEM, c1::PROBLEM, c4::PROBLEM, c5::PROBLEM, d1::PROBLEM, d2::PROBLEM];
