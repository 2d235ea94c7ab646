//! Tests of the verification problems: their quick set, their full form, other values; of the models that are timed.

mod bench_models;
mod both_integrators;
#[path = "../../../tests/common/mod.rs"]
mod common;
mod large_block;
mod other_values;
mod quick_set;
mod runner;
