//! Tests of factors of safety.

#[path = "../../../tests/common/mod.rs"]
mod common;
mod examples_of_claims;
mod fos_against_bound;
mod fos_block_on_incline;
mod limit_analysis;
mod tutorials;
