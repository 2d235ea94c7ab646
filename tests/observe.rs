//! Claim: block states show the motion, stress and contact forces that the state holds.

use crate::common::rest::{FLIGHT, rest};
use crate::common::{run_all, simulation};
use enmm::geometry::Vector;
use enmm::model::ContactState;

#[test]
fn a_resting_block_bears_its_weight_by_stress_and_contact() {
    let mut simulation = simulation(&rest("kind = \"static\"\nduration = 2\nconvergence = 1e-6", ""));
    run_all(&mut simulation);
    let weight = 2600.0 * 9.81;
    let blocks = simulation.block_states();
    let (block, base) = if blocks[0].fixed { (blocks[1], blocks[0]) } else { (blocks[0], blocks[1]) };
    assert!(base.fixed && !block.fixed && !block.detached && !block.removed);
    assert!((block.mass - 2600.0).abs() < 1e-9 * 2600.0 && (block.area - 1.0).abs() < 1e-12);
    // Mean vertical stress of a body under its own weight that rests on its foot: −½·ρ·g·height. The stress is that of
    // the reference shape, which differs by the strain: 1e-5; equilibrium holds to 1e-6.
    assert!((block.mean_stress[1] + 0.5 * weight).abs() < 1e-4 * weight, "{block:?}");
    assert!(block.contacts.count >= 2 && block.contacts.count == base.contacts.count);
    let mut force = Vector::zeros();
    simulation.each_contact(|contact| {
        if contact.history.state != ContactState::Open {
            // The force on the node's side; a node of the base presses against the foot of the block, normal downwards.
            let (normal, history) = (contact.normal, &contact.history);
            let on_node = normal * history.normal_force + contact.tangent() * history.shear_force;
            force += if normal.y > 0.0 { on_node } else { -on_node };
        }
    });
    assert!((force.y - weight).abs() < 1e-4 * weight && force.x.abs() < 1e-4 * weight, "{force:?}");
}

#[test]
fn a_free_block_turns_and_moves_as_its_state_says() {
    let mut simulation = simulation(&rest("kind = \"dynamic\"\nduration = 0.8\ndamping = 0", FLIGHT));
    run_all(&mut simulation);
    let (time, blocks) = (simulation.time(), simulation.block_states());
    let block = blocks.iter().find(|block| !block.fixed).expect("a free block");
    // Free flight: translation and spin go on; the block stretches by ρω²L²/E ~ 1e-6, and the leapfrog places a
    // rotation by ω·dt to second order, (ω·dt)²/12 ~ 1e-8 of it.
    assert!((block.displacement - Vector::new(0.5, 2.0) * time).norm() < 1e-10, "{block:?}");
    assert!((block.rotation - 1.5 * time).abs() < 1e-6, "{block:?}");
    assert!((block.angular_velocity - 1.5).abs() < 1e-5, "{block:?}");
    let kinetic = 0.5 * 2600.0 * 4.25 + 0.5 * (2600.0 / 6.0) * 1.5 * 1.5;
    assert!((block.kinetic_energy - kinetic).abs() < 1e-5 * kinetic, "{} {kinetic}", block.kinetic_energy);
    assert!(block.detached && block.contacts.count == 0);
}

#[test]
fn excavated_blocks_are_marked_and_have_no_contacts() {
    let mut simulation = simulation(&rest("kind = \"dynamic\"\nduration = 0.01\nexcavate = [[1.5, 1.5]]", ""));
    run_all(&mut simulation);
    let blocks = simulation.block_states();
    assert_eq!(blocks.iter().filter(|block| block.removed && !block.detached).count(), 1);
    let mut contacts = 0;
    simulation.each_contact(|_| contacts += 1);
    assert!(blocks.len() == 2 && contacts == 0);
}
