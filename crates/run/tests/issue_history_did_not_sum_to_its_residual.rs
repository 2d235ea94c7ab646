//! `history.csv` once lacked the terms of yielding, bolts, quiet boundaries and the start, so that its columns did not
//! sum to `energy_residual`, and nobody could see which of them was wrong.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use enmm::model::{BALANCE, ENERGIES};
use enmm_io::parse_case;
use enmm_run::{RunOptions, RunStatus};

/// Weak rock on a quiet base slips on a joint that a bolt holds, under a pressure on its top: every term is there.
const CASE: &str = r#"
title = "all terms"
domain.outline = [[0, 0], [4, 0], [4, 2], [0, 2]]
mesh = { size = 0.6, origin = [0.031, 0.017] }
rock.rock = { density = 2500, young = 1e8, poisson = 0.25, cohesion = 5e3, friction_deg = 20, dilation_deg = 20 }
joint_law.joint.friction_deg = 5
joint = [{ points = [[-1, 1.5], [5, 0.6]] }]
bolt = [{ points = [[2.0, 1.9], [2.1, 0.3]], young = 2e11, area = 1e-3, pretension = 2e4, yield_force = 4e4 }]
quiet = [{ edge = [[0, 0], [4, 0]] }]
load = [{ kind = "pressure", edge = [[0, 2], [4, 2]], pressure = 3e4 }]
initial_velocity = [{ block = [2, 1.8], velocity = [1.0, 0.0] }]
stage = [{ name = "slide", kind = "dynamic", duration = 0.1, damping = 0.05 }]
output = { frames = false, pictures = false, history_interval = 0.01 }
"#;

/// Rows of `history.csv` by the names of its columns.
fn rows(path: &Path) -> Vec<BTreeMap<String, f64>> {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{error}"));
    let mut lines = text.lines();
    let name = |head: &str| head.split(" [").next().unwrap_or(head).to_owned();
    let names: Vec<String> = lines.next().expect("a head").split(',').map(name).collect();
    let row = |line: &str| names.iter().cloned().zip(line.split(',').map(|value| value.parse().unwrap())).collect();
    lines.map(row).collect()
}

#[test]
fn columns_of_the_history_sum_to_its_residual() {
    let directory = tempfile::tempdir().unwrap();
    let loaded = parse_case(CASE, "terms.toml", Path::new(".")).unwrap_or_else(|error| panic!("{error}"));
    let options = RunOptions { directory: directory.path().to_owned(), ..RunOptions::default() };
    let summary = enmm_run::run(&loaded, &options, &mut ()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(summary.status, RunStatus::Finished, "{:?}", summary.failure);
    let rows = rows(&directory.path().join("history.csv"));
    assert!(rows.len() > 9);
    let column = |name: &str| ENERGIES.iter().find(|energy| energy.name == name).map(|energy| energy.column);
    let terms: Vec<(&str, f64)> = BALANCE.iter().map(|(name, sign)| (column(name).expect("a row"), *sign)).collect();
    for row in &rows {
        let sum: f64 = terms.iter().map(|(name, sign)| sign * row[*name]).sum();
        let largest = terms.iter().map(|(name, _)| row[*name].abs()).fold(0.0, f64::max);
        // Ten additions in another order than that of the ledger.
        assert!((sum - row["energy_residual"]).abs() <= 1e-14 * largest, "{row:?}");
        let springs = row["stored_energy"] + row["friction_heat"] + row["contact_dissipation"];
        let largest = largest.max(row["stored_energy"].abs()).max(row["friction_heat"].abs());
        assert!((springs + row["contact_work"] + row["support_work"]).abs() <= 1e-14 * largest, "{row:?}");
    }
    let last = rows.last().expect("a row");
    for (name, _) in terms.iter().filter(|(name, _)| *name != "support_work") {
        assert!(last[*name] != 0.0, "{name} is not tried: {last:?}");
    }
}
