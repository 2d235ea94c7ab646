//! Claims about real traces, real slopes and cover cases: `enmm check` counts blocks, elements, covers and masses as
//! independent programs do, and a gravity stage over them does not blow up.
//!
//! The data stay outside the repository. Without them the tests are counted as ignored, which a test function cannot do
//! for itself; so this file has a harness of its own.

#[path = "../../../tests/common/extent.rs"]
mod extent;
#[path = "../../../tests/common/shared.rs"]
mod shared;

use std::path::{Path, PathBuf};

use enmm::model::Simulation;
use enmm_run::check::Check;
use extent::by_extent;
use libtest_mimic::{Arguments, Trial};
use serde_json::Value;

fn read(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).expect("readable")).expect("valid JSON")
}

/// Checks the case, as it is drawn, with geometry `file` in `folder`, a rock of density 1 and the given mesh.
fn check(folder: &Path, file: &str, snap_tolerance: f64, mesh: &str) -> Check {
    let text = format!(
        r#"
title = "shared data"
domain = {{ geometry_file = "{file}", joint_law = "joint", snap_tolerance = {snap_tolerance:?}, extend_ends = 0 }}
rock.any = {{ density = 1, young = 1e9, poisson = 0.25 }}
joint_law.joint.friction_deg = 30
stage = [{{ name = "any", kind = "static", duration = 1 }}]
[mesh]
least_block = 0
{mesh}
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

fn cover_cases_are_counted_as_expected(data: &Path) {
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

fn traces_and_slopes_give_the_blocks_on_which_noders_agree(data: &Path) {
    let expected = read(&data.join("EXPECTED.json"));
    for (file, wanted) in expected.as_object().expect("an object") {
        let (blocks, area) = (wanted["blocks"].as_u64().expect("a count"), number(&wanted["total_area"]));
        let size = (area / 2000.0).sqrt();
        let found = check(data, file, number(&wanted["snap_tol"]), &format!("size = {size:?}\nangle_deg = 7.0"));
        assert_eq!(found.blocks as u64, blocks, "{file}");
        assert!((found.total_area - area).abs() < 1e-6 * area, "{file}: {} of {area}", found.total_area);
        let mass: f64 = found.cover_masses.iter().sum();
        assert!((mass - area).abs() < 1e-9 * area, "{file}: masses sum to {mass}, the area is {area}");
        assert_eq!(found.block_areas.len(), found.blocks);
    }
}

/// The same ends are joined, and all blocks above twice one least area (m²) are as many, on every mesh.
fn the_mesh_changes_neither_ends_nor_blocks(data: &Path) {
    let maps: [(&str, [f64; 3]); 5] = [
        ("traces/kb7", [1.0, 2.0, 5.0]),
        ("traces/kb11", [1.0, 2.0, 5.0]),
        ("traces/getaberget_20m_1_1", [1.0, 2.0, 18.0]),
        ("slopes/tyrol_gar_slope_small", [5.0, 8.0, 20.0]),
        ("slopes/tyrol_gar_slope_medium", [5.0, 8.0, 20.0]),
    ];
    for (name, sizes) in maps {
        let least = (sizes[0] / 20.0).powi(2);
        let found = sizes.map(|size| {
            let text =
                case(&format!("{name}.json"), size, 0.0, 30.0).replace("[[fix]]\nbox = [-1000, -1000, 1000, 0]\n", "");
            let text = text.replacen("[rock.rock]", &format!("least_block = {least}\n[rock.rock]"), 1);
            let loaded = enmm_io::parse_case(&text, "real.toml", data).unwrap_or_else(|e| panic!("{name}: {e}"));
            let simulation = Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{name}, {size} m: {e:?}"));
            let covers = &simulation.model().covers;
            let blocks = covers.blocks().filter(|&block| covers.block_area(block) > 2.0 * least).count();
            (blocks, simulation.built().ends.clone())
        });
        println!("{name}: {} blocks, {} ends", found[0].0, found[0].1.len());
        assert_eq!(found[0].0, found[1].0, "{name}: blocks on {sizes:?} m");
        assert_eq!(found[0].0, found[2].0, "{name}: blocks on {sizes:?} m");
        assert!(found[1].1 == found[0].1 && found[2].1 == found[0].1, "{name}: ends on {sizes:?} m");
    }
}

fn geometry_is_read_whole(data: &Path) {
    for (name, traces) in [("traces/kb7", 240), ("traces/kb11", 707), ("slopes/tyrol_gar_slope_medium", 568)] {
        let text = case(&format!("{name}.json"), 1.0, 0.0, 30.0);
        let loaded = enmm_io::parse_case(&text, "real.toml", data).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(loaded.case.joints.len(), traces);
    }
    assert!(enmm_io::load_case(&data.join("EXPECTED.json")).is_err());
}

/// A gravity stage over a geometry file, its lowest part held, on a mesh of `size` (m).
fn case(file: &str, size: f64, held_below: f64, friction: f64) -> String {
    format!(
        "title = \"real\"\n[domain]\ngeometry_file = \"{file}\"\nsnap_tolerance = 1e-6\njoint_law = \"joint\"\n\
         [mesh]\nsize = {size}\n[rock.rock]\ndensity = 2600\nyoung = 10e9\npoisson = 0.25\n\
         [joint_law.joint]\nfriction_deg = {friction}\n[[fix]]\nbox = [-1000, -1000, 1000, {held_below}]\n\
         [[stage]]\nname = \"gravity\"\nkind = \"static\"\nduration = 3.0\nconvergence = 1e-3\n"
    )
}

/// Settles for at most `steps` steps; energy must not appear and nothing may run away.
fn settles(data: &Path, file: &str, size: f64, held_below: f64, friction: f64, steps: u64) {
    let loaded = enmm_io::parse_case(&case(file, size, held_below, friction), "real.toml", data)
        .unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{e}"));
    let mut last = None;
    while !simulation.stage_is_over(last.as_ref()) && simulation.state().step < steps {
        let report = simulation.advance(true).unwrap_or_else(|e| panic!("{file}: {e}"));
        last = Some(report);
    }
    let report = last.expect("a report");
    let counters = simulation.state().counters;
    println!("{file}: {report:?} {counters:?}");
    // The ledger to 1e-3 of its largest term (theory §11); 1 % of the mesh size for penetrations under gravity.
    assert!(report.ledger.residual().abs() <= 1e-3 * report.ledger.largest(), "{:?}", report.ledger);
    assert!(counters.penetration_max < 0.01 * size, "penetration {}", counters.penetration_max);
}

fn long_kb11_settles_under_gravity(data: &Path) {
    settles(data, "traces/kb11.json", 1.0, -16.0, 40.0, by_extent([150, 1000, 3000]));
}

fn long_tyrol_gar_slope_medium_settles_under_gravity(data: &Path) {
    settles(data, "slopes/tyrol_gar_slope_medium.json", 8.0, -25.0, 45.0, by_extent([50, 400, 1300]));
}

fn main() {
    let data = shared::shared();
    let trial = |name: &str, claim: fn(&Path)| {
        let folder = data.clone().unwrap_or_default();
        let act = move || {
            claim(&folder);
            Ok(())
        };
        Trial::test(name, act).with_ignored_flag(data.is_none())
    };
    let trials = vec![
        trial("geometry_is_read_whole", geometry_is_read_whole),
        trial("cover_cases_are_counted_as_expected", cover_cases_are_counted_as_expected),
        trial("traces_and_slopes_give_the_expected_blocks", traces_and_slopes_give_the_blocks_on_which_noders_agree),
        trial("the_mesh_changes_neither_ends_nor_blocks", the_mesh_changes_neither_ends_nor_blocks),
        trial("long_kb11_settles_under_gravity", long_kb11_settles_under_gravity),
        trial("long_tyrol_gar_slope_medium_settles_under_gravity", long_tyrol_gar_slope_medium_settles_under_gravity),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
