//! Tests of factors of safety.

mod bridges;
mod columns;
#[path = "../../../tests/common/mod.rs"]
mod common;
mod continuum;
mod corners;
mod examples_of_claims;
mod fos_against_bound;
mod fos_block_on_incline;
mod hoek_brown_slope;
mod issue_a_fault_a_millimetre_short_held_a_slope;
mod issue_nudged_columns_leant_to_a_lower_factor;
mod issue_rock_without_tension_never_rested;
mod issue_the_mesh_decided_about_an_end;
mod kinematics;
mod limit_analysis;
mod quiet_edges;
mod quoted_figures;
mod rock_that_breaks;
mod searches_begin_anywhere;
mod seepage;
mod slips_before_it_holds;
mod soil_slope;
mod support;
mod tutorials;
mod weak_planes;
mod yield_acceleration;
