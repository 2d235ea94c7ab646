//! Tests of what a model shows.

mod joint_pieces;
mod snapshots;
mod stress_out_of_plane;
