//! Claim: snapshots show the blocks that are there, at the places and with the areas that their states have.

use enmm::geometry::polygon;
use enmm::model::Simulation;
use enmm_observe::Snapshot;

use crate::rest::{FLIGHT, rest};

/// A block of 1 m × 1 m on a held base of 6 m × 1 m, after all stages.
fn run(stage: &str, more: &str) -> Simulation {
    let loaded = enmm_io::parse_case(&rest(stage, more), "case", "".as_ref()).expect("a case");
    let mut simulation = Simulation::new(loaded.case).expect("a model");
    simulation.run_stage().expect("no failure");
    simulation
}

fn area(snapshot: &Snapshot) -> f64 {
    (0..snapshot.elements.len()).map(|k| polygon::area(snapshot.elements.get(k))).sum()
}

#[test]
fn snapshots_show_blocks_where_their_states_have_them() {
    let simulation = run("kind = \"dynamic\"\nduration = 0.8\ndamping = 0", FLIGHT);
    let (snapshot, blocks) = (Snapshot::of(&simulation), simulation.block_states());
    // The block stretches by ρω²L²/E ~ 1e-6 as it spins.
    assert!((area(&snapshot) - 7.0).abs() < 1e-6, "{}", area(&snapshot));
    for boundary in &snapshot.boundaries {
        let area: f64 = (0..boundary.loops.len()).map(|k| polygon::area(boundary.loops.get(k))).sum();
        let own = &blocks[boundary.block as usize];
        assert!((area - own.area).abs() < 1e-6 && boundary.fixed == own.fixed);
        assert!((boundary.displacement - own.displacement).norm() < 1e-14);
    }
}

#[test]
fn excavated_blocks_are_left_out_of_snapshots() {
    let simulation = run("kind = \"dynamic\"\nduration = 0.01\nexcavate = [[1.5, 1.5]]", "");
    let snapshot = Snapshot::of(&simulation);
    assert_eq!(snapshot.boundaries.len(), 1);
    assert!((area(&snapshot) - 6.0).abs() < 1e-9);
}

#[test]
fn a_snapshot_follows_from_the_state_alone() {
    let one = run("kind = \"static\"\nduration = 0.05", "");
    let mut other = run("kind = \"static\"\nduration = 0.01", "");
    other.restore(one.state().clone());
    assert_eq!(Snapshot::of(&one), Snapshot::of(&other));
}
