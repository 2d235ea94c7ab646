//! Tests of films and pages.

mod film;
mod support;
