//! Claim: `enmm fos` finds the factor of safety of a block on an incline, writes its results and answers with the
//! promised statuses.

use std::fs;

use crate::support::{Place, incline, json};

#[test]
fn stages_that_are_left_out_are_told_once() {
    let place = Place::with(&incline(0.65, "[[stage]]\nname = \"quake\"\nkind = \"dynamic\"\nduration = 0.1\n"));
    let answer = place.enmm(&["fos", "case.toml", "--tolerance", "0.1"]);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    let told = format!("{}{}", answer.stderr, answer.stdout);
    assert_eq!(told.matches("are left out: quake").count(), 1, "{answer:?}");
    let found = json(&place.path("case/fos/fos.json"));
    assert!(found["warnings"].to_string().contains("are left out: quake"), "{found}");
}

#[test]
fn run_fos_and_bound_of_one_case_leave_a_page_each() {
    let place = Place::with(&incline(0.65, ""));
    let pages = ["case/report.html", "case/fos/report.html", "case/bound/report.html"];
    let read = |page: &str| fs::read(place.path(page)).expect("a page");
    let mut first = Vec::new();
    for (command, page) in ["run", "fos", "bound"].into_iter().zip(pages) {
        let answer = place.enmm(&[command, "case.toml"]);
        assert_eq!(answer.status, Some(0), "{answer:?}");
        assert!(answer.stdout.contains(page), "{answer:?}");
        first.push(read(page));
    }
    for (page, first) in pages.into_iter().zip(first) {
        assert!(read(page) == first, "{page} was replaced");
    }
    assert_eq!(place.names(), ["case", "case.toml"], "one folder for a case");
}

#[test]
fn a_search_for_tables_alone_removes_the_drawings_of_the_search_before() {
    let place = Place::with(&incline(0.65, ""));
    let search = ["fos", "case.toml", "-o", "out", "--tolerance", "0.1"];
    let left = |words: &[&str]| {
        assert_eq!(place.enmm(words).status, Some(0));
        place.names_in("out")
    };
    assert_eq!(
        left(&search),
        ["failure.png", "failure.svg", "fos.csv", "fos.json", "fos.png", "fos.svg", "report.html"]
    );
    assert_eq!(left(&[&search[..], &["--no-pictures"]].concat()), ["fos.csv", "fos.json"]);
}

/// FoS = tan φ/tan a = 2·tan φ; the bracket of 1 % about it, and 0.5 % for the judge.
#[test]
fn a_block_on_an_incline_has_the_factor_of_its_tangents() {
    let place = Place::with(&incline(0.65, ""));
    let answer = place.enmm(&["fos", "case.toml", "-o", "out", "--tolerance", "0.01"]);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    assert!(answer.stdout.contains("factor of safety") && answer.stdout.contains("verdict"), "{answer:?}");
    for name in ["fos.json", "fos.csv", "fos.png", "failure.png"] {
        assert!(fs::metadata(place.path("out").join(name)).is_ok_and(|file| file.len() > 0), "{name}");
    }
    let found = json(&place.path("out/fos.json"));
    let factor = found["factor_of_safety"].as_f64().expect("a factor");
    assert!((factor / 1.3 - 1.0).abs() < 0.01, "{factor}");
    assert_eq!(found["status"], "found");
    let bound = found["bound"]["level_tops"]["factor"].as_f64().expect("a bound");
    assert!((bound / 1.3 - 1.0).abs() < 3e-4 && answer.stdout.contains("limit analysis"), "{bound}");
    assert!(answer.stdout.contains("1 of ~") && answer.stdout.contains("100.0 % of the free rock"), "{answer:?}");
    assert_eq!((&found["failing"]["blocks"], &found["failing"]["share"]), (&1.into(), &1.0.into()));
    let failing = found["failing_blocks"].as_array().expect("blocks");
    assert_eq!(failing.len(), 1, "{failing:?}");
    assert!(failing[0]["place"][0].as_f64().is_some_and(|x| (2.4..4.0).contains(&x)), "{failing:?}");
    let trials = found["trials"].as_array().expect("trials").len();
    assert_eq!(fs::read_to_string(place.path("out/fos.csv")).expect("a table").lines().count(), 1 + trials);
}

#[test]
fn threads_change_nothing_and_json_is_the_file() {
    let place = Place::with(&incline(0.4, ""));
    let mut texts = Vec::new();
    for threads in ["1", "2"] {
        let arguments = ["fos", "case.toml", "--json", "-o", threads, "--threads", threads, "--tolerance", "0.02"];
        let answer = place.enmm(&arguments);
        assert_eq!(answer.status, Some(0), "{answer:?}");
        let printed: serde_json::Value = serde_json::from_str(&answer.stdout).expect("JSON");
        assert_eq!(printed, json(&place.path(threads).join("fos.json")));
        texts.push(fs::read_to_string(place.path(threads).join("fos.csv")).expect("a table"));
        assert!((printed["factor_of_safety"].as_f64().expect("a factor") / 0.8 - 1.0).abs() < 0.015, "{printed}");
        assert_eq!(printed["rest"]["strength_factor"], 1000.0, "its joints hold until the trials begin");
    }
    let without_wall = |text: &str| -> Vec<String> {
        text.lines().map(|line| line.rsplit_once(',').expect("columns").0.to_owned()).collect()
    };
    assert_eq!(without_wall(&texts[0]), without_wall(&texts[1]));
}

#[test]
fn a_slope_that_cannot_fail_in_range_has_at_least_its_end() {
    let place = Place::with(&incline(0.65, ""));
    let answer = place.enmm(&["fos", "case.toml", "-o", "out", "--low", "0.9", "--high", "1.1"]);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    assert!(answer.stdout.contains("at least 1.1") && answer.stdout.contains("--high"), "{answer:?}");
    let found = json(&place.path("out/fos.json"));
    assert_eq!((&found["status"], found["at_least"].as_f64()), (&"stable_throughout".into(), Some(1.1)));
}

#[test]
fn bad_input_exits_with_2_and_writes_nothing() {
    let place = Place::with(&incline(0.65, "").replace("\"static\"", "\"dynamic\""));
    place.enmm(&["fos", "case.toml"]).assert_bad_input(&["case.toml:", "stage", "static"]);
    place.enmm(&["fos", "none.toml"]).assert_bad_input(&["none.toml"]);
    place.enmm(&["fos", "case.toml", "--tolerance", "0"]).assert_bad_input(&["--tolerance", "0.5"]);
    place.enmm(&["fos", "case.toml", "--least-area=-1"]).assert_bad_input(&["--least-area", "0 m²"]);
    place.enmm(&["fos", "case.toml", "--low", "2", "--high", "1"]).assert_bad_input(&["--low", "--high"]);
    assert_eq!(place.names(), ["case.toml"]);
}

#[cfg(unix)]
#[test]
fn an_interrupt_exits_with_130_and_keeps_the_trials() {
    use std::process::Command;
    use std::time::Duration;

    use crate::support::Outcome;

    let place = Place::with(&incline(0.65, "").replace("size = 0.9", "size = 0.12"));
    let child = place.start(&["fos", "case.toml", "-o", "out"]);
    std::thread::sleep(Duration::from_millis(500));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs").success());
    let answer = Outcome::of(child.wait_with_output().expect("an end"));
    assert_eq!(answer.status, Some(130), "{answer:?}");
    if place.path("out/fos.json").exists() {
        assert_eq!(json(&place.path("out/fos.json"))["status"], "interrupted");
    }
}
