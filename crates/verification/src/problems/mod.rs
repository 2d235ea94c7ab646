//! All problems in the order of the manual; one file each.

mod a1;
mod a2;
mod a3;
mod a4;
mod b1;
mod b2;
mod b3;
mod b4;
mod b5;
mod b6;
mod b7;
mod b8;
mod beam;
mod block;
mod c1;
mod c10;
mod c11;
mod c12;
mod c13;
mod c14;
mod c15;
mod c2;
mod c3;
mod c4;
mod c5;
mod c6;
mod c7;
mod c8;
mod c9;
mod continuum;
mod d1;
mod d2;
mod d3;
mod d4;
mod d5;
mod d6;
mod d7;
mod e1;
mod e2;
mod f1;
mod f2;
mod f3;
mod f4;
mod f5;
mod f6;
mod f7;
mod incline;
mod joint_flow;
mod limit;
mod newmark;
mod plane_slide;
mod shear_box;
mod slider;
mod strip;
mod toppling;
mod w1;
mod w13;
mod w3;
mod w4;
mod w5;
mod w8;
mod w9;

pub(crate) use beam::{Beam, Plane};

use crate::Problem;

/// Every problem.
pub const ALL: &[Problem] = &[
    a1::PROBLEM,
    a2::PROBLEM,
    a3::PROBLEM,
    a4::PROBLEM,
    b1::PROBLEM,
    b2::PROBLEM,
    b3::PROBLEM,
    b4::PROBLEM,
    b5::PROBLEM,
    b6::PROBLEM,
    b7::PROBLEM,
    b8::PROBLEM,
    c1::PROBLEM,
    c2::PROBLEM,
    c3::PROBLEM,
    c4::PROBLEM,
    c5::PROBLEM,
    c6::PROBLEM,
    c7::PROBLEM,
    c8::PROBLEM,
    c9::PROBLEM,
    c10::PROBLEM,
    c11::PROBLEM,
    c12::PROBLEM,
    c13::PROBLEM,
    c14::PROBLEM,
    c15::PROBLEM,
    d1::PROBLEM,
    d2::PROBLEM,
    d3::PROBLEM,
    d4::PROBLEM,
    d5::PROBLEM,
    d6::PROBLEM,
    d7::PROBLEM,
    e1::PROBLEM,
    e2::PROBLEM,
    f1::PROBLEM,
    f2::PROBLEM,
    f3::PROBLEM,
    f4::PROBLEM,
    f5::PROBLEM,
    f6::PROBLEM,
    f7::PROBLEM,
    w1::PROBLEM,
    w3::PROBLEM,
    w4::PROBLEM,
    w5::PROBLEM,
    w8::PROBLEM,
    w9::PROBLEM,
    w13::PROBLEM,
];
