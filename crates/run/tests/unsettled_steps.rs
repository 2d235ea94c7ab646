//! A run warns of a stage whose open–close iteration often ends unsettled.

use std::path::Path;

use enmm::model::case::Pictures;
use enmm_run::{RunOptions, run};

/// Unsettled steps and the warnings of them in the first stage of the plane slide, with so many sweeps a step.
fn unsettled(sweeps_max: u32) -> (u64, Vec<String>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/cases/plane_slide.toml");
    let mut loaded = enmm_io::load_case(&path).unwrap_or_else(|error| panic!("{error}"));
    loaded.case.stages.truncate(1);
    (loaded.case.output.frames, loaded.case.output.pictures) = (false, Pictures::Usual(false));
    loaded.case.solver.sweeps_max = sweeps_max;
    let folder = tempfile::tempdir().expect("a folder");
    let options = RunOptions { directory: folder.path().join("run"), ..RunOptions::default() };
    let summary = run(&loaded, &options, &mut ()).unwrap_or_else(|error| panic!("{error}"));
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
