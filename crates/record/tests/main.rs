//! Tests of files of results.

mod history;
#[path = "../../picture/tests/sample.rs"]
mod sample;
mod vtu;
