//! Runs a case in a folder of its own, which is deleted, without frames or pictures.

use std::path::Path;

use enmm::model::case::{Case, Pictures};
use enmm_io::{LoadedCase, load_case};
use enmm_run::{Observer, RunOptions, Summary, run};

/// An example of the project, by the name of its file.
pub fn example(name: &str) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/cases").join(name);
    load_case(&path).unwrap_or_else(|error| panic!("{name}: {error}")).case
}

/// Summary of the run of a case.
pub fn quiet_run(mut case: Case, observer: &mut dyn Observer) -> Summary {
    (case.output.frames, case.output.pictures) = (false, Pictures::Usual(false));
    let folder = tempfile::tempdir().expect("a folder");
    let options = RunOptions { directory: folder.path().join("run"), ..RunOptions::default() };
    let loaded = LoadedCase::of(case, "case").expect("a case");
    run(&loaded, &options, observer).unwrap_or_else(|error| panic!("{error}"))
}
