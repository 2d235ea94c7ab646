//! Tests of the program as its users start it.

mod bad_input;
mod bench;
mod bound;
mod edit;
mod export;
#[path = "../../../tests/common/extent.rs"]
mod extent;
mod fmu;
mod fos;
mod import;
mod issue_a_failed_run_read_like_a_nuisance;
mod issue_a_prepared_folder_led_results_elsewhere;
mod issue_a_result_replaced_a_record;
mod issue_an_input_that_is_no_file_was_waited_for;
mod issue_input_was_believed_whatever_it_held;
mod issue_results_of_another_case_were_replaced;
mod issue_two_runs_wrote_into_one_folder;
#[path = "../../../tests/common/json.rs"]
mod json;
mod manual;
mod new;
mod output;
mod pictures;
mod records;
mod report;
mod resume;
mod run;
mod sample;
mod set;
mod sets;
mod stereonet;
mod support;
mod sweep;
mod verify;
