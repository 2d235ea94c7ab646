//! All problems in the order of the manual; one file each.

mod a1;
mod a2;
mod a3;
mod a4;
mod b4;
mod b7;
mod b8;
mod c1;
mod continuum;
mod d4;
mod dice;

use crate::Problem;

/// Every problem.
pub const ALL: &[Problem] = &[
    a1::PROBLEM,
    a2::PROBLEM,
    a3::PROBLEM,
    a4::PROBLEM,
    b4::PROBLEM,
    b7::PROBLEM,
    b8::PROBLEM,
    c1::PROBLEM,
    d4::PROBLEM,
];
