//! All problems in the order of the manual; one file each.

mod b4;
mod c1;
mod continuum;

use crate::Problem;

/// Every problem.
pub const ALL: &[Problem] = &[b4::PROBLEM, c1::PROBLEM];
