//! Claim: `enmm sets` reads a table, draws its net, and prints lines with which a case is built.

use std::f64::consts::PI;
use std::fs;

use crate::support::{Place, incline};

/// Planes about a mean on a circle of 6°, evenly, in a table: their mean is its centre.
fn table() -> String {
    let mut text = String::from("Dip,Dip Direction,Set\n");
    for (dip, direction, name) in [(40.0, 120.0, "bedding"), (80.0, 15.0, "K1")] {
        for k in 0..24 {
            let turn = 2.0 * PI * f64::from(k) / 24.0;
            // Across the dip, an angle of the pole is one of the direction over sin(dip).
            let (steep, round) = (dip + 6.0 * turn.cos(), direction + 6.0 * turn.sin() / f64::to_radians(dip).sin());
            text.push_str(&format!("{steep:.4},{round:.4},{name}\n"));
        }
    }
    text
}

fn place() -> Place {
    let place = Place::with("");
    fs::write(place.path("survey.csv"), table()).expect("written");
    place
}

#[test]
fn a_table_becomes_sets_a_net_and_lines_of_a_case() {
    let place = place();
    let arguments = ["sets", "survey.csv", "--section", "120", "--assigned", "rows.csv"];
    let answer = place.answers(0, &arguments);
    answer.assert_printed(&[
        "criterion by sets",
        "[[joint_set]]",
        "angle_distribution = \"fisher\"",
        "azimuth_deg = 120",
    ]);
    let found = place.answers(0, &[&arguments[..], &["--json"]].concat()).json();
    let sets = found["sets"].as_array().expect("sets");
    assert_eq!(sets.len(), 2);
    for (dip, direction) in [(40.0, 120.0), (80.0, 15.0)] {
        let near = |value: &serde_json::Value, wanted: f64| (value.as_f64().expect("a number") - wanted).abs() < 0.5;
        let set = sets.iter().find(|set| near(&set["dip_deg"], dip)).expect("a set");
        assert!(near(&set["dip_direction_deg"], direction), "{set}");
        // Poles 6° from their mean: κ = (n − 1)/(n·(1 − cos 6°)).
        let kappa = 23.0 / (24.0 * (1.0 - f64::to_radians(6.0).cos()));
        assert!((set["fisher_k"].as_f64().expect("a number") / kappa - 1.0).abs() < 0.05, "{set}");
    }
    let svg = fs::read_to_string(place.path("survey.sets.svg")).expect("a picture");
    assert!(svg.contains("48 poles") && svg.contains("strikes in 10°") && !svg.contains("NaN"));
    let rows = fs::read_to_string(place.path("rows.csv")).expect("rows");
    assert_eq!(rows.lines().count(), 49);
    assert_eq!(rows.lines().filter(|row| row.ends_with(",J1")).count(), 24);
    // With a spacing for what is open, the lines are part of a case that is built.
    let lines = answer.stdout.split_once("[section]").expect("lines").1.to_owned();
    let lines = lines.replace("# open: spacing", "spacing = 1.5 #");
    let case = incline(0.65, &format!("\n[section]{lines}\n"));
    fs::write(place.path("case.toml"), case).expect("written");
    let built = place.answers(0, &["check", "case.toml", "--json"]).json();
    assert!(built["blocks"].as_u64().expect("blocks") > 4, "{built}");
}

#[test]
fn named_sets_are_kept_and_spacings_found() {
    let place = Place::with("");
    let rows: String = (0..8).map(|k| format!("90,{},bedding,{}\n", k % 2, 2 * k)).collect();
    fs::write(place.path("t.csv"), format!("dip,dip direction,set,distance\n{rows}")).expect("written");
    let found = place.answers(0, &["sets", "t.csv", "--named", "--traverse", "60/0", "--json"]).json();
    let set = &found["sets"][0];
    assert_eq!(set["name"], "bedding");
    // Upright joints whose normals are 60° and 59° from the line, 2 m apart along it.
    assert!((set["spacing"].as_f64().expect("a spacing") - 2.0 * f64::to_radians(59.5).cos()).abs() < 1e-3, "{set}");
    // By weights of 1/cos 60° and 1/cos 59° the mean is nearer to the first, by 59.507°.
    place.answers(0, &["sets", "t.csv", "--named", "--traverse", "60/0"]).assert_printed(&["spacing = 1.0149"]);
}

#[test]
fn wrong_tables_and_options_are_refused() {
    let place = place();
    let refused = |arguments: &[&str], parts: &[&str]| {
        place.enmm(&[&["sets"], arguments].concat()).assert_bad_input(parts);
    };
    fs::write(place.path("steep.csv"), "dip,dip direction\n30,10\n95,20\n").expect("written");
    refused(&["steep.csv"], &["steep.csv:3: dip is 95°, must be from 0 to 90"]);
    refused(&["none.csv"], &["none.csv"]);
    refused(&["survey.csv", "--sets", "13"], &["13 sets of 48 poles, must be from 1 to 8"]);
    refused(&["survey.csv", "--traverse", "T1=10/0"], &["survey.csv:2: traverse \"none\"", "--traverse"]);
    refused(&["survey.csv", "-o", "survey.csv"], &["survey.csv", "-o"]);
    let plain = "dip,dip direction\n30,10\n31,20\n32,15\n33,12\n";
    fs::write(place.path("plain.csv"), plain).expect("written");
    refused(&["plain.csv", "--named"], &["no row has one in a column `set`"]);
    assert!(!place.path("plain.sets.svg").exists());
}
