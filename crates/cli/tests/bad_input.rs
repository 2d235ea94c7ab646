//! Claim: bad input exits with 2 and one line that names file, line, key and remedy, and nothing is written.

use std::fs;

use crate::support::{Place, case};

/// Runs a case that cannot run; asserts that nothing was written.
fn refuse(case: &str, parts: &[&str]) {
    let place = Place::with(case);
    place.enmm(&["run", "case.toml"]).assert_bad_input(parts);
    place.enmm(&["check", "case.toml"]).assert_bad_input(parts);
    let answer = place.enmm(&["check", "case.toml", "--json"]);
    assert_eq!(answer.status, Some(2));
    let object = answer.json();
    assert!(object["error"].as_str().expect("a message").contains(parts[0]), "{object}");
    assert_eq!(place.names(), ["case.toml"]);
}

#[test]
fn an_unknown_key_names_the_nearest_known_one() {
    refuse(&case(0.1).replace("young =", "yuong ="), &["case.toml:16: ", "yuong", "young"]);
}

#[test]
fn a_value_out_of_range_names_its_line() {
    refuse(&case(0.1).replace("poisson = 0.25", "poisson = 0.7"), &["case.toml:17: rock.granite.poisson: "]);
}

#[test]
fn a_later_stage_that_cannot_begin_is_found_before_the_first() {
    let away = case(0.1).replace("excavate = [[4.5, 1.5]]", "excavate = [[40, 1.5]]");
    refuse(&away, &["stage[1].excavate[0]", "(40, 1.5)"]);
}

#[test]
fn a_model_that_needs_too_much_memory_is_not_built() {
    refuse(&case(0.1).replace("size = 0.6", "size = 1e-5"), &["mesh.size", "memory_limit"]);
}

#[test]
fn a_file_that_cannot_be_read_says_so() {
    let place = Place::with(&case(0.1));
    place.enmm(&["run", "absent.toml"]).assert_bad_input(&["absent.toml: cannot read"]);
    fs::write(place.path("binary.toml"), [0xff, 0xfe, 0x00]).expect("written");
    place.enmm(&["run", "binary.toml"]).assert_bad_input(&["binary.toml", "UTF-8"]);
    place.enmm(&["run", "."]).assert_bad_input(&["cannot read"]);
    assert_eq!(place.names(), ["binary.toml", "case.toml"]);
}

#[test]
fn a_checkpoint_of_another_case_or_none_is_refused_before_anything_is_written() {
    let place = Place::with(&case(0.02));
    place.answers(0, &["run", "case.toml", "--quiet", "-o", "first"]);
    fs::write(place.path("other.toml"), case(0.03)).expect("written");
    let resume = |case: &str, file: &str| place.enmm(&["run", case, "-o", "second", "--resume", file]);
    resume("other.toml", "first/checkpoint.enmm").assert_bad_input(&["first/checkpoint.enmm: ", "of case "]);
    resume("case.toml", "case.toml").assert_bad_input(&["no saved state of enmm"]);
    resume("case.toml", "absent.enmm").assert_bad_input(&["absent.enmm: cannot read"]);
    let whole = fs::read(place.path("first/checkpoint.enmm")).expect("readable");
    fs::write(place.path("half.enmm"), &whole[..whole.len() / 2]).expect("written");
    resume("case.toml", "half.enmm").assert_bad_input(&["truncated"]);
    assert!(!place.path("second").exists());
}

#[test]
fn a_directory_that_cannot_be_made_is_bad_input() {
    let place = Place::with(&case(0.02));
    place.enmm(&["run", "case.toml", "-o", "case.toml/results"]).assert_bad_input(&["case.toml/results: ", "-o"]);
    place.enmm(&["run", "case.toml", "-o", "case.toml"]).assert_bad_input(&["cannot write results (case.toml: ", "-o"]);
}

#[test]
fn wrong_arguments_exit_with_2() {
    let place = Place::with(&case(0.02));
    for arguments in [&["run"][..], &["run", "case.toml", "--threads", "0"], &["fly"], &["check"]] {
        place.answers(2, arguments);
    }
    assert_eq!(place.names(), ["case.toml"]);
}

/// The base of the block on an incline ends at the face through (8, 0) and (4, 2): a monitor beside it has rock nearby.
#[test]
fn a_point_in_the_air_is_led_to_the_rock() {
    let monitor = "[[monitor]]\nname = \"m\"\npoint = [8.5, 0.3]\n";
    let place = Place::with(&crate::support::incline(0.65, monitor));
    let answer = place.enmm(&["check", "case.toml"]);
    answer.assert_bad_input(&[
        "monitor[0].point",
        "there is no rock at (8.5, 0.3)",
        "the rock is nearest at (8.000000, 0",
    ]);
}
