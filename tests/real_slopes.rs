//! Claim: real traces and a real slope profile go through a gravity stage without blowing up.

mod common;

use common::shared::shared;
use enmm::model::Simulation;

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
fn settles(file: &str, size: f64, held_below: f64, friction: f64, steps: u64) {
    let Some(data) = shared() else {
        return;
    };
    let loaded = enmm_io::parse_case(&case(file, size, held_below, friction), "real.toml", &data)
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

#[test]
fn kb11_settles_under_gravity() {
    settles("traces/kb11.json", 1.0, -16.0, 40.0, 3000);
}

#[test]
fn tyrol_gar_slope_medium_settles_under_gravity() {
    settles("slopes/tyrol_gar_slope_medium.json", 8.0, -25.0, 45.0, 1300);
}
