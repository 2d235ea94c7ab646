//! Claim: a command that cannot print its output fails; only a reader that has gone away ends it quietly.

#![cfg(target_os = "linux")]

use std::fs::OpenOptions;
use std::process::{Command, Stdio};

use crate::support::{Place, case};

/// Status and errors of a command whose standard output is a full device.
fn into_full(place: &Place, arguments: &[&str]) -> (Option<i32>, String) {
    let full = OpenOptions::new().write(true).open("/dev/full").expect("a full device");
    let mut command = Command::new(env!("CARGO_BIN_EXE_enmm"));
    let command = command.args(arguments).current_dir(place.path("")).stdout(full).stderr(Stdio::piped());
    let output = command.output().expect("the program runs");
    (output.status.code(), String::from_utf8(output.stderr).expect("UTF-8"))
}

#[test]
fn output_to_a_full_device_is_an_error() {
    let place = Place::with(&case(0.02));
    for arguments in [
        &["schema"][..],
        &["--help"],
        &["--version"],
        &["check", "case.toml"],
        &["check", "case.toml", "--json"],
        &["run", "case.toml"],
        &["verify", "--list"],
        &["fos", "case.toml", "--high", "1.2"],
        &["bound", "case.toml"],
    ] {
        let (status, errors) = into_full(&place, arguments);
        assert!(matches!(status, Some(2 | 3)), "{arguments:?}: {status:?} {errors}");
        assert!(errors.contains("error: cannot write to standard output ("), "{arguments:?}: {errors}");
    }
    let (status, errors) = into_full(&place, &["run", "case.toml", "--quiet"]);
    assert_eq!(status, Some(0), "nothing was to be printed: {errors}");
}

#[test]
fn a_reader_that_has_gone_away_ends_the_output_quietly() {
    let place = Place::with(&case(0.02));
    let mut child = place.start(&["schema"]);
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
}
