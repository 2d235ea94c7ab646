//! Tests of the pictures.

mod joint_pieces;
mod pictures;
mod sample;
