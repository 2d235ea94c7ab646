//! A corner that stands on an inner node of another face once had its length or nothing of it, as it stood a hair to
//! one side or the other: the stiffness of the joint flipped from step to step and fed the block with energy.

use crate::common::{run_stage, simulation};

/// A block on a joint of its own stiffness; the mesh puts a node of the ground under the block's corner.
const CASE: &str = "title = \"rest\"\n[domain]\n\
     outline = [[-3, -2], [5, -2], [5, 0], [2, 0], [2, 0.5], [0, 0.5], [0, 0], [-3, 0]]\n\
     [mesh]\nsize = 0.25\norigin = [0.05, 0.02]\n[[joint]]\npoints = [[0, 0], [2, 0]]\n\
     [joint_law.j]\nfriction_deg = 35\nnormal_stiffness = 10e9\nshear_stiffness = 5e9\n\
     [rock.r]\ndensity = 2700\nyoung = 30e9\npoisson = 0.25\n[[fix]]\nblock = [-1, -1]\n\
     [[stage]]\nname = \"settle\"\nkind = \"static\"\nduration = 0.6\nconvergence = 1e-6\n";

/// The joint takes a part of its weight's work, ½·W·u a time per metre, and never gives any.
#[test]
fn a_block_on_a_joint_comes_to_rest_and_gains_nothing() {
    let mut simulation = simulation(CASE);
    let report = run_stage(&mut simulation);
    assert!(simulation.at_rest(&report), "unbalanced {}", report.unbalanced);
    assert!(report.ledger.contact_dissipation() >= 0.0, "{:?}", report.ledger);
    let lengths: f64 = simulation.contacts().iter().map(|contact| contact.length).sum();
    assert!((lengths - 2.0).abs() < 1e-3, "the contacts share the length of the face twice halved: {lengths}");
}
