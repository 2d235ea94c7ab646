//! Claim: `--set key=value` gives a case another value in each command that reads one, and is named by what it breaks.

use std::fs;

use crate::support::{Place, case, incline, json};

/// FoS = tan φ/tan a = 2·tan φ: that of the value that is set, within the bracket and 0.5 % for the judge.
#[test]
fn a_factor_is_that_of_the_value_that_is_set() {
    let place = Place::with(&incline(0.4, ""));
    let friction = format!("joint_law.plane.friction_deg={:?}", 0.65f64.atan().to_degrees());
    place.answers(0, &["fos", "case.toml", "-o", "out", "--tolerance", "0.01", "--set", &friction]);
    let found = json(&place.path("out/fos.json"));
    assert!((found["factor_of_safety"].as_f64().expect("a factor") / 1.3 - 1.0).abs() < 0.015, "{found}");
    assert_eq!(found["settings"], serde_json::json!([friction]));
    let page = fs::read_to_string(place.path("out/report.html")).expect("a page");
    assert!(page.len() > 1000);
    let bound = place.enmm(&["bound", "case.toml", "--json", "-o", "out", "--set", &friction]).json();
    let factor = bound["level_tops"]["factor"].as_f64().expect("a bound");
    assert!((factor / 1.3 - 1.0).abs() < 3e-4, "{factor}");
}

#[test]
fn run_check_and_fmu_take_settings() {
    let place = Place::with(&case(0.1));
    let settings =
        ["--set", "stage[1].duration=0.02", "--set", "title=Two other blocks", "--set", "solver.sweeps_max=50"];
    let run = |more: &[&str], out: &str| {
        place.answers(0, &[&["run", "case.toml", "--quiet", "-o", out], more].concat());
        json(&place.path(out).join("summary.json"))
    };
    let (set, plain) = (run(&settings, "set"), run(&[], "plain"));
    assert_eq!(set["title"], "Two other blocks");
    assert!((set["stages"][1]["time"].as_f64().expect("a time") - 0.02).abs() < 1e-3, "{set}");
    assert_eq!(set["settings"].as_array().map(Vec::len), Some(3));
    assert!(plain.get("settings").is_none() && plain["case_hash"] != set["case_hash"]);
    // A value that is set belongs to the case: the same hash as of a file with that value.
    let text = case(0.02).replace("Two blocks", "Two other blocks") + "[solver]\nsweeps_max = 50\n";
    fs::write(place.path("other.toml"), text).expect("written");
    place.answers(0, &["run", "other.toml", "--quiet", "-o", "other"]);
    assert_eq!(json(&place.path("other/summary.json"))["case_hash"], set["case_hash"]);
    for file in ["history.csv", "blocks.csv"] {
        let read = |folder: &str| fs::read(place.path(folder).join(file)).expect("readable");
        assert_eq!(read("other"), read("set"), "{file}");
    }
    let finer = place.enmm(&["check", "case.toml", "--json", "--set", "mesh.size=0.3"]).json();
    let coarse = place.enmm(&["check", "case.toml", "--json"]).json();
    assert!(finer["elements"].as_u64() > coarse["elements"].as_u64());
}

#[test]
fn a_setting_that_cannot_be_used_is_named() {
    let place = Place::with(&case(0.1));
    for (setting, message) in [
        ("joint_law.plan.friction_deg=30", "joint_law.plan: the case has no \"plan\" there, did you mean \"plane\""),
        ("joint_law.plane.friction=30", "unknown key \"friction\", did you mean `friction_deg`?"),
        ("joint_law.plane.friction_deg=95", "joint_law.plane.friction_deg: is 95 degrees, must be at least 0 and less"),
        ("joint_law.plane.friction_deg=30,5", "is the string \"30,5\", must be a number; write `friction_deg = 30.5`"),
        ("joint_law.plane.friction_deg=", "joint_law.plane.friction_deg: is the string \"\", must be a number"),
        ("joint_set[0].seed=7", "joint_set: the case has none; add `[[joint_set]]` with `spacing = 1.0`"),
        ("stage[2].duration=1", "stage[2]: the case has 2 of `stage`, counted from 0"),
        ("stage.duration=1", "stage: is a list; write `stage[0].duration` for its first, counted from 0"),
        ("mesh.size.x=1", "mesh.size: is a number, which has no parts"),
        ("water.level.y=1", "water.level: is a number, which has no parts"),
        ("water.density=900", "water: has 0 of `level` and `table`, must have exactly 1"),
        ("stage[0].kind=statik", "stage[0].kind: is \"statik\", did you mean \"static\"?"),
        ("mesh", "is no key and value; write KEY=VALUE, as in joint_law.plane.friction_deg=30"),
        ("domain.outline=[[0, 0]]", "domain.outline: has 1 points, a loop needs at least 3"),
    ] {
        for command in ["run", "check", "fos", "bound", "fmu"] {
            let answer = place.enmm(&[command, "case.toml", "--set", setting]);
            answer.assert_bad_input(&[&format!("error: --set {setting}: "), message]);
        }
    }
    let twice = place.enmm(&["check", "case.toml", "--set", "mesh.size=1", "--set", "mesh.size=2"]);
    twice.assert_bad_input(&["--set mesh.size=2: mesh.size: is set to \"mesh.size=1\" already"]);
    assert_eq!(place.names(), ["case.toml"], "nothing is written");
}

#[test]
fn fos_names_the_stages_it_leaves_out_before_it_starts() {
    let stage = "[[stage]]\nname = \"quake\"\nkind = \"dynamic\"\nduration = 1.0\n";
    let place = Place::with(&incline(0.65, stage));
    let answer = place.answers(0, &["fos", "case.toml", "-o", "out", "--tolerance", "0.1"]);
    let first = answer.stderr.lines().next().unwrap_or_default();
    assert_eq!(first, "warning: stages from the first dynamic one on are left out: quake");
}
