//! Tests of films and pages.

mod film;
mod issue_one_browser_kept_all_others_waiting;
mod support;
