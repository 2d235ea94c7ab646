//! A link that lay in a folder of results, or in the place of one, led what a run writes and removes out of it.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::process::Command;

use crate::support::{Outcome, Place, case};

#[test]
fn a_link_called_frames_is_refused_before_anything_is_removed() {
    let place = Place::with(&case(0.01));
    fs::create_dir_all(place.path("out")).expect("made");
    fs::create_dir_all(place.path("precious")).expect("made");
    fs::write(place.path("precious/joints_0777.vtu"), "kept").expect("written");
    symlink("../precious", place.path("out/frames")).expect("linked");
    place.enmm(&["run", "case.toml", "-o", "out"]).assert_bad_input(&["frames", "a link", "-o"]);
    assert_eq!(place.names_in("precious"), ["joints_0777.vtu"]);
}

#[test]
fn a_link_in_the_place_of_a_default_folder_is_not_followed_unasked() {
    let place = Place::with(&case(0.01));
    fs::create_dir_all(place.path("precious")).expect("made");
    symlink("precious", place.path("case")).expect("linked");
    for command in ["run", "fos", "bound"] {
        place.enmm(&[command, "case.toml"]).assert_bad_input(&["case: is a link", "-o case", "--force"]);
    }
    assert!(place.names_in("precious").is_empty());
    place.answers(0, &["run", "case.toml", "-o", "case"]);
    assert!(place.path("precious/summary.json").is_file());
}

/// Names of unfinished files can be foreseen: those that are there are left alone, and swept when their process has
/// gone.
#[test]
fn unfinished_files_replace_nothing_and_are_swept_by_the_names_of_results() {
    let place = Place::with(&case(0.01));
    fs::create_dir_all(place.path("out")).expect("made");
    fs::write(place.path("victim"), "precious").expect("written");
    let names = ["model.svg", "history.csv", "blocks.csv", "report.html", "summary.json", "run.pvd"];
    let links = names.map(|name| format!("ln -s ../victim out/.{name}.$$-$k.tmp;")).concat();
    let script = format!(
        "k=0; while [ $k -lt 60 ]; do {links} k=$((k+1)); done; exec {} run case.toml -o out",
        env!("CARGO_BIN_EXE_enmm")
    );
    let mut shell = Command::new("sh");
    let run = Outcome::of(shell.args(["-c", &script]).current_dir(place.path(".")).output().expect("sh runs"));
    assert_eq!(run.status, Some(0), "{run:?}");
    assert_eq!(fs::read_to_string(place.path("victim")).expect("kept"), "precious");
    let left = [".model.svg.99999999-0.tmp", ".report_a4.pdf.99999999-1.tmp", ".notes.txt.99999999-1.tmp"];
    left.iter().for_each(|name| fs::write(place.path("out").join(name), "").expect("written"));
    place.answers(0, &["run", "case.toml", "-o", "out"]);
    let hidden: Vec<String> = place.names_in("out").into_iter().filter(|name| name.starts_with('.')).collect();
    assert_eq!(hidden, [left[2]], "what is no result stays");
}
