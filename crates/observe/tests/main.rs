//! Tests of what a model shows.

mod joint_pieces;
#[path = "../../../tests/common/rest.rs"]
mod rest;
mod snapshots;
mod stress_out_of_plane;
