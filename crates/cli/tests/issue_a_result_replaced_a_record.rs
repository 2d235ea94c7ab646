//! A record called `history.csv` in the folder of the results was replaced by the history, without a word.

use std::fs;
use std::path::Path;

use crate::support::{Place, case};

/// A case whose base moves as a record states, and the record.
fn place(record: &str) -> Place {
    let motion = format!("[[base_motion]]\naxis = \"x\"\nkind = \"velocity\"\nfile = \"{record}\"\n[[load]]");
    let place = Place::with(&case(0.01).replacen("[[load]]", &motion, 1));
    fs::write(place.path(record), "0,0\n1,0\n").expect("written");
    place
}

/// A random value, without which nothing can be sampled.
const RANDOM: &str = "[[random]]\nkey = \"joint_law.plane.friction_deg\"\ndistribution = \"normal\"\n\
                      mean = 30\nsd = 1\n";

fn append(place: &Place, text: &str) {
    let case = fs::read_to_string(place.path("case.toml")).expect("readable");
    fs::write(place.path("case.toml"), case + text).expect("written");
}

#[test]
fn no_command_replaces_an_input() {
    for (record, command) in [
        ("history.csv", &["run", "case.toml", "-o", "."][..]),
        ("fos.csv", &["fos", "case.toml", "-o", "."]),
        ("report.html", &["bound", "case.toml", "-o", "."]),
        ("model.png", &["check", "case.toml", "-o", "."]),
        ("ensemble.csv", &["sample", "case.toml", "-o", "."]),
        ("sweep.csv", &["sweep", "case.toml", "joint_law.plane.friction_deg=20,30", "-o", "."]),
        ("store.sqlite", &["sample", "case.toml", "-o", "out", "--store", "store.sqlite"]),
        ("packed.fmu", &["fmu", "case.toml", "-o", "packed.fmu"]),
    ] {
        let place = place(record);
        if command[0] == "sample" {
            append(&place, RANDOM);
        }
        let answer = place.enmm(command);
        assert!(answer.stderr.contains("which is the input") && answer.status == Some(2), "{answer:?}");
        assert_eq!(fs::read_to_string(place.path(record)).expect("kept"), "0,0\n1,0\n", "{command:?}");
        assert_eq!(place.names().len(), 2, "{command:?} wrote before it refused: {:?}", place.names());
    }
}

#[test]
fn an_input_is_known_by_its_file_and_not_by_its_name() {
    let place = place("quake.csv");
    fs::hard_link(place.path("quake.csv"), place.path("blocks.csv")).expect("linked");
    let refused = place.enmm(&["run", "case.toml", "-o", "."]);
    refused.assert_bad_input(&["blocks.csv", "a result would replace this", "quake.csv", "-o"]);
    fs::remove_file(place.path("blocks.csv")).expect("removed");
    fs::rename(place.path("case.toml"), place.path("summary.json")).expect("renamed");
    let refused = place.enmm(&["run", "summary.json", "-o", "."]);
    refused.assert_bad_input(&["summary.json", "a result would replace this", "-o"]);
}

#[test]
fn results_may_lie_beside_the_inputs() {
    let place = place("quake.csv");
    place.answers(0, &["run", "case.toml", "-o", "."]);
    place.answers(0, &["run", "case.toml", "-o", "."]);
}

#[test]
fn every_file_of_a_run_has_the_name_of_a_result() {
    let place = Place::with(&(case(0.01) + "[output]\nframes = true\npictures = true\n"));
    for command in [&["run", "case.toml", "-o", "out"][..], &["fos", "case.toml", "-o", "out"]] {
        let answer = place.enmm(command);
        assert!(answer.status == Some(0) || answer.status == Some(3), "{answer:?}");
    }
    let mut names = place.names_in("out");
    names.retain(|name| name != "frames");
    names.extend(place.names_in("out/frames").iter().map(|name| format!("frames/{name}")));
    assert!(names.len() > 25, "{names:?}");
    let others: Vec<_> = names.iter().filter(|name| !enmm_run::is_result(Path::new(name))).collect();
    assert!(others.is_empty(), "not looked at before a run: {others:?}");
}

/// The lock of the folder went through a link into the file that it led to, and what looked like a file of a killed
/// run was swept away.
#[cfg(unix)]
#[test]
fn neither_a_lock_nor_a_sweep_reaches_an_input() {
    let place = place("quake.csv");
    std::os::unix::fs::symlink("quake.csv", place.path(".enmm.lock")).expect("linked");
    place.enmm(&["check", "case.toml", "-o", "."]).assert_bad_input(&[".enmm.lock", "no file of its own"]);
    fs::remove_file(place.path(".enmm.lock")).expect("removed");
    fs::hard_link(place.path("case.toml"), place.path(".enmm.lock")).expect("linked");
    place.enmm(&["run", "case.toml", "-o", "."]).assert_bad_input(&[".enmm.lock", "no file of its own"]);
    fs::remove_file(place.path(".enmm.lock")).expect("removed");
    assert_eq!(fs::read_to_string(place.path("quake.csv")).expect("kept"), "0,0\n1,0\n");
    assert!(fs::read_to_string(place.path("case.toml")).expect("kept").contains("title"));
    let place = self::place(".history.csv.123-4.tmp");
    let refused = place.enmm(&["run", "case.toml", "-o", "."]);
    refused.assert_bad_input(&[".history.csv.123-4.tmp", "a result would replace this"]);
    assert!(place.path(".history.csv.123-4.tmp").exists());
}

/// SQLite keeps files beside the store; a store is a file of its own, whatever its name.
#[test]
fn the_files_beside_a_store_are_looked_at_and_a_store_is_a_file() {
    let place = Place::with(&(case(0.01) + RANDOM));
    let sample = |store: &str| place.enmm(&["sample", "case.toml", "-n", "1", "-o", "out", "--store", store]);
    for end in ["wal", "shm", "journal"] {
        fs::hard_link(place.path("case.toml"), place.path(&format!("store-{end}"))).expect("linked");
        sample("store").assert_bad_input(&[&format!("store-{end}"), "which is the input"]);
        fs::remove_file(place.path(&format!("store-{end}"))).expect("removed");
    }
    sample("out/ensemble.csv").assert_bad_input(&["ensemble.csv", "another result has this name", "--store"]);
    sample(":memory:");
    assert!(place.path(":memory:").is_file(), "a name and no memory: {:?}", place.names());
}

/// A link named as the film led the film into another file, and a checkpoint that was linked there was lost.
#[cfg(unix)]
#[test]
fn a_film_replaces_a_link_and_no_checkpoint() {
    let place = Place::with(&case(0.01));
    place.answers(0, &["run", "case.toml", "-o", "first"]);
    fs::create_dir(place.path("second")).expect("made");
    fs::hard_link(place.path("first/checkpoint.enmm"), place.path("second/film.bin")).expect("linked");
    let resume = ["run", "case.toml", "--resume", "first/checkpoint.enmm", "-o", "second"];
    place.enmm(&resume).assert_bad_input(&["film.bin", "which is the input"]);
    fs::remove_file(place.path("second/film.bin")).expect("removed");
    fs::write(place.path("precious"), "kept").expect("written");
    std::os::unix::fs::symlink("../precious", place.path("second/film.bin")).expect("linked");
    place.answers(0, &["run", "case.toml", "-o", "second"]);
    assert_eq!(fs::read_to_string(place.path("precious")).expect("kept"), "kept");
}
