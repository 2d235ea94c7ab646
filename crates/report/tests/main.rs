//! Tests of films, pages and the report on paper.

mod elements;
mod film;
mod issue_one_browser_kept_all_others_waiting;
#[path = "../../../tests/common/json.rs"]
mod json;
mod paper;
mod support;
