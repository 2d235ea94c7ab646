//! Tests of the pictures.

mod pictures;
mod sample;
mod stereonet;
mod sweep;
