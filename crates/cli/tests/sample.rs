//! Claim: `enmm sample` finds the probability of failure of a case with random values; its table does not depend on the
//! number of jobs, and whoever is killed, nothing that is stored is lost.

use std::fs;
use std::time::Duration;

use crate::support::{Outcome, Place, incline, json};
use enmm_ensemble::Store;

/// Block on an incline of tangent 0.5 with tan φ ~ N(0.55, 0.05): F = tan φ/0.5, P(F < 1) = Φ(−1).
const RANDOM: &str = r#"
[[random]]
key = "joint_law.plane.friction_deg"
distribution = "normal"
of = "tangent"
mean = 0.55
sd = 0.05
"#;
const PROBABILITY: f64 = 0.158_655;
/// Searches that end soon.
const QUICK: [&str; 2] = ["--tolerance", "0.05"];

fn case(random: &str) -> String {
    incline(0.6, random).replace("duration = 5.0", "duration = 1.0")
}

fn sample(place: &Place, more: &[&str]) -> Outcome {
    place.enmm(&[&["sample", "case.toml"], more].concat())
}

fn table(place: &Place, directory: &str) -> String {
    fs::read_to_string(place.path(directory).join("ensemble.csv")).expect("a table")
}

/// The samples that a store holds; none while it is being made.
fn stored(place: &Place, name: &str) -> usize {
    let path = place.path(name);
    if path.exists() { Store::open(&path).and_then(|store| store.count()).unwrap_or(0) } else { 0 }
}

#[test]
fn the_probability_of_a_block_on_an_incline_is_that_of_its_friction() {
    let place = Place::with(&case(RANDOM));
    let answer = sample(&place, &["-n", "40", "--jobs", "2"]);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    assert!(answer.stdout.contains("probability of failure"), "{answer:?}");
    let mut factors = Vec::new();
    for line in table(&place, "case").lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [friction, factor]: [f64; 2] = [cells[1], cells[2]].map(|cell| cell.parse().expect("a number"));
        let exact = friction.to_radians().tan() / 0.5;
        assert!((factor / exact - 1.0).abs() < 0.005, "{line}");
        factors.push(factor);
    }
    assert_eq!(factors.len(), 40);
    let found = json(&place.path("case/ensemble.json"));
    let failures = factors.iter().filter(|factor| **factor < 1.0).count();
    assert_eq!(found["failures"], failures);
    assert_eq!(found["probability_of_failure"].as_f64(), Some(failures as f64 / 40.0));
    let [low, high] = [0, 1].map(|end| found["interval"][end].as_f64().expect("a number"));
    assert!(low < PROBABILITY && PROBABILITY < high, "{found}");
    let rank = found["rank_correlation"]["joint_law.plane.friction_deg"].as_f64();
    assert!(rank.is_some_and(|rank| rank > 0.99), "{found}");
    assert!(fs::read(place.path("case/ensemble.png")).expect("a picture").starts_with(b"\x89PNG"));
}

/// The exact factor of each sample is tan φ over 0.5; bounds leave few of them open.
#[test]
fn samples_that_fail_are_found_by_bounds_and_few_searches() {
    let place = Place::with(&case(RANDOM));
    let wanted = ["--set", "ensemble.output=failure", "--jobs", "2"];
    let answer = sample(&place, &[&["-n", "120", "-o", "bounds"], &wanted[..], &QUICK[..]].concat());
    assert_eq!(answer.status, Some(0), "{answer:?}");
    let (mut failures, mut by_bound) = (0, 0);
    for line in table(&place, "bounds").lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [friction, estimate]: [f64; 2] = [cells[1], cells[2]].map(|cell| cell.parse().expect("a number"));
        let exact = friction.to_radians().tan() / 0.5;
        // A trial judges a block this near its limit as stable, as a search does.
        assert!((estimate < 1.0) == (exact < 1.0) || (exact - 1.0).abs() < 1e-3, "{line}");
        failures += usize::from(estimate < 1.0);
        by_bound += usize::from(cells[3] == "bound");
    }
    assert!(by_bound >= 80, "{by_bound} of 120 by their bound");
    assert!(answer.stdout.contains(&format!("{by_bound} by their bound")), "{answer:?}");
    assert_eq!(json(&place.path("bounds/ensemble.json"))["failures"], failures);
    let again = sample(&place, &[&["-n", "120", "-o", "one", "--jobs", "1"], &wanted[..2], &QUICK[..]].concat());
    assert_eq!(again.status, Some(0), "{again:?}");
    assert_eq!(table(&place, "one"), table(&place, "bounds"));
}

#[test]
fn work_ends_when_the_interval_is_as_narrow_as_asked_for() {
    let place = Place::with(&case(RANDOM));
    let wanted = ["-n", "400", "--set", "ensemble.output=level_tops", "--set", "ensemble.interval=0.12"];
    let answer = sample(&place, &wanted);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    let found = json(&place.path("case/ensemble.json"));
    let [low, high] = [0, 1].map(|end| found["interval"][end].as_f64().expect("a number"));
    let n = found["samples"].as_u64().expect("a number");
    assert!(high - low <= 0.12 && n.is_multiple_of(50) && n < 400, "{n} samples, {low} to {high}");
    assert!(answer.stdout.contains(&format!("{n} of 400")), "{answer:?}");
    let far = sample(&place, &["--set", "ensemble.output=failure", "--set", "ensemble.limit=0"]);
    assert!(far.status == Some(2) && far.stderr.contains("ensemble.limit: is 0, must be at least 0.05"), "{far:?}");
    let refused = sample(&place, &[&wanted[..], &["--set", "ensemble.sampling=latin_hypercube"]].concat());
    assert_eq!(refused.status, Some(2), "{refused:?}");
    assert!(refused.stderr.contains("ensemble.interval") && refused.stderr.contains("monte_carlo"), "{refused:?}");
}

#[test]
fn the_table_does_not_depend_on_jobs_and_a_rerun_works_nothing_out() {
    let place = Place::with(&case(RANDOM));
    for jobs in ["1", "2", "4"] {
        let answer = sample(&place, &[&["-n", "8", "--jobs", jobs, "-o", jobs], &QUICK[..]].concat());
        assert_eq!(answer.status, Some(0), "{answer:?}");
    }
    assert_eq!(table(&place, "1").lines().count(), 9);
    assert_eq!(table(&place, "2"), table(&place, "1"));
    assert_eq!(table(&place, "4"), table(&place, "1"));
    let again = sample(&place, &[&["-n", "10", "-o", "1"], &QUICK[..]].concat());
    assert!(again.stderr.starts_with("8 of 10 samples"), "{again:?}");
    assert!(table(&place, "1").starts_with(table(&place, "2").trim_end()));
    let other = sample(&place, &[&["-n", "4", "-o", "1", "--set", "ensemble.seed=2"], &QUICK[..]].concat());
    assert!(other.stderr.starts_with("0 of 4 samples"), "{other:?}");
    let finer = sample(&place, &["-n", "1", "-o", "1", "--tolerance", "0.04"]);
    assert!(finer.stderr.starts_with("0 of 1 samples"), "{finer:?}");
}

#[test]
fn a_driver_that_is_killed_loses_nothing_stored() {
    let place = Place::with(&case(RANDOM));
    let whole = sample(&place, &[&["-n", "10", "-o", "whole"], &QUICK[..]].concat());
    assert_eq!(whole.status, Some(0), "{whole:?}");
    let words = [&["sample", "case.toml", "-n", "10", "-o", "killed", "--jobs", "2"], &QUICK[..]].concat();
    let mut driver = place.start(&words);
    while stored(&place, "killed/ensemble.sqlite") < 3 && driver.try_wait().expect("a process").is_none() {
        std::thread::sleep(Duration::from_millis(5));
    }
    driver.kill().expect("killed");
    driver.wait().expect("ended");
    let kept = stored(&place, "killed/ensemble.sqlite");
    assert!((3..10).contains(&kept), "{kept}");
    let again = place.enmm(&words);
    assert!(again.stderr.starts_with(&format!("{kept} of 10 samples")), "{again:?}");
    assert_eq!(table(&place, "killed"), table(&place, "whole"));
}

/// Processes that a process has begun.
#[cfg(target_os = "linux")]
fn children(of: u32) -> Vec<String> {
    let pids = fs::read_dir("/proc").expect("processes").filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let is_child = |pid: &String| {
        let status = fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
        status.lines().any(|line| line.strip_prefix("PPid:").is_some_and(|parent| parent.trim() == of.to_string()))
    };
    pids.filter(is_child).collect()
}

#[cfg(target_os = "linux")]
#[test]
fn workers_that_are_killed_are_started_again() {
    let place = Place::with(&case(RANDOM));
    let whole = sample(&place, &[&["-n", "8", "-o", "whole"], &QUICK[..]].concat());
    assert_eq!(whole.status, Some(0), "{whole:?}");
    let driver =
        place.start(&[&["sample", "case.toml", "-n", "8", "-o", "killed", "--jobs", "2"], &QUICK[..]].concat());
    let mut killed = 0;
    for count in [1, 3] {
        while stored(&place, "killed/ensemble.sqlite") < count {
            std::thread::sleep(Duration::from_millis(2));
        }
        for pid in children(driver.id()) {
            killed +=
                usize::from(std::process::Command::new("kill").args(["-9", &pid]).status().is_ok_and(|s| s.success()));
        }
    }
    let answer = Outcome::of(driver.wait_with_output().expect("ended"));
    assert_eq!(answer.status, Some(0), "{answer:?}");
    assert!(killed >= 1, "no process was there to be killed");
    assert_eq!(table(&place, "killed"), table(&place, "whole"));
}

#[test]
fn samples_without_an_answer_are_counted_and_named() {
    let random = r#"
[[random]]
key = "joint_law.plane.friction_deg"
distribution = "uniform"
least = 50
most = 110
[ensemble]
samples = 12
output = "associated"
"#;
    let place = Place::with(&case(random));
    let answer = sample(&place, &[]);
    assert_eq!(answer.status, Some(0), "{answer:?}");
    assert!(answer.stderr.contains("samples have no answer") && answer.stderr.contains("less than 90"), "{answer:?}");
    let found = json(&place.path("case/ensemble.json"));
    let failed = found["without_answer"].as_array().expect("a list").len();
    assert!((1..12).contains(&failed));
    assert_eq!(table(&place, "case").lines().count(), 1 + 12 - failed);
    assert!(sample(&place, &[]).stderr.starts_with("12 of 12 samples"));
    assert!(sample(&place, &["--retry-failed"]).stderr.starts_with(&format!("{} of 12 samples", 12 - failed)));
}

#[test]
fn a_case_that_changes_while_it_is_sampled_ends_the_work() {
    let place = Place::with(&case(RANDOM));
    // Far more samples than are found before the change is seen: one that came after the last would change nothing.
    let words = [&["sample", "case.toml", "-n", "2000", "--jobs", "1"], &QUICK[..]].concat();
    for changed in [case(RANDOM).replace("young = 1e9", "young = 2e9"), "title = 1".to_owned()] {
        fs::write(place.path("case.toml"), case(RANDOM)).expect("written");
        let before = stored(&place, "case/ensemble.sqlite");
        let mut driver = place.start(&words);
        while stored(&place, "case/ensemble.sqlite") <= before && driver.try_wait().expect("a process").is_none() {
            std::thread::sleep(Duration::from_millis(2));
        }
        fs::write(place.path("case.toml"), changed).expect("written");
        let answer = Outcome::of(driver.wait_with_output().expect("ended"));
        assert_eq!(answer.status, Some(3), "{answer:?}");
        assert!(answer.stderr.contains("the case changed while"), "{answer:?}");
        assert!(!place.path("case/ensemble.json").exists());
    }
}

#[test]
fn what_cannot_be_sampled_is_refused_before_anything_is_written() {
    let refuse = |random: &str, more: &[&str], parts: &[&str]| {
        let place = Place::with(&case(random));
        sample(&place, more).assert_bad_input(parts);
        assert_eq!(place.names(), ["case.toml"]);
    };
    refuse("", &[], &["random", "add `[[random]]`"]);
    refuse(&RANDOM.replace("friction_deg", "friktion_deg"), &[], &["friktion_deg", "did you mean `friction_deg`"]);
    refuse(&RANDOM.replace("sd = 0.05", "sd = 0"), &[], &["case.toml:", "random[0].sd", "greater than 0"]);
    refuse(&RANDOM.replace("sd = 0.05", ""), &[], &["random[0].sd", "is missing"]);
    refuse(&RANDOM.replace("\"normal\"", "\"gauss\""), &[], &["random[0].distribution", "normal, lognormal"]);
    refuse(&format!("{RANDOM}low = 9.0\n"), &[], &["random[0].low", "hardly any value"]);
    refuse(&format!("{RANDOM}most = 9.0\n"), &[], &["random[0].most", "a normal distribution has mean, sd"]);
    refuse(&format!("{RANDOM}{RANDOM}"), &[], &["random[1].key", "random[0]"]);
    let correlation = "[[random_correlation]]\nkeys = [\"joint_law.plane.friction_deg\", \"a\"]\nvalue = 0.5\n";
    refuse(&format!("{RANDOM}{correlation}"), &[], &["random_correlation[0].keys[1]", "\"a\""]);
    refuse(RANDOM, &["--set", "joint_law.plane.friction_deg=30"], &["joint_law.plane.friction_deg", "already"]);
    refuse(RANDOM, &["--tolerance", "0"], &["--tolerance: is 0"]);
    let place = Place::with(&case(RANDOM));
    let answer = sample(&place, &["-n", "2", "--store", "case.toml"]);
    assert_eq!(answer.status, Some(2), "{answer:?}");
    assert!(answer.stderr.contains("case.toml") && answer.stderr.contains("--store"), "{answer:?}");
}
