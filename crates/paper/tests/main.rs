//! Tests of the report on paper.

#[path = "../../../tests/common/json.rs"]
mod json;
mod report;
