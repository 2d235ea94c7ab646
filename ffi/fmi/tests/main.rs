//! Tests of what both FMI versions share: descriptions, packed FMUs, states.

mod fmu;
mod issue_states_that_cannot_be;
mod libraries;
