//! Tests of the program as its users start it.

mod bad_input;
mod bench;
mod bound;
mod fmu;
mod fos;
mod new;
mod output;
mod pictures;
mod resume;
mod run;
mod sample;
mod set;
mod support;
mod verify;
