//! Sweeps that began with half of the last change of a force kept small blocks between others in oscillation, at
//! 2 mm/s, and every step needed some 60 sweeps: each change that turned back was foretold to go on.

use crate::common::simulation;

use crate::common::pit::PIT;

#[test]
fn blocks_between_others_rest_in_a_few_sweeps() {
    let mut simulation = simulation(PIT);
    let report = simulation.run_stage().expect("rests");
    assert!(simulation.at_rest(&report) && simulation.time() < 0.5, "{} s", simulation.time());
    assert_eq!(simulation.restless(&report), []);
    let state = simulation.state();
    let sweeps = state.counters.sweeps as f64 / state.step as f64;
    assert!(sweeps < 8.0, "{sweeps} sweeps a step");
}
