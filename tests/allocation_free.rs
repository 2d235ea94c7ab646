//! Claim: a step allocates nothing once its buffers have grown, neither under gravity nor in a failure that searches.

use crate::common::{example, simulation};
use allocation_counter::measure;
use enmm::model::Simulation;

use crate::common::extent::by_extent;

/// Steps that are counted.
const COUNTED: usize = 100;

/// Counts allocations after `warm` steps in which the buffers grow; returns the searches of the steps that counted.
fn count(simulation: &mut Simulation, warm: usize) -> u64 {
    let mut advance = |steps: usize| {
        for _ in 0..steps {
            simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        }
        simulation.state().counters.searches
    };
    let before = advance(warm);
    let mut after = before;
    let found = measure(|| after = advance(COUNTED));
    assert_eq!(found.count_total, 0, "{found:?}");
    after - before
}

#[test]
fn long_steps_of_a_failing_slope_allocate_nothing() {
    let mut simulation = simulation(&example("fractured_slope"));
    simulation.set_serial(true);
    count(&mut simulation, 400);
    simulation.next_stage().unwrap_or_else(|e| panic!("{e}"));
    assert!(count(&mut simulation, by_extent([800, 800, 3000])) > 0, "no search was counted");
}
