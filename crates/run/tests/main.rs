//! Tests of what a run writes.

mod coupled_run;
mod default_stiffness;
#[path = "../../../tests/common/extent.rs"]
mod extent;
mod flow_checks;
mod flow_of_stages;
mod issue_a_block_on_a_joint_was_in_free_flight;
mod issue_a_slide_before_the_trials_passed_as_rest;
mod issue_history_did_not_sum_to_its_residual;
mod monitors_of_runs;
mod quiet_run;
mod shaking;
mod states_between_runs_and_hosts;
mod time_left;
mod unsettled_steps;
