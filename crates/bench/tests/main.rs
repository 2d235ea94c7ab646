//! Tests of the standard models.

mod bench_models;
#[path = "../../../tests/common/mod.rs"]
mod common;
mod large_block;
