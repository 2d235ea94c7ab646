//! Claim: `enmm sweep` finds the factor of safety over values of keys, as a curve, a contour or a tornado, and where it
//! passes the limit; its table does not depend on the number of jobs, and whoever is killed, nothing stored is lost.

use std::fs;
use std::time::{Duration, Instant};

use crate::support::{Outcome, Place, incline, json};
use enmm_ensemble::Store;
use serde_json::Value;

const FRICTION: &str = "joint_law.plane.friction_deg";
const COHESION: &str = "joint_law.plane.cohesion";
/// Share of cohesion (Pa) in the factor of the block on the incline: length of its base over the pull of its weight.
const BY_COHESION: f64 = 1.341_640_786_5 / (2600.0 * 9.81 * 1.2 * 0.447_213_595_5);

/// Block on an incline of tangent 0.5.
fn place() -> Place {
    Place::with(&incline(0.6, "").replace("duration = 5.0", "duration = 1.0"))
}

fn sweep(place: &Place, more: &[&str]) -> Outcome {
    place.enmm(&[&["sweep", "case.toml"], more].concat())
}

fn table(place: &Place, directory: &str) -> String {
    fs::read_to_string(place.path(directory).join("sweep.csv")).expect("a table")
}

/// Numbers of the rows of a table, without those of the samples.
fn numbers(place: &Place, directory: &str, count: usize) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').skip(1).take(count).map(|cell| cell.parse().expect("a number")).collect();
    table(place, directory).lines().skip(1).map(row).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// The samples that a store holds; none while it is being made.
fn stored(place: &Place, name: &str) -> usize {
    let path = place.path(name);
    if path.exists() { Store::open(&path).and_then(|store| store.count()).unwrap_or(0) } else { 0 }
}

fn tangent(degrees: f64) -> f64 {
    degrees.to_radians().tan()
}

/// F = tan φ/tan α at each value, and F = 1 at φ = α.
#[test]
fn a_curve_of_friction_is_that_of_the_formula_and_crosses_one_at_the_slope() {
    let place = place();
    let answer = sweep(&place, &[&format!("{FRICTION}=20:40:21")]);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    let rows = numbers(&place, "case/sweep", 2);
    assert_eq!(rows.len(), 21);
    for (k, row) in rows.iter().enumerate() {
        assert_eq!(row[0], 20.0 + k as f64);
        assert!((row[1] / (2.0 * tangent(row[0])) - 1.0).abs() < 3e-4, "{row:?}");
    }
    let found = json(&place.path("case/sweep/sweep.json"));
    let crossings = found["crossings"].as_array().expect("a list");
    assert_eq!(crossings.len(), 1, "{found}");
    assert_eq!(crossings[0]["between"], serde_json::json!([26.0, 27.0]));
    let exact = 0.5f64.atan().to_degrees();
    assert!((number(&crossings[0]["value"]) - exact).abs() < 0.01, "{found}");
    answer.assert_printed(&["curve", "21 values of", &format!("F = 1                   at {FRICTION} = 26.5")]);
    assert_eq!([&found["kind"], &found["output"]], ["curve", "level_tops"]);
    assert!(fs::read(place.path("case/sweep/sweep.png")).expect("a picture").starts_with(b"\x89PNG"));
    let picture = fs::read_to_string(place.path("case/sweep/sweep.svg")).expect("a picture");
    assert!(picture.contains("F = 1.00 at 26.5") && picture.contains(FRICTION), "the crossing in the picture");
}

#[test]
fn strength_reduction_makes_the_same_curve_at_any_number_of_jobs() {
    let place = place();
    let change = format!("{FRICTION}=25,30,35");
    for jobs in ["1", "2"] {
        let words = [&change, "--of", "fos", "--tolerance", "0.02", "--jobs", jobs, "-o", jobs];
        assert_eq!(sweep(&place, &words).status, Some(0));
    }
    assert_eq!(table(&place, "2"), table(&place, "1"));
    for row in numbers(&place, "1", 2) {
        assert!((row[1] / (2.0 * tangent(row[0])) - 1.0).abs() < 0.02, "{row:?}");
    }
    let found = json(&place.path("1/sweep.json"));
    let value = number(&found["crossings"][0]["value"]);
    assert!((value - 26.565).abs() < 0.6, "{found}");
    let again = sweep(&place, &[&change, "--of", "fos", "--tolerance", "0.02", "-o", "1"]);
    assert!(again.stderr.starts_with("3 of 3 samples"), "{again:?}");
}

/// F = tan φ/tan α + c L/(W sin α).
#[test]
fn two_keys_make_a_contour_that_crosses_one_on_its_line() {
    let place = place();
    let changes = [format!("{FRICTION}=16:30:15"), format!("{COHESION}=0:4e3:3")];
    let answer = sweep(&place, &[&changes[0], &changes[1], "-o", "out"]);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    let rows = numbers(&place, "out", 3);
    assert_eq!(rows.len(), 45);
    for row in &rows {
        let exact = 2.0 * tangent(row[0]) + row[1] * BY_COHESION;
        assert!((row[2] / exact - 1.0).abs() < 1e-3, "{row:?}, exact {exact}");
    }
    let found = json(&place.path("out/sweep.json"));
    let crossings = found["crossings"].as_array().expect("a list");
    assert_eq!(crossings.len(), 3, "{found}");
    for (crossing, cohesion) in crossings.iter().zip([0.0, 2e3, 4e3]) {
        assert_eq!(number(&crossing["at"]), cohesion);
        let exact = (0.5 * (1.0 - cohesion * BY_COHESION)).atan().to_degrees();
        assert!((number(&crossing["value"]) - exact).abs() < 0.02, "{crossing}, exact {exact}");
    }
    let picture = fs::read_to_string(place.path("out/sweep.svg")).expect("a picture");
    assert!(picture.contains(FRICTION) && picture.contains(COHESION));
}

#[test]
fn changes_one_by_one_make_a_tornado_with_the_greatest_effect_first() {
    let place = place();
    let changes = ["rock.rock.density=2000".to_owned(), format!("{COHESION}=1e3,2e3"), format!("{FRICTION}=20,35")];
    let words = [&changes[0], &changes[1], &changes[2], "--one-by-one", "-o", "out"];
    let answer = sweep(&place, &words);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    let found = json(&place.path("out/sweep.json"));
    assert!((number(&found["of_the_case"]) / 1.2 - 1.0).abs() < 3e-4, "{found}");
    let effects = found["effects"].as_array().expect("a list");
    let keys: Vec<&Value> = effects.iter().map(|effect| &effect["key"]).collect();
    assert_eq!(keys, [FRICTION, COHESION, "rock.rock.density"]);
    let exact = [2.0 * (tangent(35.0) - tangent(20.0)), 2e3 * BY_COHESION, 0.0];
    for (effect, exact) in effects.iter().zip(exact) {
        assert!((number(&effect["range"]) - exact).abs() < 2e-3, "{effect}, exact {exact}");
    }
    // A key that a sample leaves as it is has no value in its row.
    let lines: Vec<String> = table(&place, "out").lines().map(str::to_owned).collect();
    assert_eq!(lines.len(), 7);
    assert!(lines[1].starts_with("0,,,,1.") && lines[2].starts_with("1,2000,,,1."), "{lines:?}");
    answer.assert_printed(&["tornado", "1 value of rock.rock.density", "the case"]);
}

/// The block slides where tan φ is less than 0.5.
#[test]
fn runs_tell_between_which_values_the_slope_begins_to_fail() {
    let place = Place::with(&incline(0.6, ""));
    let answer = sweep(&place, &[&format!("{FRICTION}=20,24,29,33"), "--of", "run", "-o", "out"]);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    let found = json(&place.path("out/sweep.json"));
    let samples = found["samples"].as_array().expect("a list");
    let statuses: Vec<&Value> = samples.iter().map(|sample| &sample["status"]).collect();
    assert_eq!(statuses, ["fails", "fails", "stands", "stands"]);
    assert!(number(&samples[0]["displacement"]) > 50.0 * number(&samples[3]["displacement"]), "{found}");
    assert_eq!(found["crossings"], serde_json::json!([{ "value": null, "between": [24.0, 29.0] }]));
    answer.assert_printed(&[&format!("failure                 begins at {FRICTION} between 24 and 29")]);
    assert_eq!(place.names(), ["case.toml", "out"], "runs leave no folders");
}

#[test]
fn a_limit_that_is_not_passed_is_told() {
    let place = place();
    let change = format!("{FRICTION}=30,35,40");
    let above = sweep(&place, &[&change]);
    assert_eq!(above.status, Some(0), "{above:?}");
    above.assert_printed(&["is not crossed: no factor is below it"]);
    assert_eq!(json(&place.path("case/sweep/sweep.json"))["crossings"], serde_json::json!([]));
    let below = sweep(&place, &[&change, "--set", "ensemble.limit=2"]);
    below.assert_printed(&["F = 2 ", "is not crossed: all factors are below it"]);
    assert!(below.stderr.starts_with("3 of 3 samples"), "the limit changes no sample: {below:?}");
}

#[test]
fn a_sweep_that_is_killed_loses_nothing_stored() {
    let place = place();
    let change = format!("{FRICTION}=20:40:60");
    assert_eq!(sweep(&place, &[&change, "-o", "whole"]).status, Some(0));
    let words = ["sweep", "case.toml", &change, "-o", "killed", "--jobs", "2"];
    let mut driver = place.start(&words);
    while stored(&place, "killed/ensemble.sqlite") < 3 && driver.try_wait().expect("a process").is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    driver.kill().expect("killed");
    driver.wait().expect("ended");
    let kept = stored(&place, "killed/ensemble.sqlite");
    assert!((3..60).contains(&kept), "{kept}");
    let again = place.enmm(&words);
    assert!(again.stderr.starts_with(&format!("{kept} of 60 samples")), "{again:?}");
    assert_eq!(table(&place, "killed"), table(&place, "whole"));
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_the_samples_that_are_done() {
    let place = place();
    let change = format!("{FRICTION}=20:40:300");
    let words = ["sweep", "case.toml", &change, "--jobs", "1"];
    let driver = place.start(&words);
    while stored(&place, "case/sweep/ensemble.sqlite") < 3 {
        std::thread::sleep(Duration::from_millis(1));
    }
    let id = driver.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().is_ok_and(|status| status.success()));
    let answer = Outcome::of(driver.wait_with_output().expect("ended"));
    assert_eq!(answer.status, Some(130), "{answer:?}");
    assert!(answer.stderr.contains("of 300 samples done, which are stored"), "{answer:?}");
    let kept = stored(&place, "case/sweep/ensemble.sqlite");
    assert!(kept >= 3 && !place.path("case/sweep/sweep.json").exists());
    let again = place.enmm(&words);
    assert!(again.status == Some(0) && again.stderr.starts_with(&format!("{kept} of 300 samples")), "{again:?}");
}

#[test]
fn a_case_that_changes_in_the_middle_ends_the_work() {
    let place = place();
    let case = fs::read_to_string(place.path("case.toml")).expect("a case");
    let mut driver = place.start(&["sweep", "case.toml", &format!("{FRICTION}=20:40:1000"), "--jobs", "1"]);
    while stored(&place, "case/sweep/ensemble.sqlite") < 1 && driver.try_wait().expect("a process").is_none() {
        std::thread::sleep(Duration::from_millis(2));
    }
    fs::write(place.path("case.toml"), case.replace("young = 1e9", "young = 2e9")).expect("written");
    let answer = Outcome::of(driver.wait_with_output().expect("ended"));
    assert_eq!(answer.status, Some(3), "{answer:?}");
    assert!(answer.stderr.contains("the case changed while"), "{answer:?}");
    assert!(!place.path("case/sweep/sweep.json").exists());
}

#[test]
fn what_cannot_be_swept_is_refused_before_anything_is_written() {
    let place = place();
    let good = format!("{FRICTION}=20,30");
    let (twice, none, far) = (format!("{FRICTION}=1,1"), format!("{FRICTION}=30"), format!("{FRICTION}=60:100:5"));
    for (words, parts) in [
        (&["mesh.size"][..], &["mesh.size: is no key with values", "KEY=FIRST:LAST:COUNT"][..]),
        (&[&twice], &["has the value 1 twice"]),
        (&[&none], &[FRICTION, "has 1 value, a curve needs at least 2", "--one-by-one"]),
        (&[&good, &good], &[FRICTION, "is given twice"]),
        (&[&good, "mesh.size=1,2", "rock.rock.young=1e9,2e9"], &["are 3 keys", "--one-by-one"]),
        (&["joint_law.plane.friktion_deg=20,30"], &["friktion_deg", "did you mean `friction_deg`"]),
        (&[&far], &["--set joint_law.plane.friction_deg=90:", "is 90 degrees, must be at least 0 and less than 90"]),
        (&[&good, "--set", "joint_law.plane.friction_deg=30"], &["is set to", "already"]),
        (&[&good, "--tolerance", "0.1"], &["--tolerance: is an option of searches", "--of fos"]),
        (&[&good, "--of", "fos", "--tolerance", "0"], &["--tolerance: is 0"]),
    ] {
        sweep(&place, words).assert_bad_input(parts);
        assert_eq!(place.names(), ["case.toml"], "{words:?}");
    }
}

/// Twenty bounds of the case of the quick start.
#[test]
fn a_curve_of_the_quick_start_takes_seconds() {
    let place = place();
    place.answers(0, &["new", "slope", "-o", "slope.toml"]);
    let clock = Instant::now();
    place.answers(0, &["sweep", "slope.toml", "joint_law.fault.friction_deg=15:40:20"]);
    let taken = clock.elapsed();
    assert!(taken <= Duration::from_secs(10), "{taken:?}");
}
