//! All problems in the order of the manual; one file each.

mod b1;
mod b2;
mod b3;
mod beam;
mod c1;
mod e1;
mod e2;

use crate::Problem;

pub use beam::{Beam, Plane};

/// Every problem.
pub const ALL: &[Problem] = &[b1::PROBLEM, b2::PROBLEM, b3::PROBLEM, c1::PROBLEM, e1::PROBLEM, e2::PROBLEM];
