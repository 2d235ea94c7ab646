//! Issue: bolts with 600 "kN", a friction angle of 1.19 "°" and steel of 195 "Pa" ran without a word.

use std::path::Path;

use enmm::model::case::plausible;
use enmm_io::{load_case, parse_case, schema};

const BOLTED: &str = r#"
title = "bolted bench"
[domain]
outline = [[-15, -8], [40, -8], [40, 20], [10, 20], [0, 0], [-15, 0]]
[mesh]
size = 1.5
angle_deg = 12
[[joint]]
points = [[1, 2], [30, 20]]
law = "fault"
[[joint_set]]
dip_deg = 20
dips = "right"
spacing = 4.0
trace_length = 8.0
gap = 2.0
seed = 1
law = "fault"
[rock.granite]
density = 2650
young = 20e9
poisson = 0.25
[joint_law.fault]
friction_deg = 32
cohesion = 40e3
[[bolt]]
name = "anchor"
points = [[2, 5], [20, 2]]
young = 195e9
area = 8.4e-4
spacing = 2.0
pretension = 600e3
yield_force = 1300e3
[water]
level = 3.0
density = 1000
[[fix]]
edge = [[-15, -8], [40, -8]]
[[stage]]
name = "gravity"
kind = "static"
duration = 30.0
[output]
frame_interval = 0.5
history_interval = 0.02
"#;

/// Messages about a case: its warnings, or the error that refuses it.
fn told(text: &str) -> Vec<String> {
    match parse_case(text, "test.toml", Path::new(".")) {
        Ok(loaded) => loaded.warnings,
        Err(error) => vec![error.to_string()],
    }
}

/// Every value with a unit but coordinates, deviations, seeds and the size of the mesh, which the model judges.
#[test]
fn a_thousandth_and_a_thousandfold_of_each_value_are_named() {
    assert_eq!(told(BOLTED), Vec::<String>::new());
    let mut slips = 0;
    for line in BOLTED.lines().filter(|line| !line.starts_with("size") && !line.starts_with("poisson")) {
        let Some((key, value)) = line.split_once(" = ") else { continue };
        let Ok(value) = value.parse::<f64>() else { continue };
        if ["seed", "level"].contains(&key) {
            continue;
        }
        for by in [1e3, 1e-3] {
            let text = BOLTED.replace(line, &format!("{key} = {:e}", value * by));
            let said = told(&text);
            assert!(said.iter().any(|line| line.contains(key)), "{key} times {by}: {said:?}");
            slips += 1;
        }
    }
    assert_eq!(slips, 36);
}

#[test]
fn slips_in_a_unit_are_called_by_it() {
    for (line, slip, wanted) in [
        ("pretension = 600e3", "pretension = 600", "600 looks like kN: write 6e5"),
        ("area = 8.4e-4", "area = 840", "840 looks like mm²: write 0.00084"),
        ("young = 195e9", "young = 195", "195 looks like GPa: write 1.95e11"),
        ("cohesion = 40e3", "cohesion = 40", "40 looks like kPa: write 40000"),
        ("density = 2650", "density = 26.5", "26.5 looks like kN/m³: write 2701"),
        ("friction_deg = 32", "friction_deg = 0.6249", "0.6249 is the tangent of 32.0°"),
        ("friction_deg = 32", "friction_deg = 5", "unusually little: joints have 15 to 60°"),
        ("friction_deg = 32", "friction_deg = 85", "unusually much"),
    ] {
        let said = told(&BOLTED.replace(line, slip));
        assert!(said.iter().any(|line| line.contains(wanted)), "{slip}: {said:?}");
    }
}

#[test]
fn errors_say_what_is_usual() {
    let said = told(&BOLTED.replace("young = 195e9", "young = -195e9"));
    assert!(said[0].contains("bolt[0].young") && said[0].contains("steel has 2e11 Pa"), "{said:?}");
}

/// A key that was renamed would be doubted no longer.
#[test]
fn every_key_of_the_table_is_a_key_of_a_case() {
    let schema = schema().to_string();
    for key in plausible::keys() {
        let last = key.rsplit('.').next().expect("a name");
        assert!(schema.contains(&format!("\"{last}\":")), "{key}");
    }
}

#[test]
fn shipped_cases_are_not_doubted() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/cases");
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if entry.extension().is_some_and(|extension| extension == "toml") {
            let loaded = load_case(&entry).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(plausible::doubts(&loaded.typed), Vec::<String>::new(), "{}", entry.display());
        }
    }
}
