//! Claim: a run that goes on from a checkpoint elsewhere has its past or says that it has not, only whole checkpoints
//! are read, and a directory of results is left without the remains of killed runs.

#![cfg(unix)]

use std::fs;
use std::process::Command;

use crate::support::{Place, case};

/// A folder with an ended run in `first`.
fn ended() -> Place {
    let place = Place::with(&case(0.05));
    let answer = place.answers(0, &["run", "case.toml", "-o", "first"]);
    assert!(!answer.stderr.contains("overwritten"), "{answer:?}");
    place
}

#[test]
fn an_ended_run_continued_in_another_directory_keeps_its_rows_and_frames() {
    let place = ended();
    place.answers(0, &["run", "case.toml", "-o", "second", "--resume", "first/checkpoint.enmm"]);
    for name in ["history.csv", "run.pvd", "blocks.csv", "frames/elements_0000.vtu", "history.png"] {
        let read = |folder: &str| fs::read(place.path(folder).join(name)).expect("readable");
        assert!(read("first") == read("second"), "{name}");
    }
}

#[test]
fn a_checkpoint_without_its_past_says_so() {
    let place = ended();
    fs::rename(place.path("first/checkpoint.enmm"), place.path("alone.enmm")).expect("moved");
    let answer = place.answers(0, &["run", "case.toml", "-o", "second", "--resume", "alone.enmm"]);
    assert!(answer.stderr.contains("warning: history.csv and frames in second begin at t = "), "{answer:?}");
    let summary = crate::support::json(&place.path("second/summary.json"));
    assert!(summary["warnings"].to_string().contains("begin at t = "), "{summary}");
}

#[test]
fn devices_pipes_and_directories_are_no_checkpoints() {
    let place = Place::with(&case(0.02));
    assert!(Command::new("mkfifo").arg(place.path("pipe")).status().expect("mkfifo runs").success());
    fs::create_dir(place.path("folder")).expect("made");
    for path in ["/dev/zero", "/dev/full", "pipe", "folder"] {
        let answer = place.enmm(&["run", "case.toml", "-o", "out", "--resume", path]);
        answer.assert_bad_input(&[path, "no file", "checkpoint"]);
    }
    assert!(!place.path("out").exists());
}

#[test]
fn what_killed_runs_left_is_swept_and_older_results_are_named() {
    let place = ended();
    // No system has a process of this number; this process is alive, and notes are not ours.
    let alive = format!(".history.csv.{}-0.tmp", std::process::id());
    let left = [".history.csv.4000000000-0.tmp", "frames/.joints_0001.vtu.4000000000-12.tmp"];
    let kept = [&alive, ".notes.4000000000-0.tmp", "a.tmp", ".history.csv.x-0.tmp"];
    for name in left.iter().chain(&kept) {
        fs::write(place.path("first").join(name), "half").expect("written");
    }
    let answer = place.answers(0, &["run", "case.toml", "-o", "first"]);
    assert!(answer.stderr.contains("warning: the results of an earlier run in first are overwritten"), "{answer:?}");
    let there = |name: &&str| place.path("first").join(name).exists();
    assert!(!left.iter().any(there));
    if cfg!(target_os = "linux") {
        assert!(kept.iter().all(there));
    }
}
