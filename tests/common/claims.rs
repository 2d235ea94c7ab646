//! Helpers of tests beyond runs: case text, ledgers, motion of blocks.

use enmm::geometry::{Point, Vector};
use enmm::model::tables::BlockId;
use enmm::model::{Simulation, State, StepReport};

/// Claim A4: the energy ledger closes to 1e-3 of its largest term.
///
/// The residual of a swinging mode is ½(ω dt)² of its energy (theory Eq. 28), hence small against 1e-3 of the largest
/// term in slides, falls and damped motion.
pub fn assert_ledger(report: &StepReport) {
    let ledger = &report.ledger;
    assert!(
        ledger.residual().abs() <= 1e-3 * ledger.largest(),
        "residual {:e} of {:e}: {ledger:?}",
        ledger.residual(),
        ledger.largest()
    );
}

/// Stress xx, yy, xy of every element under the displacements of a state.
pub fn stresses(simulation: &Simulation, state: &State) -> Vec<[f64; 3]> {
    let slope = simulation.model();
    let of = |e| slope.deformation(e, &state.displacement).stress(&slope.rock_of(e).constants(), &[0.0; 3]);
    slope.covers.elements().map(of).collect()
}

/// Centroid (m), its velocity (m/s), spin (rad/s) and kinetic energy (J/m) of the block that holds a reference point.
pub fn motion(simulation: &Simulation, point: [f64; 2]) -> (Point, Vector, f64, f64) {
    let block = block_at(simulation, point);
    simulation.rigid_motion_of(block)
}

/// The block that holds a reference point.
pub fn block_at(simulation: &Simulation, point: [f64; 2]) -> BlockId {
    let covers = &simulation.model().covers;
    let element = covers.element_at(Point::from(point)).expect("rock at the point");
    covers.element_block[element]
}

/// Advances the stage in progress by a number of steps; returns the report of the last one.
pub fn advance(simulation: &mut Simulation, steps: u64) -> StepReport {
    for _ in 1..steps {
        simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
    }
    simulation.advance(true).unwrap_or_else(|e| panic!("{e}"))
}
