//! Claim: `enmm export` writes what a run has found: tables, blocks and joints with their numbers; and the drawing that
//! it writes gives the same blocks back.

use std::fs;

use serde_json::Value;

use crate::support::{Place, incline};

/// A ring of coordinates.
type Ring = Vec<[f64; 2]>;

fn run() -> Place {
    let place = Place::with(&incline(0.65, ""));
    place.answers(0, &["run", "case.toml"]);
    place
}

fn features(place: &Place, name: &str) -> Vec<Value> {
    let collection: Value = serde_json::from_slice(&fs::read(place.path(name)).expect("a file")).expect("JSON");
    assert_eq!(collection["type"], "FeatureCollection");
    let features = collection["features"].as_array().expect("features").clone();
    assert!(features.iter().all(|feature| feature["type"] == "Feature" && feature["properties"].is_object()));
    features
}

fn of_kind<'a>(features: &'a [Value], kind: &str) -> Vec<&'a Value> {
    features.iter().filter(|feature| feature["properties"]["kind"] == kind).collect()
}

/// Twice the area that a closed ring goes round, positive to the left.
fn turn(ring: &Ring) -> f64 {
    ring.windows(2).map(|ends| ends[0][0] * ends[1][1] - ends[1][0] * ends[0][1]).sum()
}

fn number(value: &Value, name: &str) -> f64 {
    value["properties"][name].as_f64().unwrap_or_else(|| panic!("no {name}: {value}"))
}

/// Columns of blocks.csv by their heads, units left out.
fn blocks(place: &Place) -> Vec<Vec<(String, f64)>> {
    let text = fs::read_to_string(place.path("case/blocks.csv")).expect("blocks.csv");
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let heads = lines.next().expect("heads");
    let name = |head: &String| head.split(" [").next().unwrap_or_default().to_owned();
    let row = |row: Vec<String>| {
        heads.iter().map(name).zip(row.iter().map(|text| text.parse().expect("a number"))).collect::<Vec<_>>()
    };
    lines.map(row).collect()
}

/// The block has an area of 1.2 m² on a plane of slope 1 in 2, over 0.6·√5 m of it: at rest the normal stress is the
/// part of its weight across the plane over that length, and the shear stress half of it.
#[test]
fn features_have_the_numbers_of_the_run_and_of_the_hand() {
    let place = run();
    place.answers(0, &["export", "case", "--geojson", "end.geojson"]).assert_printed(&["features", "end.geojson"]);
    let found = features(&place, "end.geojson");
    let table = blocks(&place);
    assert_eq!(of_kind(&found, "block").len(), table.len());
    for feature in of_kind(&found, "block") {
        assert_eq!(feature["geometry"]["type"], "Polygon");
        let rings: Vec<Ring> = serde_json::from_value(feature["geometry"]["coordinates"].clone()).expect("rings");
        assert!(rings.iter().all(|ring| ring.len() > 3 && ring.first() == ring.last()), "rings are closed");
        assert!(rings.iter().enumerate().all(|(k, ring)| (turn(ring) > 0.0) == (k == 0)), "right-hand rule");
        let area: f64 = rings.iter().map(|ring| 0.5 * turn(ring)).sum();
        let row = &table[number(feature, "block") as usize];
        let of = |name: &str| row.iter().find(|(known, _)| known == name).expect(name).1;
        assert!((area / of("area") - 1.0).abs() < 1e-3, "{area}");
        for name in ["displacement_x", "displacement_y", "mean_stress_yy", "area", "mass"] {
            assert!((number(feature, name) - of(name)).abs() <= of(name).abs() / 32768.0, "{name}: {feature}");
        }
        let mean = 0.5 * (of("mean_stress_xx") + of("mean_stress_yy"));
        assert!((number(feature, "mean_stress") - mean).abs() <= 1e-3 * mean.abs(), "{feature}");
    }
    let joints = of_kind(&found, "joint");
    let length = |feature: &Value| {
        let [a, b]: [[f64; 2]; 2] = serde_json::from_value(feature["geometry"]["coordinates"].clone()).expect("a line");
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    let total: f64 = joints.iter().map(|joint| length(joint)).sum();
    assert!((total / (0.6 * 5_f64.sqrt()) - 1.0).abs() < 1e-3, "{total}");
    let cosine = 2.0 / 5_f64.sqrt();
    let normal = -2600.0 * 9.80665 * 1.2 * cosine / (0.6 * 5_f64.sqrt());
    for joint in joints {
        let [found, shear] = ["normal_stress", "shear_stress"].map(|name| number(joint, name));
        assert!((found / normal - 1.0).abs() < 2e-3, "{found} beside {normal}");
        assert!((shear.abs() / normal.abs() - 0.5).abs() < 2e-3, "{shear} beside {normal}");
        assert_eq!(joint["properties"]["law"], "plane");
        let state = joint["properties"]["state"].as_str().expect("a state");
        assert!(["slip", "lock"].contains(&state), "{joint}");
    }
}

#[test]
fn the_drawing_of_a_run_gives_the_same_blocks() {
    let place = run();
    place.answers(0, &["export", "case", "--dxf", "end.dxf"]).assert_printed(&["drawing", "end.dxf"]);
    let text = incline(
        0.65,
        "[layers.outline]\nuse = \"outline\"\n[layers.joint_plane]\nuse = \"joint\"\n\
                              law = \"plane\"\n[layers.\"*\"]\nuse = \"ignore\"\n",
    );
    let outline = text.lines().find(|line| line.starts_with("outline")).expect("an outline").to_owned();
    let text = text.replace(&outline, "geometry_file = \"end.dxf\"\nsnap_tolerance = 1e-3");
    let text = text.replace("[[joint]]\npoints = [[4, 2], [2.8, 2.6]]\n", "");
    fs::write(place.path("back.toml"), text).expect("written");
    let areas = |case: &str| -> Vec<f64> {
        place.answers(0, &["run", case]);
        let folder = case.trim_end_matches(".toml");
        let text = fs::read_to_string(place.path(&format!("{folder}/blocks.csv"))).expect("blocks.csv");
        let column =
            text.lines().next().expect("heads").split(',').position(|head| head == "area [m2]").expect("areas");
        text.lines()
            .skip(1)
            .map(|row| row.split(',').nth(column).expect("an area").parse().expect("a number"))
            .collect()
    };
    let (before, after) = (areas("case.toml"), areas("back.toml"));
    assert_eq!(before.len(), 2);
    assert_eq!(after.len(), 2);
    for (before, after) in before.iter().zip(&after) {
        assert!((before / after - 1.0).abs() < 1e-3, "{before} and {after}");
    }
}

#[test]
fn frames_are_chosen_by_number_and_time() {
    let place = run();
    let at = |arguments: &[&str]| -> f64 {
        place.answers(0, &[&["export", "case", "--geojson", "a.geojson"], arguments].concat());
        let text: Value = serde_json::from_slice(&fs::read(place.path("a.geojson")).expect("a file")).expect("JSON");
        text["enmm"]["at"]["value"].as_f64().expect("a time")
    };
    let end = at(&[]);
    assert_eq!(at(&["--frame", "0"]), 0.0);
    assert!(end > 0.0 && at(&["--time", "0.0"]) == 0.0 && at(&["--time", &end.to_string()]) == end);
    let second = at(&["--frame", "1"]);
    assert!(second > 0.0 && second < end);
    assert_eq!(at(&["--time", &(0.9 * second).to_string()]), second);
    let refused = |arguments: &[&str], parts: &[&str]| {
        place.enmm(&[&["export", "case", "--dxf", "b.dxf"], arguments].concat()).assert_bad_input(parts);
    };
    refused(&["--frame", "99999"], &["has no frame 99999, must be from 0 to"]);
    refused(&["--time", "1e9"], &["has no frame at 1000000000, must be from 0 to", "--time"]);
    place.enmm(&["export", "case", "--dxf", "case/blocks.csv"]).assert_bad_input(&["must end with .dxf", "--dxf"]);
    place.enmm(&["export", "case", "--xlsx", "t.xlsx", "--frame", "1"]).assert_bad_input(&["--frame", "--geojson"]);
    fs::write(place.path("case/film.bin"), "enmmfil6 and no more").expect("written");
    refused(&[], &["film.bin", "run the command that wrote it again"]);
    fs::remove_file(place.path("case/film.bin")).expect("removed");
    refused(&[], &["holds no film.bin", "enmm run"]);
}

#[test]
fn a_case_without_frames_is_exported_without_joints_and_says_so() {
    let place = Place::with(&incline(0.65, "[output]\nframes = false\n"));
    place.answers(0, &["run", "case.toml"]);
    let answer = place.answers(0, &["export", "case", "--geojson", "end.geojson"]);
    assert!(answer.stderr.contains("note: no joints: they stand in frames/"), "{answer:?}");
    let found = features(&place, "end.geojson");
    assert_eq!((of_kind(&found, "block").len(), of_kind(&found, "joint").len()), (2, 0));
}

#[test]
fn tables_become_a_spreadsheet_also_of_a_sweep() {
    let place = run();
    place.answers(0, &["export", "case", "--xlsx", "case.xlsx"]).assert_printed(&["spreadsheet", "case.xlsx"]);
    place.answers(0, &["sweep", "case.toml", "joint_law.plane.friction_deg=20,30", "-o", "sweep", "--xlsx"]);
    for name in ["case.xlsx", "sweep/sweep.xlsx"] {
        assert!(fs::read(place.path(name)).expect(name).starts_with(b"PK"));
    }
    place.answers(0, &["sweep", "case.toml", "joint_law.plane.friction_deg=20,30", "-o", "sweep"]);
    assert!(!place.path("sweep/sweep.xlsx").exists(), "an older spreadsheet is gone");
}
