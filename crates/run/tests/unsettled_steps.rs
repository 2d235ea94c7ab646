//! A run warns of a stage whose open–close iteration often ends unsettled.

use crate::quiet_run::{example, quiet_run};

/// Unsettled steps and the warnings of them in the first stage of the plane slide, with so many sweeps a step.
fn unsettled(sweeps_max: u32) -> (u64, Vec<String>) {
    let mut case = example("plane_slide.toml");
    case.stages.truncate(1);
    case.solver.sweeps_max = sweeps_max;
    let summary = quiet_run(case, &mut ());
    let of_them = |warning: &String| warning.contains("did not settle");
    (summary.open_close.unsettled, summary.warnings.into_iter().filter(of_them).collect())
}

#[test]
fn a_stage_of_unsettled_steps_is_warned_of() {
    let (count, warnings) = unsettled(1);
    let [warning] = warnings.as_slice() else { panic!("{warnings:?}") };
    assert!(warning.contains(&format!("1 sweeps (solver.sweeps_max) in {count} sub-steps of ")), "{warning}");
    assert!(warning.contains("solver.dt_max"), "{warning}");
}

#[test]
fn a_stage_that_settles_is_not() {
    let (count, warnings) = unsettled(100);
    assert!(warnings.is_empty(), "{count}: {warnings:?}");
}
