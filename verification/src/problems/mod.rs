//! All problems in the order of the manual; one file each.

mod c1;
mod c10;
mod c2;
mod c8;
mod c9;
mod incline;
mod plane_slide;
mod toppling;

use crate::Problem;

/// Every problem.
pub const ALL: &[Problem] = &[c1::PROBLEM, c2::PROBLEM, c8::PROBLEM, c9::PROBLEM, c10::PROBLEM];
