//! Claim: `enmm run` leaves every promised result; a failed or interrupted run keeps what there is with a checkpoint
//! from which it continues to the same results.

use std::fs;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::support::{Outcome, Place, case, json};

#[test]
fn every_promised_file_is_there_and_whole() {
    let place = Place::with(&case(0.1));
    let answer = place.answers(0, &["run", "case.toml"]);
    assert!(answer.stdout.contains("page to open         case/report.html"), "{answer:?}");
    assert_eq!(place.names(), ["case", "case.toml"], "results go to the name of the case");
    let names = ["summary.json", "history.csv", "blocks.csv", "run.pvd", "checkpoint.enmm", "report.html", "film.bin"];
    for name in names.into_iter().chain(["model.png", "deformed.png", "history.png", "frames/elements_0000.vtu"]) {
        assert!(fs::metadata(place.path("case").join(name)).is_ok_and(|file| file.len() > 0), "{name}");
    }
    let summary = json(&place.path("case/summary.json"));
    assert_eq!(summary["status"], "finished");
    assert_eq!(summary["stages"][0]["name"], "rest");
    assert!(summary["stages"][0]["converged"].is_boolean() && summary["stages"][1]["converged"].is_null());
    assert!(summary["energy"]["residual_relative"].as_f64().expect("a number").abs() < 5e-2);
    let blocks = fs::read_to_string(place.path("case/blocks.csv")).expect("blocks");
    assert!(blocks.starts_with("id,fixed,removed,detached,centroid_x [m],"), "{blocks}");
    assert_eq!(blocks.lines().count(), 1 + 3);
}

#[test]
fn rows_of_the_history_rise_in_time_and_begin_and_end_with_the_run() {
    let place = Place::with(&case(0.1));
    place.answers(0, &["run", "case.toml", "--quiet"]);
    let history = fs::read_to_string(place.path("case/history.csv")).expect("history");
    let times: Vec<f64> =
        history.lines().skip(1).map(|row| row.split(',').next().expect("a time").parse().expect("a number")).collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    let end = json(&place.path("case/summary.json"))["time"].as_f64().expect("a number");
    assert_eq!((times[0], times[times.len() - 1]), (0.0, end));
}

#[test]
fn quiet_runs_print_nothing_and_threads_change_nothing() {
    let place = Place::with(&case(0.05));
    for threads in ["1", "2"] {
        let answer = place.enmm(&["run", "case.toml", "--quiet", "-o", threads, "--threads", threads]);
        assert_eq!((answer.status, answer.stdout.as_str(), answer.stderr.as_str()), (Some(0), "", ""));
    }
    let frames = ["frames/elements_0003.vtu", "frames/joints_0003.vtu"];
    let names = ["blocks.csv", "history.csv", "deformed.png", "checkpoint.enmm", "film.bin", "report.html"];
    for name in names.into_iter().chain(frames) {
        let read = |folder: &str| fs::read(place.path(folder).join(name)).expect("readable");
        assert!(read("1") == read("2"), "{name}");
    }
}

#[test]
fn a_numerical_failure_exits_with_3_and_keeps_the_last_good_state() {
    let tiny = format!("{}\n[solver]\npenetration_limit = 1e-6\n", case(0.1));
    let place = Place::with(&tiny);
    let answer = place.answers(3, &["run", "case.toml"]);
    assert!(answer.stderr.contains("penetration") && answer.stderr.contains("checkpoint.enmm"), "{answer:?}");
    let summary = json(&place.path("case/summary.json"));
    assert_eq!(summary["status"], "failed");
    let failure = &summary["failure"];
    assert!(failure["cause"].as_str().expect("a cause").contains("solver.penetration_limit"));
    assert!(failure["time"].as_f64() > summary["time"].as_f64(), "the checkpoint is older than the failure");
    assert_eq!(failure["place"].as_array().expect("a place").len(), 2);
    for name in ["checkpoint.enmm", "history.csv", "blocks.csv", "run.pvd", "report.html"] {
        assert!(fs::metadata(place.path("case").join(name)).is_ok_and(|file| file.len() > 0), "{name}");
    }
    let again = place.enmm(&["run", "case.toml", "--resume", "case/checkpoint.enmm", "--quiet"]);
    assert_eq!(again.status, Some(3), "the same failure again: {again:?}");
}

/// Runs a long case into `parts` and ends it with `signal` in its second stage; asserts its status.
#[cfg(unix)]
fn stop(place: &Place, signal: &str, status: Option<i32>) {
    let child = place.start(&["run", "case.toml", "-o", "parts"]);
    let begin = Instant::now();
    let rows = || fs::read_to_string(place.path("parts/history.csv")).map_or(0, |text| text.lines().count());
    while rows() < 200 {
        assert!(begin.elapsed() < Duration::from_secs(60), "no rows");
        std::thread::sleep(Duration::from_millis(2));
    }
    let killed = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(killed.success());
    let answer = Outcome::of(child.wait_with_output().expect("an end"));
    assert_eq!(answer.status, status, "{answer:?}");
}

/// Asserts that `parts` and `whole` have the same results, wall times apart.
#[cfg(unix)]
fn assert_same(place: &Place) {
    let pictures = ["deformed.png", "stage1_joints.png", "stage2_displacement_contours.png"];
    for name in ["blocks.csv", "history.csv", "run.pvd", "frames/joints_0015.vtu"].into_iter().chain(pictures) {
        let read = |folder: &str| fs::read(place.path(folder).join(name)).expect("readable");
        assert!(read("parts") == read("whole"), "{name}");
    }
    let stages = |folder: &str| {
        let mut stages = json(&place.path(folder).join("summary.json"))["stages"].clone();
        stages.as_array_mut().expect("stages").iter_mut().for_each(|stage| stage["wall_seconds"] = 0.into());
        stages
    };
    assert_eq!(stages("parts"), stages("whole"));
}

/// Two hundred thousand steps of a block that rests.
#[cfg(unix)]
fn long_rest() -> String {
    case(100.0).replace("friction_deg = 0.1", "friction_deg = 20")
}

#[cfg(unix)]
const CONTINUED: [&str; 7] = ["run", "case.toml", "-o", "parts", "--resume", "parts/checkpoint.enmm", "--quiet"];

#[cfg(unix)]
#[test]
fn an_interrupted_run_continues_to_the_results_of_an_uninterrupted_one() {
    let place = Place::with(&long_rest());
    stop(&place, "-INT", Some(130));
    assert_eq!(json(&place.path("parts/summary.json"))["status"], "interrupted");
    place.answers(0, &CONTINUED);
    place.answers(0, &["run", "case.toml", "-o", "whole", "--quiet"]);
    assert_same(&place);
    // A finished run writes its results again.
    place.answers(0, &CONTINUED);
    assert_same(&place);
}

#[cfg(unix)]
#[test]
fn a_killed_run_continues_from_its_last_checkpoint() {
    let place = Place::with(&format!("{}\n[output]\ncheckpoint_interval = 7.0\n", long_rest()));
    stop(&place, "-KILL", None);
    place.answers(0, &CONTINUED);
    place.answers(0, &["run", "case.toml", "-o", "whole", "--quiet"]);
    assert_same(&place);
}

/// It ended with status 0 and without its history, whose rows had gone to a file without a name.
#[cfg(unix)]
#[test]
fn a_run_whose_folder_vanishes_says_so() {
    let place = Place::with(&format!(
        "{}\n[output]\npictures = false\nframes = false\ncheckpoint_interval = 1e6\n",
        long_rest()
    ));
    let child = place.start(&["run", "case.toml", "-o", "parts"]);
    let begin = Instant::now();
    while fs::read_to_string(place.path("parts/history.csv")).map_or(0, |text| text.lines().count()) < 9 {
        assert!(begin.elapsed() < Duration::from_secs(60), "no rows");
        std::thread::sleep(Duration::from_millis(2));
    }
    fs::rename(place.path("parts"), place.path("away")).expect("moved");
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(killed.success());
    let answer = Outcome::of(child.wait_with_output().expect("an end"));
    assert_eq!(answer.status, Some(3), "{answer:?}");
    assert!(answer.stderr.contains("cannot write results (parts/"), "{answer:?}");
}

#[test]
fn energy_from_nowhere_makes_a_run_fail() {
    // Rock of 50 Pa instead of 50 GPa: the stage has two steps of 2.5 s.
    let soft = case(5.0).replace("young = 1e9", "young = 50").replace("duration = 0.2", "duration = 5");
    let place = Place::with(soft.split("[[stage]]\nname = \"slide\"").next().expect("a stage"));
    let answer = place.answers(3, &["run", "case.toml"]);
    assert!(answer.stderr.contains("warning: rock.granite.young: is 50 Pa"), "{answer:?}");
    assert!(answer.stderr.contains("error: the energy residual is 1.0"), "{answer:?}");
}

#[test]
fn the_schema_is_printed_as_json() {
    let place = Place::with("");
    let answer = place.enmm(&["schema"]);
    assert_eq!((answer.status, answer.stderr.as_str()), (Some(0), ""));
    let schema = answer.json();
    assert!(schema["properties"]["mesh"].is_object());
}

/// The case of the C library's tests: a block sinks into a soft joint by some hundredths of the mesh size.
#[test]
fn blocks_that_overlap_are_a_warning_and_numbers_of_the_summary() {
    let place = Place::with(include_str!("../../../ffi/capi/tests/cases/soft.toml"));
    let answer = place.answers(0, &["run", "case.toml"]);
    let summary = json(&place.path("case/summary.json"));
    let number = |key: &str| summary[key].as_f64().expect("a number");
    assert_eq!(number("overlapping_pairs"), 1.0);
    assert!(number("overlap_max") > 0.005 && number("overlap_max") < 0.04, "{summary}");
    let warnings = summary["warnings"].as_array().expect("warnings");
    let told = |text: &str| text.contains("blocks 0 and 1 overlap by ") && text.contains("% of the mesh size near (");
    assert_eq!(warnings.iter().filter(|text| told(text.as_str().expect("text"))).count(), 1, "{warnings:?}");
    assert_eq!(answer.stderr.matches("blocks 0 and 1 overlap by ").count(), 1, "{answer:?}");
}

/// The end of a terminal is no end of a run that was begun with `nohup`.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_the_caller_has_switched_off_stays_off() {
    let place = Place::with(&long_rest());
    let run = format!("trap '' HUP; exec {} run case.toml -o out --quiet", env!("CARGO_BIN_EXE_enmm"));
    let mut child = Command::new("sh").args(["-c", &run]).current_dir(place.path(".")).spawn().expect("sh runs");
    let begin = Instant::now();
    while fs::read_to_string(place.path("out/history.csv")).map_or(0, |text| text.lines().count()) < 50 {
        assert!(begin.elapsed() < Duration::from_secs(60), "no rows");
        std::thread::sleep(Duration::from_millis(2));
    }
    let send = |signal: &str| Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(send("-HUP").success());
    std::thread::sleep(Duration::from_millis(100));
    assert!(send("-TERM").success());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    assert_eq!(json(&place.path("out/summary.json"))["status"], "interrupted", "one signal alone was heard");
}

/// Batch systems send such signals before they kill.
#[cfg(unix)]
#[test]
fn a_run_answers_a_limit_with_a_checkpoint_or_a_message() {
    let place = Place::with(&long_rest());
    stop(&place, "-XCPU", Some(130));
    assert_eq!(json(&place.path("parts/summary.json"))["status"], "interrupted");
    assert!(place.path("parts/checkpoint.enmm").is_file());
    let place = Place::with(&case(0.01));
    let run = format!("ulimit -f 8; exec {} run case.toml -o out --quiet", env!("CARGO_BIN_EXE_enmm"));
    let mut shell = Command::new("sh");
    let full = Outcome::of(shell.args(["-c", &run]).current_dir(place.path(".")).output().expect("sh runs"));
    assert!([Some(2), Some(3)].contains(&full.status), "{full:?}");
    assert!(full.stderr.contains("out/") && full.stderr.contains("too large"), "{full:?}");
}
