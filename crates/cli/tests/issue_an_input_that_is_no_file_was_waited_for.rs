//! A pipe as a case, a record, a geometry file or a library kept the program waiting for its other end; a directory in
//! the place of a result was found after hours of computation.
#![cfg(unix)]

use std::fs;
use std::os::unix::net::UnixListener;
use std::process::Command;

use crate::support::{Place, case};

fn pipe(place: &Place, name: &str) {
    assert!(Command::new("mkfifo").arg(place.path(name)).status().expect("mkfifo runs").success());
}

#[test]
fn pipes_sockets_and_devices_are_no_inputs() {
    let place = Place::with(&case(0.01));
    pipe(&place, "pipe.csv");
    pipe(&place, "pipe.json");
    let _socket = UnixListener::bind(place.path("socket.toml")).expect("a socket");
    place.enmm(&["check", "pipe.csv"]).assert_bad_input(&["pipe.csv", "a pipe or a device"]);
    place.enmm(&["check", "socket.toml"]).assert_bad_input(&["socket.toml", "a pipe or a device"]);
    place.enmm(&["run", "/dev/zero"]).assert_bad_input(&["/dev/zero", "a pipe or a device"]);
    let geometry = place.enmm(&["check", "case.toml", "--set", "domain.geometry_file=\"pipe.json\""]);
    geometry.assert_bad_input(&["pipe.json", "a pipe or a device"]);
    let record = "[[base_motion]]\naxis = \"x\"\nkind = \"velocity\"\nfile = \"pipe.csv\"\n";
    fs::write(place.path("shaken.toml"), case(0.01).replacen("[[load]]", &format!("{record}[[load]]"), 1))
        .expect("written");
    place.enmm(&["check", "shaken.toml"]).assert_bad_input(&["pipe.csv", "a pipe or a device"]);
    let library = place.enmm(&["fmu", "case.toml", "--library", "win64=pipe.csv"]);
    library.assert_bad_input(&["pipe.csv", "a pipe or a device"]);
}

#[test]
fn a_name_that_no_result_can_have_is_found_at_the_start() {
    for name in ["history.csv", "summary.json", "checkpoint.enmm", "report.html", "film.bin"] {
        let place = Place::with(&case(100.0));
        fs::create_dir_all(place.path("out").join(name)).expect("made");
        let answer = place.enmm(&["run", "case.toml", "-o", "out"]);
        answer.assert_bad_input(&[name, "no regular file", "-o"]);
        assert_eq!(place.names_in("out"), [name], "nothing is written before");
    }
    let place = Place::with(&case(100.0));
    fs::create_dir(place.path("out")).expect("made");
    fs::write(place.path("out/frames"), "").expect("written");
    place.enmm(&["run", "case.toml", "-o", "out"]).assert_bad_input(&["frames", "no directory"]);
    pipe(&place, "out/fos.json");
    place.answers(2, &["fos", "case.toml", "-o", "out"]);
    pipe(&place, "store");
    place.answers(2, &["sample", "case.toml", "-o", "new", "--store", "store"]);
    pipe(&place, "packed.fmu");
    place.enmm(&["fmu", "case.toml", "-o", "packed.fmu"]).assert_bad_input(&["packed.fmu", "no regular file"]);
}

/// A resume copies what lies beside its checkpoint.
#[test]
fn no_pipe_beside_a_checkpoint_is_waited_for() {
    let place = Place::with(&case(0.01));
    place.answers(0, &["run", "case.toml", "-o", "first"]);
    pipe(&place, "first/stage9_joints.png");
    let answer = place.enmm(&["run", "case.toml", "--resume", "first/checkpoint.enmm", "-o", "second"]);
    answer.assert_bad_input(&["stage9_joints.png", "a pipe or a device"]);
}
