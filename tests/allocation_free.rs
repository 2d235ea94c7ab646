//! Claim: a step allocates nothing once its buffers have grown, however long the slope has been sliding.

use std::path::Path;

use allocation_counter::measure;
use enmm::model::Simulation;

/// Steps that let the buffers grow, and steps that are counted.
const WARM: usize = 400;
const COUNTED: usize = 100;

#[test]
fn steps_of_a_failing_slope_allocate_nothing() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/cases/fractured_slope.toml");
    let case = enmm::io::load_case(&path).unwrap_or_else(|e| panic!("{e}")).case;
    let mut simulation = Simulation::new(case).unwrap_or_else(|e| panic!("{e}"));
    simulation.set_serial(true);
    let mut advance = |steps: usize| {
        for _ in 0..steps {
            simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
        }
        simulation.state().counters
    };
    let before = advance(WARM);
    let mut after = before;
    let found = measure(|| after = advance(COUNTED));
    println!("{found:?} in {COUNTED} steps, {} searches", after.searches - before.searches);
    assert_eq!(found.count_total, 0, "{found:?}");
}
