//! The simulated time that a run expects to need is right within a factor of 1.5 after the first tenth of its steps.

use crate::extent::by_extent;
use crate::quiet_run::{example, quiet_run};
use enmm_run::{Observer, RunProgress};

/// Simulated time at each step, and that which was expected to be left.
#[derive(Default)]
struct Record(Vec<(f64, Option<f64>)>);

impl Observer for Record {
    fn step(&mut self, progress: &RunProgress) {
        self.0.push((progress.time, progress.time_expected));
    }
}

/// Expected over true time left after a tenth of the steps of a case.
fn ratio_after_a_tenth(case: &str) -> f64 {
    let mut record = Record::default();
    quiet_run(example(case), &mut record);
    let (time, expected) = record.0[record.0.len() / 10];
    let end = record.0.last().expect("steps").0;
    expected.unwrap_or_else(|| panic!("{case}: nothing is expected after a tenth")) / (end - time)
}

#[test]
fn long_the_time_left_is_right_within_half_after_a_tenth() {
    let ramped = ["block_on_incline", "coupled_slope", "goodman_bray", "masonry_wall", "plane_slide", "shaken_slope"];
    for case in ramped.into_iter().chain(["simply_supported_beam"]).take(by_extent([2, 4, 7])) {
        let ratio = ratio_after_a_tenth(&format!("{case}.toml"));
        assert!((1.0 / 1.5..1.5).contains(&ratio), "{case}: {ratio}");
    }
}
