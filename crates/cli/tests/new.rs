//! Claim: each case that `enmm new` writes runs as it is, and does what its first lines promise.

use std::fs;

use crate::support::{Place, json};

const KINDS: [&str; 4] = ["slope", "topple", "pit", "coupled"];

fn place() -> Place {
    Place::with("")
}

#[test]
fn every_new_case_runs_to_its_end_without_doubt() {
    let place = place();
    for kind in KINDS {
        place.answers(0, &["new", kind]);
        let file = format!("{kind}.toml");
        let text = fs::read_to_string(place.path(&file)).expect("a case");
        assert!(
            text.starts_with("#:schema case.schema.json\n") && text.contains(&format!("enmm run {file}")),
            "{text}"
        );
        let mut arguments = vec!["run", &file, "--quiet", "-o", kind, "--set", "output.pictures=false"];
        if kind != "pit" && kind != "slope" {
            arguments.extend(["--set", "stage[1].duration=0.2"]);
        }
        place.answers(0, &arguments);
        let summary = json(&place.path(kind).join("summary.json"));
        for stage in summary["stages"].as_array().expect("stages") {
            assert_ne!(stage["converged"], serde_json::json!(false), "{kind}: {stage}");
        }
    }
    let schema = json(&place.path("case.schema.json"));
    assert!(schema["properties"]["bolt_pattern"].is_object());
}

#[test]
fn a_new_slope_has_a_factor_of_safety_and_bolts_raise_it() {
    let place = place();
    place.answers(0, &["new", "slope", "-o", "mine.toml"]);
    assert!(fs::read_to_string(place.path("mine.toml")).expect("a case").contains("enmm fos mine.toml"));
    let factor = |more: &[&str]| -> f64 {
        let bound = place.enmm(&[&["bound", "mine.toml", "--json", "-o", "out"], more].concat()).json();
        bound["level_tops"]["factor"].as_f64().expect("a factor")
    };
    let (with, without) = (factor(&[]), factor(&["--set", "stage[1].install=[]"]));
    assert!(1.0 < without && without < with && with < 3.0, "{without}, with bolts {with}");
}

#[test]
fn a_new_pit_is_dug() {
    let place = place();
    place.enmm(&["new", "pit"]);
    place.answers(0, &["run", "pit.toml", "--quiet", "-o", "out"]);
    let blocks = fs::read_to_string(place.path("out/blocks.csv")).expect("a table");
    let removed: f64 = blocks.lines().skip(1).filter(|line| line.split(',').nth(2) == Some("1")).count() as f64;
    assert!(removed >= 3.0, "{blocks}");
}

#[test]
fn a_new_coupled_case_packs() {
    let place = place();
    place.enmm(&["new", "coupled"]);
    place.answers(0, &["check", "coupled.toml", "--json"]);
}

#[test]
fn a_file_that_is_there_is_kept() {
    let place = place();
    let answer = place.enmm(&["new", "slope", "-o", "case.toml"]);
    answer.assert_bad_input(&["cannot write case.toml (it is there already): choose another file with -o"]);
    assert_eq!(fs::read_to_string(place.path("case.toml")).expect("kept"), "");
}
