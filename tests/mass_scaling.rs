//! Claim: a static stage with lighter free blocks reaches the same state of rest in fewer steps, its ledger closes, and
//! the stage after it has the masses of the rock.

use crate::common::claims::assert_ledger;
use crate::common::{run_stage, simulation};
use enmm::geometry::Vector;
use enmm::model::Simulation;
use enmm::model::tables::BlockId;

const WALL: &str = include_str!("../examples/cases/masonry_wall.toml");

fn settled(scaling: f64) -> Simulation {
    let text = format!("{WALL}\n[solver]\nmass_scaling = {scaling:.1}\n");
    let mut simulation = simulation(&text);
    let report = run_stage(&mut simulation);
    assert!(simulation.at_rest(&report), "{scaling}");
    assert_ledger(&report);
    simulation
}

/// Weights are those of the rock, so that the wall settles by the same way: within 1e-3 of it, a tenth of what friction
/// leaves open by the path of loading (the unbalanced ratio of 1e-6 would allow 1e-6 without friction).
#[test]
fn lighter_blocks_settle_to_the_same_place_in_fewer_steps() {
    let [heavy, mut light] = [1.0, 4.0].map(settled);
    let square = |field: &mut dyn Iterator<Item = Vector>| field.map(|v| v.norm_squared()).sum::<f64>();
    let [own, other] = [&heavy, &light].map(|simulation| &simulation.state().displacement);
    let apart = square(&mut own.iter().zip(other).map(|(a, b)| a - b)) / square(&mut own.iter().copied());
    assert!(apart.sqrt() < 1e-3, "{apart}");
    let [long, short] = [&heavy, &light].map(|simulation| simulation.state().step);
    assert!(10 * short < 6 * long, "{short} of {long} steps");
    assert!(light.next_stage().unwrap());
    let (own, rock) = (&light.workspace().mass_matrix, &light.model().mass_matrix);
    assert_eq!((own.lightness, rock.lightness), (1.0, 1.0));
    let free = BlockId::all(rock.polar.len()).filter(|&b| own.is_free(b));
    assert!(free.clone().count() > 1);
    free.for_each(|b| assert_eq!((own.polar[b], own.square[b]), (rock.polar[b], rock.square[b])));
}
