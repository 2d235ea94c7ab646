//! Claim: the fractured slope of the README rests, then fails, without energy from nowhere or blocks in each other.

mod common;

use std::path::Path;

use common::overlap::Audit;
use common::run_stage;
use enmm::model::Simulation;

#[test]
fn the_fractured_slope_rests_and_then_fails() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/cases/fractured_slope.toml");
    let case = enmm::io::load_case(&path).unwrap_or_else(|e| panic!("{e}")).case;
    let size = case.mesh.size;
    let mut simulation = Simulation::new(case).unwrap_or_else(|e| panic!("{e}"));
    assert!(simulation.slope().covers.block_count() >= 400);

    // At rest: kinetic energy below 1e-6 of the potential energy that settling has released.
    let rest = run_stage(&mut simulation);
    println!("{rest:?}");
    assert!(simulation.at_rest(&rest));
    assert!(rest.ledger.kinetic < 1e-6 * rest.ledger.potential.abs(), "{:?}", rest.ledger);
    assert!(rest.ledger.residual().abs() < 1e-3 * rest.ledger.largest(), "{:?}", rest.ledger);

    simulation.next_stage().unwrap_or_else(|e| panic!("{e}"));
    let overlaps = Audit::new(&simulation);
    let (mut worst, mut k, mut heat) = (Default::default(), 0u64, rest.ledger.friction);
    while !simulation.stage_is_over(None) {
        let audit = k.is_multiple_of(25);
        let report = simulation.advance(audit).unwrap_or_else(|e| panic!("{e}"));
        if audit {
            let overlap = overlaps.deepest(&simulation);
            worst = if overlap.depth > f64::max(worst, 0.0) { overlap.depth } else { worst };
            assert!(report.ledger.residual().abs() < 1e-3 * report.ledger.largest(), "{:?}", report.ledger);
            // Friction only ever turns energy into heat, up to what its springs give back.
            assert!(report.ledger.friction > heat - 1e-3 * report.ledger.largest(), "{:?}", report.ledger);
            heat = heat.max(report.ledger.friction);
        }
        if k.is_multiple_of(250) {
            println!("t {:.3} overlap so far {:.2e} {:?}", simulation.time(), worst, simulation.state().counters);
        }
        k += 1;
    }
    let counters = simulation.state().counters;
    println!("worst overlap {worst} of {size}, {counters:?}");
    assert!(simulation.monitor(0).0.norm() > 2.0, "the crest must move");
    // A block of M = 6e4 kg/m that comes down at 5 m/s sinks v·√(M/k) = 0.03 m into the springs of a metre of its face.
    assert!(worst < 0.015 * size, "overlap {worst} m");
    assert!((counters.unsettled as f64) < 1e-3 * counters.substeps as f64, "{counters:?}");
}
