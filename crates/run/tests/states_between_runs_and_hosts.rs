//! Claim: a run and a host go on from the states of each other with the same bits as if each had made them itself.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use enmm::cosimulation::Cosimulation;
use enmm::model::case::{Pictures, StageCut};
use enmm_io::LoadedCase;
use enmm_run::{Observer, RunOptions, RunProgress, RunStatus, run};
use tempfile::{TempDir, tempdir};

use crate::quiet_run::example;

fn case() -> LoadedCase {
    let mut case = example("block_on_incline.toml");
    case.stages[1].duration = 0.1;
    case.output.pictures = Pictures::Usual(false);
    LoadedCase::of(case, "slide.toml").expect("a case")
}

/// Stops a run in the stage with this number at one of its steps.
struct Stop<'a> {
    stage: usize,
    step: u64,
    raised: &'a AtomicBool,
}

impl Observer for Stop<'_> {
    fn step(&mut self, progress: &RunProgress) {
        if progress.stage_number == self.stage && progress.step >= self.step {
            self.raised.store(true, Ordering::Relaxed);
        }
    }
}

fn options(folder: &TempDir) -> RunOptions<'_> {
    RunOptions { directory: folder.path().to_owned(), ..RunOptions::default() }
}

/// Bytes of the checkpoint of a run that is stopped.
fn stopped(loaded: &LoadedCase, stage: usize, step: u64) -> Vec<u8> {
    let (folder, raised) = (tempdir().expect("a folder"), AtomicBool::new(false));
    let stop = RunOptions { interrupt: Some(&raised), ..options(&folder) };
    let summary = run(loaded, &stop, &mut Stop { stage, step, raised: &raised }).expect("a run");
    assert_eq!((summary.status, summary.stages.len()), (RunStatus::Interrupted, stage));
    fs::read(folder.path().join("checkpoint.enmm")).expect("a checkpoint")
}

fn host(loaded: &LoadedCase) -> Cosimulation {
    loaded.cosimulation().expect("a model")
}

fn drive(model: &mut Cosimulation, h: f64, end: f64) {
    while model.time() < end - 1e-12 {
        let t = model.time();
        model.do_step(t, h.min(end - t)).expect("a step");
    }
}

#[test]
fn a_host_goes_on_from_a_run_in_any_stage_as_if_it_had_begun_itself() {
    let loaded = case();
    let mut own = host(&loaded);
    own.start().expect("an equilibrium");
    let first = own.simulation().state().step;
    drive(&mut own, 0.01, 0.08);
    for (stage, step) in [(1, 40), (2, first + 37)] {
        let mut model = host(&loaded);
        let saved = model.deserialize(&stopped(&loaded, stage, step)).expect("the state of a run");
        model.restore(&saved).expect("of the same case");
        assert_eq!(model.is_started(), stage == 2);
        assert_eq!(model.time() > 0.0, stage == 2);
        drive(&mut model, 0.01, 0.08);
        assert!((model.time() - 0.08).abs() < 1e-12);
        assert!(model.serialize(&model.save()).expect("bytes") == own.serialize(&own.save()).expect("bytes"));
    }
}

fn file(folder: &Path, name: &str) -> Vec<u8> {
    fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn a_run_goes_on_from_a_host_with_the_bits_of_one_that_was_never_stopped() {
    let loaded = case();
    let whole = tempdir().expect("a folder");
    let expected = run(&loaded, &options(&whole), &mut ()).expect("a run");
    let mut model = host(&loaded);
    let saved = model.deserialize(&stopped(&loaded, 1, 40)).expect("the state of a run");
    model.restore(&saved).expect("of the same case");
    // Before the equilibrium, on the grid, and between two of its points.
    for (h, end) in [(0.0, 0.0), (0.01, 0.02), (0.0037, 0.0555)] {
        drive(&mut model, h, end);
        let (folder, state) = (tempdir().expect("a folder"), whole.path().join("state.bin"));
        fs::write(&state, model.serialize(&model.save()).expect("bytes")).expect("written");
        let resumed = RunOptions { resume: Some(state), ..options(&folder) };
        let summary = run(&loaded, &resumed, &mut ()).expect("a run that goes on");
        assert_eq!(file(folder.path(), "blocks.csv"), file(whole.path(), "blocks.csv"), "from {end} s");
        assert_eq!((summary.time, summary.steps, summary.energy), (expected.time, expected.steps, expected.energy));
        assert!(summary.warnings.iter().any(|warning| warning.contains("from the state of a host at t = ")));
        let names: Vec<&str> = summary.stages.iter().map(|stage| stage.name.as_str()).collect();
        assert_eq!(names, ["settle", "slide"]);
    }
}

/// A stage cuts the block along its middle.
#[test]
fn a_run_goes_on_from_a_state_after_a_cut_with_the_bits_of_one_that_was_never_stopped() {
    let mut case = example("block_on_incline.toml");
    case.stages[1].duration = 0.1;
    case.stages[1].cuts = vec![StageCut { points: vec![[0.163, 0.483], [1.203, -0.117]], law: "joint".to_owned() }];
    case.output.pictures = Pictures::Usual(false);
    let loaded = LoadedCase::of(case, "cut.toml").expect("a case");
    let (whole, part) = (tempdir().expect("a folder"), tempdir().expect("a folder"));
    let expected = run(&loaded, &options(&whole), &mut ()).expect("a run");
    let checkpoint = part.path().join("checkpoint.enmm");
    let first = expected.stages[0].steps;
    fs::write(&checkpoint, stopped(&loaded, 2, first + 37)).expect("written");
    let resumed = RunOptions { resume: Some(checkpoint), ..options(&part) };
    let summary = run(&loaded, &resumed, &mut ()).expect("a run that goes on");
    let blocks = file(part.path(), "blocks.csv");
    assert_eq!(blocks, file(whole.path(), "blocks.csv"));
    assert_eq!((summary.time, summary.steps, summary.energy), (expected.time, expected.steps, expected.energy));
    let labels: Vec<&[u8]> =
        blocks.split(|&byte| byte == b'\n').filter_map(|line| line.split(|&b| b == b',').next()).collect();
    assert_eq!(labels, [&b"id"[..], b"0", b"1", b"2", b""]);
}

/// The overhang of the examples breaks in its second stage: a run that is stopped before, while the section lets go, or
/// long after leaves what one does that was never stopped.
#[test]
fn a_run_in_which_a_block_breaks_goes_on_with_the_bits_of_one_that_was_never_stopped() {
    let mut case = example("../breaking/overhang.toml");
    case.stages[1].duration = 0.15;
    case.output.pictures = Pictures::Usual(false);
    let loaded = LoadedCase::of(case, "overhang.toml").expect("a case");
    let whole = tempdir().expect("a folder");
    let expected = run(&loaded, &options(&whole), &mut ()).expect("a run");
    assert_eq!((expected.breaks.len(), expected.model.blocks), (1, 3));
    let broke = (expected.breaks[0].time / expected.dt.internal).round() as u64;
    let first = expected.stages[0].steps;
    assert!(broke > first + 10, "{broke}");
    for step in [broke - 5, broke + 5, broke + 300] {
        let part = tempdir().expect("a folder");
        let (checkpoint, raised) = (part.path().join("checkpoint.enmm"), AtomicBool::new(false));
        let stop = RunOptions { interrupt: Some(&raised), ..options(&part) };
        run(&loaded, &stop, &mut Stop { stage: 2, step, raised: &raised }).expect("a run");
        let resumed = RunOptions { resume: Some(checkpoint), ..options(&part) };
        let summary = run(&loaded, &resumed, &mut ()).expect("a run that goes on");
        assert_eq!((&summary.breaks, summary.time, summary.steps), (&expected.breaks, expected.time, expected.steps));
        for name in ["blocks.csv", "history.csv"] {
            assert_eq!(file(part.path(), name), file(whole.path(), name), "{name}, stopped at {step}");
        }
    }
}
