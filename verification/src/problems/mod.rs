//! All problems in the order of the manual; one file each.

mod c1;
mod c12;
mod c3;
mod d3;
mod d6;
mod plane;
mod shear_box;

use crate::Problem;

/// Every problem.
pub const ALL: &[Problem] = &[c1::PROBLEM, c3::PROBLEM, c12::PROBLEM, d3::PROBLEM, d6::PROBLEM];
