//! Claim: a run draws the pictures that its case requests, those of the end of a stage at the end of each; a check
//! draws the model alone.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::support::{Place, case};

/// Names and bytes of the pictures in a folder.
fn pictures(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let pictures = entries.filter(|path| path.extension().is_some_and(|extension| extension == "png"));
    pictures
        .map(|path| (path.file_name().expect("a name").to_string_lossy().into_owned(), fs::read(&path).expect("bytes")))
        .collect()
}

fn names(folder: &Path) -> Vec<String> {
    pictures(folder).into_keys().collect()
}

fn with_output(keys: &str) -> Place {
    Place::with(&format!("{}\n[output]\n{keys}\n", case(0.05)))
}

#[test]
fn a_run_draws_the_usual_pictures_at_the_end_of_each_stage() {
    let place = Place::with(&case(0.05));
    place.answers(0, &["run", "case.toml"]);
    let stages = ["stage1", "stage2"];
    let mut expected: Vec<String> = ["deformed", "history", "model"].map(|name| format!("{name}.png")).to_vec();
    expected.extend(stages.iter().flat_map(|s| {
        ["displacement_contours", "joints", "mean_stress_contours"].map(|name| format!("{s}_{name}.png"))
    }));
    assert_eq!(names(&place.path("case")), expected);
}

#[test]
fn a_run_without_pictures_draws_none_whatever_its_case_says() {
    let place = with_output("pictures = [\"energy\"]");
    place.answers(0, &["run", "case.toml", "--no-pictures"]);
    assert_eq!(names(&place.path("case")), [""; 0]);
    assert!(place.path("case/report.html").exists());
}

#[test]
fn a_run_draws_the_pictures_of_a_list_alone_and_removes_those_of_the_run_before() {
    let place = with_output("pictures = [\"joint_stress\", \"velocity\", \"covers\"]");
    fs::create_dir(place.path("case")).expect("made");
    for name in ["stage7_joints.png", "stage_plan.png", "stage1_sketch.png"] {
        fs::write(place.path("case").join(name), "older").expect("written");
    }
    place.answers(0, &["run", "case.toml"]);
    let of_stage = |k: u32| ["normal_stress", "shear_stress", "velocity"].map(|name| format!("stage{k}_{name}.png"));
    let mut expected = vec!["covers.png".to_owned(), "stage1_sketch.png".to_owned(), "stage_plan.png".to_owned()];
    expected.extend([1, 2].into_iter().flat_map(of_stage));
    expected.sort();
    assert_eq!(names(&place.path("case")), expected);
}

#[test]
fn no_pictures_are_drawn_where_none_are_wanted() {
    for none in ["false", "[]"] {
        let place = with_output(&format!("pictures = {none}"));
        place.answers(0, &["run", "case.toml"]);
        assert_eq!(names(&place.path("case")), [""; 0]);
    }
}

#[test]
fn an_ended_run_continued_in_another_directory_has_the_same_pictures() {
    let place = Place::with(&case(0.05));
    place.answers(0, &["run", "case.toml", "-o", "first"]);
    place.answers(0, &["run", "case.toml", "-o", "second", "--resume", "first/checkpoint.enmm"]);
    let [first, second] = ["first", "second"].map(|folder| pictures(&place.path(folder)));
    assert_eq!(first.len(), 9);
    assert!(first.keys().eq(second.keys()), "{:?}", second.keys());
    first.iter().for_each(|(name, bytes)| assert!(*bytes == second[name], "{name}"));
}

#[test]
fn a_check_draws_the_model() {
    let place = with_output("pictures = [\"covers\"]");
    let answer = place.answers(0, &["check", "case.toml", "-o", "seen"]);
    assert!(answer.stdout.contains("model.png"), "{answer:?}");
    assert_eq!(names(&place.path("seen")), ["covers.png", "model.png"]);
    assert_eq!(place.names(), ["case.toml", "seen"], "and writes nothing else");
}

#[test]
fn a_check_that_cannot_draw_says_where() {
    let place = with_output("pictures = true");
    let answer = place.answers(2, &["check", "case.toml", "-o", "case.toml"]);
    assert!(answer.stderr.contains("case.toml") && answer.stderr.contains("choose another directory"), "{answer:?}");
}

#[test]
fn a_picture_that_does_not_exist_is_refused_with_the_nearest_name() {
    with_output("pictures = [\"model\", \"dispacement\"]")
        .enmm(&["run", "case.toml"])
        .assert_bad_input(&["output.pictures[1]: is \"dispacement\", did you mean \"displacement\"?"]);
    with_output("pictures = 3").enmm(&["run", "case.toml"]).assert_bad_input(&["output.pictures: is the integer 3"]);
}
