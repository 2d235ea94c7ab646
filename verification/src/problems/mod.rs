//! All problems in the order of the manual; one file each.

mod c1;

use crate::Problem;

/// Every problem.
pub const ALL: &[Problem] = &[c1::PROBLEM];
