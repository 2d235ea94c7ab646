//! The table of forces along bars that slip: a row for each segment, with the numbers of the state.

use std::path::Path;

use enmm::model::Simulation;
use enmm_record::along::{has_bonds, write_along};

const TEXT: &str = r#"
title = "pull"
[domain]
outline = [[-4, 0], [1, 0], [1, 1], [-4, 1]]
[mesh]
size = 0.5
[[joint]]
points = [[0, -1], [0, 2]]
[joint_law.joint]
friction_deg = 0.0
[gravity]
y = 0
[rock.rock]
density = 2500
young = 1e10
poisson = 0.2
[[fix]]
block = [-2, 0.5]
[[load]]
kind = "block"
point = [0.5, 0.5]
force = [40e3, 0]
[[bolt]]
name = "bar"
points = [[1, 0.5], [-3.5, 0.5]]
anchorage = "grouted"
plate = true
young = 200e9
area = 5e-4
spacing = 2.0
bond = 200e3
bond_stiffness = 400e6
[[stage]]
name = "pull"
kind = "static"
duration = 5.0
"#;

#[test]
fn the_table_has_a_row_for_each_segment() {
    let case = enmm_io::parse_case(TEXT, "case.toml", Path::new(".")).unwrap_or_else(|e| panic!("{e}")).case;
    let mut simulation = Simulation::new(case).unwrap_or_else(|e| panic!("{e}"));
    simulation.run_stage().unwrap_or_else(|e| panic!("{e}"));
    assert!(has_bonds(&simulation));
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bolts_along.csv");
    write_along(&path, &simulation).unwrap_or_else(|e| panic!("{e}"));
    let text = std::fs::read_to_string(&path).expect("a table");
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0].join(","), "bolt,name,along [m],x [m],y [m],tension [N],slip [m],state");
    let bars = &simulation.state().bolts;
    assert_eq!(rows.len(), 1 + bars.len());
    let number = |row: &[&str], k: usize| row[k].parse::<f64>().expect("a number");
    let mut most = 0.0f64;
    for (row, bar) in rows[1..].iter().zip(bars) {
        assert_eq!((row[0], row[1], row[7]), ("0", "bar", "whole"));
        assert!((number(row, 3) - (1.0 - number(row, 2))).abs() < 1e-12, "{row:?}");
        assert_eq!(number(row, 5), 2.0 * bar.force);
        most = most.max(number(row, 5));
    }
    // 40 kN per metre pull on bars 2 m apart, and the joint is passed by all of it; points beside it see a little less.
    assert!((60e3..=80.1e3).contains(&most), "{most}");
}
