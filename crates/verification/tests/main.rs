//! Tests of the verification problems: their quick set, their full form, other values.

mod both_integrators;
#[path = "../../../tests/common/extent.rs"]
mod extent;
mod other_values;
mod quick_set;
mod runner;
