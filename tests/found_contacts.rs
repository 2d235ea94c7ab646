//! Claim: nodes that hardly move against the sides near them keep their contacts, which are those that a step would
//! find, up to half a ledge. What was found is part of the state: steps do not depend on when a state was saved.

use enmm::internals::contact::VertexEdge;
use enmm::model::Simulation;

use crate::common::{example, simulation, step, without_found};

/// A slope in which some blocks slide and others rest, after as many steps of its last stage.
fn slope(steps: u64) -> Simulation {
    let mut simulation = simulation(&example("toppling"));
    step(&mut simulation, steps);
    simulation
}

/// Contacts of the next step, and those that it would have if it found all of them.
fn contacts(simulation: &Simulation) -> [Vec<VertexEdge>; 2] {
    [simulation.contacts(), without_found(simulation).contacts()]
}

#[test]
fn contacts_that_stay_are_those_that_a_step_would_find() {
    let simulation = slope(205);
    assert!(simulation.state().found.kept_from(simulation.state().step, &simulation.model().detection).is_some());
    let (size, stays) = (simulation.model().covers.mesh.size, simulation.model().detection.stays);
    let [kept, all] = contacts(&simulation);
    let most = all.iter().map(|contact| contact.history.normal_force).fold(0.0, f64::max);
    let key = |contact: &VertexEdge| (contact.history.node, contact.history.side);
    let mut equal = 0;
    for contact in &kept {
        let Ok(found) = all.binary_search_by_key(&key(contact), key) else {
            assert!(contact.history.normal_force < 1e-3 * most, "the rule ends {contact:?}");
            continue;
        };
        let found = &all[found];
        equal += usize::from(contact.length.to_bits() == found.length.to_bits());
        assert!((contact.gap - found.gap).abs() < 1e-9 * size, "{contact:?} {found:?}");
        // A foot between two edges may lie on either: the node segments under them differ.
        if contact.history.edge == found.history.edge {
            assert!((contact.length - found.length).abs() < 4.0 * stays * size, "{contact:?} {found:?}");
        }
    }
    println!("{} contacts stay, {} would be found, {equal} of the same length", kept.len(), all.len());
    assert!(equal < kept.len() / 2, "{equal} of {} lengths are of this step", kept.len());
    assert!(kept.len().abs_diff(all.len()) < all.len() / 50, "{} {}", kept.len(), all.len());
}

#[test]
fn steps_do_not_depend_on_when_a_state_was_saved() {
    let mut simulation = slope(203);
    let saved = simulation.state().clone();
    step(&mut simulation, 9);
    let mut other = slope(0);
    other.restore(saved);
    step(&mut other, 9);
    assert!(simulation.state() == other.state());
}
