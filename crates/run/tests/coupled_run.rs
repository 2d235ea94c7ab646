//! Claim: a model that a host drives leaves the results of `enmm run`, to the bit where the host sets no input, and
//! once where it repeats steps; recording moves no bit of the model.

use std::fs;
use std::path::Path;

use enmm::cosimulation::Cosimulation;
use enmm::geometry::Vector;
use enmm::model::case::{Case, Pictures};
use enmm_io::LoadedCase;
use enmm_record::{Recording, RecordingError};
use enmm_run::{RunOptions, RunStatus, run};
use tempfile::{TempDir, tempdir};

use crate::quiet_run::example;

/// The example that slides after its equilibrium, over a short time, with frames and without pictures.
fn slide() -> LoadedCase {
    let mut case = drawn_slide();
    case.output.pictures = Pictures::Usual(false);
    LoadedCase::of(case, "slide.toml").expect("a case")
}

fn drawn_slide() -> Case {
    let mut case = example("block_on_incline.toml");
    case.stages[1].duration = 0.2;
    case.output.frames = true;
    case.output.frame_interval = Some(0.05);
    case.output.history_interval = Some(0.004);
    case
}

fn model(loaded: &LoadedCase) -> Cosimulation {
    loaded.cosimulation().expect("a model")
}

/// A model that is recorded in a folder of its own.
fn recorded(loaded: &LoadedCase) -> (Cosimulation, TempDir) {
    let (mut model, folder) = (model(loaded), tempdir().expect("a folder"));
    Recording::open(&mut model, loaded, &folder.path().join("r")).expect("a folder that can be written");
    (model, folder)
}

/// Steps of `h` (s) up to `end` (s).
fn drive(model: &mut Cosimulation, h: f64, end: f64) {
    while model.time() < end - 1e-12 {
        let t = model.time();
        model.do_step(t, h.min(end - t)).expect("a step");
    }
}

fn close(model: &mut Cosimulation) -> enmm_run::Summary {
    Recording::close(model).expect("results that can be written")
}

fn text(folder: &TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join("r").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Files of a folder that two runs share to the byte: all but those that hold wall times or name the command.
fn same_files(a: &Path, b: &Path) -> Vec<String> {
    let names = |folder: &Path| -> Vec<String> {
        let entries = [folder.to_owned(), folder.join("frames")].into_iter().filter(|path| path.is_dir());
        let all = entries.flat_map(|path| fs::read_dir(path).expect("a folder"));
        let mut names: Vec<String> = all
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.is_file())
            .map(|path| path.strip_prefix(folder).expect("a path within").display().to_string())
            .collect();
        names.sort();
        names
    };
    let found = names(a);
    assert_eq!(found, names(b));
    let own = ["film.bin", "report.html", "summary.json", "checkpoint.enmm"];
    found.into_iter().filter(|name| !own.contains(&name.as_str())).collect()
}

#[test]
fn a_host_without_inputs_leaves_the_results_of_a_run_to_the_bit() {
    let loaded = LoadedCase::of(drawn_slide(), "slide.toml").expect("a case");
    let alone = tempdir().expect("a folder");
    let options = RunOptions { directory: alone.path().to_owned(), ..RunOptions::default() };
    let summary = run(&loaded, &options, &mut ()).expect("a run");
    // The second is no multiple of the internal step, the third longer than the interval of the rows.
    for h in [0.01, 0.0037, 0.031] {
        let (mut model, folder) = recorded(&loaded);
        let end = model.stop_time();
        drive(&mut model, h, end);
        let coupled = close(&mut model);
        let files = same_files(alone.path(), &folder.path().join("r"));
        assert!(files.len() > 20, "{files:?}");
        for name in files {
            let read = |folder: &Path| fs::read(folder.join(&name)).expect("a file");
            assert!(read(alone.path()) == read(&folder.path().join("r")), "h = {h} s: {name} differs");
        }
        assert_eq!((coupled.energy, coupled.time, coupled.steps), (summary.energy, summary.time, summary.steps));
        let stages = |summary: &enmm_run::Summary| -> Vec<_> {
            summary.stages.iter().map(|s| (s.name.clone(), s.converged, s.displacement, s.penetration_max)).collect()
        };
        assert_eq!(stages(&coupled), stages(&summary));
        assert_eq!((coupled.status, coupled.verdict), (RunStatus::Finished, summary.verdict.clone()));
        assert_eq!(coupled.permanent, summary.permanent);
    }
}

#[test]
fn recording_moves_no_bit_of_the_model() {
    let loaded = slide();
    let (mut plain, (mut seen, _folder)) = (model(&loaded), recorded(&loaded));
    for model in [&mut plain, &mut seen] {
        drive(model, 0.0037, 0.05);
        model.set_block_force(1, Vector::new(2e3, 0.0), 0.0).expect("a force");
        drive(model, 0.01, 0.1);
    }
    let bytes = |model: &Cosimulation| model.serialize(&model.save()).expect("bytes");
    assert!(bytes(&plain) == bytes(&seen));
}

/// Drives windows of 0.02 s, each of which is tried with wrong forces before the right one as often as `tries` says.
fn couple(model: &mut Cosimulation, tries: usize) {
    model.start().expect("an equilibrium");
    for window in 0..10 {
        let start = model.save();
        for attempt in (0..=tries).rev() {
            let force = 1e3 * f64::from(window) * (1.0 + attempt as f64);
            model.set_block_force(1, Vector::new(-force, force), 0.0).expect("a force");
            let t = model.time();
            model.do_step(t, 0.02).expect("a step");
            if attempt > 0 {
                model.restore(&start).expect("its own state");
            }
        }
    }
}

#[test]
fn a_host_that_repeats_steps_leaves_what_one_leaves_that_does_not() {
    let loaded = slide();
    let mut summaries = Vec::new();
    let folders = [0, 3].map(|tries| {
        let (mut model, folder) = recorded(&loaded);
        couple(&mut model, tries);
        summaries.push(close(&mut model));
        folder
    });
    let mut names = same_files(&folders[0].path().join("r"), &folders[1].path().join("r"));
    names.extend(["film.bin", "report.html", "checkpoint.enmm"].map(str::to_owned));
    for name in names {
        let [once, often] = [0, 1].map(|k| fs::read(folders[k].path().join("r").join(&name)).expect("a file"));
        assert!(once == often, "{name} differs");
    }
    let coupled: Vec<[u64; 2]> = summaries
        .iter()
        .map(|summary| summary.coupled.map(|coupled| [coupled.communication_steps, coupled.returns]).expect("a record"))
        .collect();
    assert_eq!(coupled, [[10, 0], [40, 30]]);
    assert_eq!(summaries[0].energy, summaries[1].energy);
}

#[test]
fn a_return_over_several_steps_removes_what_is_later() {
    let loaded = slide();
    let (mut straight, expected) = recorded(&loaded);
    drive(&mut straight, 0.01, 0.2);
    close(&mut straight);
    let (mut model, folder) = recorded(&loaded);
    model.start().expect("an equilibrium");
    let start = model.save();
    drive(&mut model, 0.01, 0.05);
    let middle = model.save();
    model.set_block_force(1, Vector::new(5e3, 0.0), 0.0).expect("a force");
    drive(&mut model, 0.01, 0.15);
    model.restore(&middle).expect("its own state");
    drive(&mut model, 0.01, 0.12);
    model.restore(&start).expect("its own state");
    drive(&mut model, 0.01, 0.2);
    close(&mut model);
    for name in ["history.csv", "run.pvd", "blocks.csv"] {
        assert!(text(&folder, name) == text(&expected, name), "{name} differs");
    }
}

#[test]
fn a_frame_on_request_has_its_row_and_files_for_paraview() {
    let mut loaded = slide();
    loaded.case.output.frames = false;
    let loaded = LoadedCase::of(loaded.case, "slide.toml").expect("a case");
    let (mut model, folder) = recorded(&loaded);
    assert!(!folder.path().join("r/run.pvd").exists());
    drive(&mut model, 0.0151, 0.0151);
    Recording::write_frame(&mut model).expect("a frame");
    let (rows, time) = (text(&folder, "history.csv"), model.simulation().time());
    assert!(rows.lines().last().is_some_and(|row| row.starts_with(&format!("{time:?},2.0,"))), "{rows}");
    assert!(text(&folder, "run.pvd").contains(&format!("timestep=\"{time:?}\"")));
    Recording::write_frame(&mut model).expect("a frame");
    assert_eq!(text(&folder, "history.csv"), rows, "the same instant twice");
    close(&mut model);
}

#[test]
fn a_recording_that_begins_late_has_the_times_of_what_was_before() {
    let loaded = slide();
    let (mut model, folder) = (model(&loaded), tempdir().expect("a folder"));
    drive(&mut model, 0.01, 0.05);
    Recording::open(&mut model, &loaded, &folder.path().join("r")).expect("a folder that can be written");
    let begun = model.simulation().time();
    drive(&mut model, 0.01, 0.1);
    let summary = close(&mut model);
    let rows = text(&folder, "history.csv");
    assert!(rows.lines().nth(1).is_some_and(|row| row.starts_with(&format!("{begun:?},"))), "{rows}");
    let stages: Vec<_> = summary.stages.iter().map(|stage| (stage.name.as_str(), stage.steps > 0)).collect();
    assert_eq!(stages, [("settle", true), ("slide", true)]);
    assert!(summary.stages[0].displacement.is_nan() && summary.stages[1].displacement > 0.0);
}

#[test]
fn a_folder_that_is_lost_ends_the_recording_and_not_the_steps() {
    let loaded = slide();
    let (mut model, folder) = recorded(&loaded);
    drive(&mut model, 0.01, 0.03);
    fs::remove_dir_all(folder.path().join("r")).expect("a folder");
    drive(&mut model, 0.01, 0.2);
    assert!(Recording::fault(&model).is_some_and(|fault| fault.contains("frames")), "{:?}", Recording::fault(&model));
    let error = Recording::close(&mut model).expect_err("lost").to_string();
    assert!(error.starts_with("recording has ended ("), "{error}");
    assert!(!Recording::is_on(&model) && matches!(Recording::close(&mut model), Err(RecordingError::Off)));
}

#[test]
fn a_step_that_fails_ends_a_run_as_failed_unless_another_follows() {
    let loaded = slide();
    for goes_on in [false, true] {
        let (mut model, folder) = recorded(&loaded);
        drive(&mut model, 0.01, 0.05);
        model.set_block_force(1, Vector::new(1e14, 1e14), 0.0).expect("a force");
        let t = model.time();
        model.do_step(t, 0.01).expect_err("a force that no step bears");
        if goes_on {
            model.set_block_force(1, Vector::new(0.0, 0.0), 0.0).expect("a force");
            drive(&mut model, 0.01, 0.06);
        }
        let summary = close(&mut model);
        let status = if goes_on { RunStatus::Finished } else { RunStatus::Failed };
        assert_eq!((summary.status, summary.failure.is_some()), (status, !goes_on));
        let last = text(&folder, "history.csv").lines().last().map(str::to_owned);
        assert!(last.is_some_and(|row| row.starts_with(&format!("{:?},", model.simulation().time()))));
    }
}

#[test]
fn a_run_goes_on_from_the_checkpoint_of_a_coupled_run() {
    let loaded = slide();
    let [whole, part] = [(); 2].map(|()| tempdir().expect("a folder"));
    let options = |directory: &TempDir| RunOptions { directory: directory.path().to_owned(), ..RunOptions::default() };
    run(&loaded, &options(&whole), &mut ()).expect("a run");
    let (mut model, folder) = recorded(&loaded);
    // Between two points of the grid.
    drive(&mut model, 0.0037, 0.1);
    close(&mut model);
    let checkpoint = folder.path().join("r/checkpoint.enmm");
    run(&loaded, &RunOptions { resume: Some(checkpoint), ..options(&part) }, &mut ()).expect("a run that goes on");
    for name in ["history.csv", "blocks.csv"] {
        let [a, b] = [&whole, &part].map(|folder| fs::read_to_string(folder.path().join(name)).expect("a file"));
        // The host looked at a time that is no time of a row.
        let own: Vec<&str> = b.lines().filter(|row| a.lines().any(|other| other == *row)).collect();
        assert_eq!(own, a.lines().collect::<Vec<_>>(), "{name}");
    }
}

#[test]
fn what_cannot_be_recorded_is_refused() {
    let loaded = slide();
    let (mut model, folder) = recorded(&loaded);
    let other = folder.path().join("other");
    let again = Recording::open(&mut model, &loaded, &other).expect_err("recorded already");
    assert!(again.to_string().contains("end that recording first"), "{again}");
    let mut second = loaded.cosimulation().expect("a model");
    let taken = Recording::open(&mut second, &loaded, &folder.path().join("r")).expect_err("held");
    assert!(taken.to_string().contains("is writing its results here"), "{taken}");
    let coupled = LoadedCase::of(example("coupled_slope.toml"), "other.toml").expect("a case");
    let foreign = Recording::open(&mut second, &coupled, &other).expect_err("another case");
    assert!(matches!(foreign, RecordingError::OtherCase { .. }), "{foreign}");
    assert!(matches!(Recording::write_frame(&mut second), Err(RecordingError::Off)));
    // A copy of a model writes nothing.
    assert!(!Recording::is_on(&model.clone()));
}
