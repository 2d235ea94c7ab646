//! Tests of files of results.

mod along;
mod history;
#[path = "../../picture/tests/sample.rs"]
mod sample;
mod vtu;
