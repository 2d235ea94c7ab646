//! Claim: `enmm check` counts blocks, elements, covers and masses of real traces, slopes and cover cases as independent
//! programs do. The data stay outside the repository; the tests say so and skip when the folder is absent.

mod common;

use std::path::{Path, PathBuf};

use common::shared::shared;

use enmm::model::Simulation;
use enmm_run::check::Check;
use serde_json::Value;

fn read(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("readable")).expect("valid JSON")
}

/// Checks the case with geometry `file` in `folder`, a rock of density 1 and the given mesh.
fn check(folder: &Path, file: &str, snap_tolerance: f64, mesh: &str) -> Check {
    let text = format!(
        r#"
title = "shared data"
[domain]
geometry_file = "{file}"
joint_law = "joint"
snap_tolerance = {snap_tolerance:?}
[mesh]
{mesh}
[rock.any]
density = 1
young = 1e9
poisson = 0.25
[joint_law.joint]
friction_deg = 30
[[stage]]
name = "any"
kind = "static"
duration = 1
"#
    );
    let loaded = enmm_io::parse_case(&text, "shared.toml", folder).unwrap_or_else(|e| panic!("{file}: {e}"));
    let simulation = Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{file}: {e}"));
    enmm_run::check(&simulation, &loaded.warnings)
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Areas and masses are given with nine digits; the noder moves points by at most the snap tolerance of 1e-6 m.
fn near(found: f64, expected: f64, scale: f64) -> bool {
    (found - expected).abs() <= 1e-8 * scale + 1e-8 * expected.abs()
}

fn assert_near(what: &str, found: &[f64], expected: &Value, scale: f64) {
    let expected: Vec<f64> = expected.as_array().expect("a list").iter().map(number).collect();
    assert_eq!(found.len(), expected.len(), "{what}");
    for (k, (&a, &b)) in found.iter().zip(&expected).enumerate() {
        assert!(near(a, b, scale), "{what}[{k}]: {a:e}, expected {b:e}");
    }
}

#[test]
fn cover_cases_are_counted_as_expected() {
    let Some(data) = shared() else { return };
    let folder = data.join("cover_cases");
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(&folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    assert!(!files.is_empty());
    for path in files {
        let case = read(&path);
        let (mesh, expected) = (&case["mesh"], &case["expected"]);
        let name = path.file_name().expect("a name").to_str().expect("UTF-8");
        let origin = [number(&mesh["origin"][0]), number(&mesh["origin"][1])];
        let lattice = format!(
            "size = {:?}\nangle_deg = {:?}\norigin = {origin:?}",
            number(&mesh["h"]),
            number(&mesh["angle_deg"])
        );
        let found = check(&folder, name, number(&case["snap_tol"]), &lattice);
        let counts = [found.elements, found.physical_covers, found.stars, found.blocks].map(|n| n as u64);
        let wanted = ["n_elements", "n_pcs", "n_stars", "n_blocks"].map(|key| expected[key].as_u64().expect(key));
        assert_eq!(counts, wanted, "{name}: elements, covers, stars, blocks");
        let stars = serde_json::to_value(&found.stars_by_cover_count).expect("a map");
        assert_eq!(stars, expected["stars_by_pc_count"], "{name}");
        let area = number(&expected["total_area"]);
        assert!(near(found.total_area, area, area), "{name}");
        assert_near(name, &found.block_areas, &expected["block_areas_sorted"], area);
        assert_near(name, &found.cover_masses, &expected["pc_mass_sorted"], 1.0);
    }
}

#[test]
fn traces_and_slopes_give_the_blocks_on_which_noders_agree() {
    let Some(data) = shared() else { return };
    let expected = read(&data.join("EXPECTED.json"));
    for (file, wanted) in expected.as_object().expect("an object") {
        let (blocks, area) = (wanted["blocks"].as_u64().expect("a count"), number(&wanted["total_area"]));
        let size = (area / 2000.0).sqrt();
        let found = check(&data, file, number(&wanted["snap_tol"]), &format!("size = {size:?}\nangle_deg = 7.0"));
        assert_eq!(found.blocks as u64, blocks, "{file}");
        assert!((found.total_area - area).abs() < 1e-6 * area, "{file}: {} of {area}", found.total_area);
        let mass: f64 = found.cover_masses.iter().sum();
        assert!((mass - area).abs() < 1e-9 * area, "{file}: masses sum to {mass}, the area is {area}");
        assert_eq!(found.block_areas.len(), found.blocks);
    }
}
