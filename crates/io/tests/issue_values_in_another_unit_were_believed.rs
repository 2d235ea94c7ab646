//! Issue: bolts with 600 "kN", a friction angle of 1.19 "°" and steel of 195 "Pa" ran without a word.

use std::path::Path;

use enmm_io::{load_case, parse_case};

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

/// Bolts at -165° for -15° had their heads at the far end of the model.
#[test]
fn heads_farther_from_their_line_than_bolts_are_long_are_told() {
    let pattern = |angle: f64| {
        let row = "\n[[bolt_pattern]]\nname = \"row\"\nline = [[1, 3], [8, 17]]\ncount = 4\nlength = 9.0\n\
                   anchorage = \"grouted\"\nyoung = 200e9\narea = 4.9e-4\n";
        format!("{BOLTED}{row}angle_deg = {angle:?}\n")
    };
    assert_eq!(told(&pattern(-15.0)), Vec::<String>::new());
    let said = told(&pattern(-165.0));
    let wanted = "bolt_pattern[0]: 4 of 4 heads lie up to 37.960 m from `line`, farther than the bolts are long (9 m)";
    assert!(said.iter().any(|line| line.starts_with(wanted) && line.contains("turn `angle_deg` by 180°")), "{said:?}");
}

#[test]
fn distributions_are_doubted_as_values_are() {
    let random = |key: &str, rest: &str| {
        told(&format!("{BOLTED}\n[ensemble]\nsamples = 8\n[[random]]\nkey = \"{key}\"\n{rest}\n"))
    };
    let friction = "joint_law.fault.friction_deg";
    for (key, rest, wanted) in [
        (friction, "distribution = \"normal\"\nmean = 32\nsd = 2", ""),
        (friction, "distribution = \"normal\"\nmean = 0.6249\nsd = 0.05\nof = \"tangent\"", ""),
        ("joint_law.fault.cohesion", "distribution = \"uniform\"\nleast = 0\nmost = 80e3", ""),
        (friction, "distribution = \"normal\"\nmean = 0.6249\nsd = 0.05", "0.6249 is the tangent of 32.0°"),
        (friction, "distribution = \"normal\"\nmean = 32\nsd = 2\nof = \"tangent\"", "random[0].mean"),
        ("joint_law.fault.cohesion", "distribution = \"lognormal\"\nmean = 40\nsd = 8", "looks like kPa: write 40000"),
        ("bolt[0].yield_force", "distribution = \"uniform\"\nleast = 1000\nmost = 1500", "looks like kN"),
    ] {
        let said = random(key, rest);
        let fits = if wanted.is_empty() { said.is_empty() } else { said.iter().any(|line| line.contains(wanted)) };
        assert!(fits, "{key} {rest}: {said:?}");
    }
}

#[test]
fn errors_say_what_is_usual() {
    let said = told(&BOLTED.replace("young = 195e9", "young = -195e9"));
    assert!(said[0].contains("bolt[0].young") && said[0].contains("steel has 2e11 Pa"), "{said:?}");
}

#[test]
fn shipped_cases_are_not_doubted() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/cases");
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if entry.extension().is_some_and(|extension| extension == "toml") {
            let loaded = load_case(&entry).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(loaded.typed.doubts(), Vec::<String>::new(), "{}", entry.display());
        }
    }
}
