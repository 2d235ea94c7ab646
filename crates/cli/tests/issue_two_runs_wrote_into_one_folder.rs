//! Two runs wrote into one folder, each over the results of the other; a folder that was removed came back with a part
//! of them.

use std::fs;
use std::io::Read;
use std::time::{Duration, Instant};

use crate::support::{Outcome, Place, case};

/// Waits until a file is there.
fn wait_for(place: &Place, name: &str) {
    let start = Instant::now();
    while !place.path(name).exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "no {name}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Waits until a run has written some rows of its history.
fn wait_for_rows(place: &Place) {
    let start = Instant::now();
    while fs::read_to_string(place.path("out/history.csv")).map_or(0, |text| text.lines().count()) < 5 {
        assert!(start.elapsed() < Duration::from_secs(60), "no rows");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_second_run_is_refused_with_the_number_of_the_first() {
    let place = Place::with(&case(100.0));
    let mut first = place.start(&["run", "case.toml", "-o", "out", "--quiet"]);
    wait_for(&place, "out/history.csv");
    let number = first.id().to_string();
    for command in ["run", "fos", "bound", "check"] {
        let second = place.enmm(&[command, "case.toml", "-o", "out"]);
        let told = format!("out: process {number} is writing its results here");
        assert!(second.status == Some(2) && second.stderr.contains(&told), "{command}: {second:?}");
    }
    first.kill().expect("ended");
    first.wait().expect("ended");
    assert!(place.path("out/.enmm.lock").exists(), "the lock of a killed run stays");
    place.answers(0, &["check", "case.toml", "-o", "out"]);
    assert!(!place.path("out/.enmm.lock").exists(), "and is taken over");
}

/// A host that dies leaves no run behind; a run of a shell, whose standard input has ended, goes on.
#[test]
fn a_run_ends_with_the_caller_that_holds_its_standard_input() {
    let place = Place::with(&case(1000.0));
    let mut run = place.start_held(&["run", "case.toml", "-o", "out", "--quiet", "--with-caller"]);
    wait_for_rows(&place);
    assert!(run.try_wait().expect("asked").is_none());
    drop(run.stdin.take());
    assert_eq!(run.wait().expect("ended").code(), Some(130));
    assert!(place.path("out/checkpoint.enmm").exists());
    let mut alone = place.start_held(&["run", "case.toml", "-o", "alone", "--quiet"]);
    drop(alone.stdin.take());
    wait_for(&place, "alone/history.csv");
    assert!(alone.try_wait().expect("asked").is_none());
    alone.kill().expect("ended");
    alone.wait().expect("ended");
}

#[test]
fn a_folder_that_is_removed_in_a_run_does_not_come_back() {
    let place = Place::with(&case(20.0));
    let mut run = place.start(&["run", "case.toml", "-o", "out", "--quiet"]);
    wait_for_rows(&place);
    while place.path("out").exists() {
        // The run may write a file between two removals.
        let _ = fs::remove_dir_all(place.path("out"));
    }
    let mut told = String::new();
    run.stderr.take().expect("its messages").read_to_string(&mut told).expect("UTF-8");
    let status = run.wait().expect("ended").code();
    assert_eq!(status, Some(3), "{told}");
    assert!(told.contains("out") && told.contains("run the case again"), "{told}");
    assert_eq!(place.names(), ["case.toml"]);
}

#[test]
fn a_message_names_a_checkpoint_only_when_there_is_one() {
    let frames = "[output]\nframes = true\npictures = false\nframe_interval = 0.01\n";
    for (case, remedy) in [
        (case(20.0) + frames + "checkpoint_interval = 0.02\n", "continue with --resume"),
        (case(20.0) + frames, "run the case again"),
    ] {
        let place = Place::with(&case);
        let run = place.start(&["run", "case.toml", "-o", "out", "--quiet"]);
        wait_for_rows(&place);
        if remedy.contains("resume") {
            wait_for(&place, "out/checkpoint.enmm");
        }
        while place.path("out/frames").exists() {
            let _ = fs::remove_dir_all(place.path("out/frames"));
        }
        let answer = Outcome::of(run.wait_with_output().expect("ended"));
        assert!(answer.status == Some(3) && answer.stderr.contains(remedy), "{answer:?}");
    }
}

/// With no file to spare for a second look at the lock a run looked again and again, deaf to all signals.
#[cfg(unix)]
#[test]
fn a_lock_that_cannot_be_looked_at_is_an_error() {
    let place = Place::with(&case(0.01));
    for files in 4..=8 {
        let run = format!("ulimit -n {files}; exec timeout 60 {} run case.toml -o out", env!("CARGO_BIN_EXE_enmm"));
        let mut shell = std::process::Command::new("sh");
        let ended = shell.args(["-c", &run]).current_dir(place.path(".")).output().expect("sh runs");
        assert!([Some(0), Some(2), Some(3)].contains(&ended.status.code()), "{files}: {ended:?}");
    }
}
