//! The unbalanced ratio is a finite number also where nothing is applied: it was force over the least number there is,
//! and `null` in `summary.json`.

use crate::common::parts::{dynamic, rock};
use crate::common::simulation;
use enmm::geometry::Vector;

#[test]
fn a_block_that_swings_without_load_is_wholly_out_of_balance_and_one_that_does_not_is_in_balance() {
    let text = format!(
        "title = \"swing\"\n[domain]\noutline = [[0, 0], [3, 0], [3, 2], [0, 2]]\n[mesh]\nsize = 1.1\n\
         [gravity]\ny = 0.0\n{}{}",
        rock(1e9, 2500.0),
        dynamic("swing", 1.0, 0.0)
    );
    let mut simulation = simulation(&text);
    assert_eq!(simulation.report().unbalanced, 0.0);
    let mut state = simulation.state().clone();
    let stretched = simulation.model().covers.star_position.iter().map(|x| Vector::new(1e-3 * x.x, 0.0));
    state.displacement = stretched.collect();
    simulation.restore(state);
    for _ in 0..3 {
        let report = simulation.advance(true).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(report.unbalanced, 1.0);
    }
}
