//! Two blocks passed into each other by a sixth of the mesh size without force, and nothing told of it: penetration is
//! that of contacts, and the pair had none. The audit compares polygons, and the overlap is an event.

use crate::common::simulation;
use enmm::geometry::Vector;
use enmm::model::overlap::EVERY;
use enmm::model::tables::DetectionRule;
use enmm::model::{Event, EventKind, Simulation};

/// Two squares of 2 m side by side, 1 cm apart.
fn squares() -> Simulation {
    let text = "title = \"t\"\n[domain]\noutline = [[0, 0], [2, 0], [2, 2], [0, 2]]\n\
                islands = [[[2.01, 0], [4.01, 0], [4.01, 2], [2.01, 2]]]\n[mesh]\nsize = 1.0\n\
                [rock.granite]\ndensity = 2650\nyoung = 50e9\npoisson = 0.25\n[joint_law.j]\nfriction_deg = 30\n\
                [[fix]]\nedge = [[0, 0], [2, 0]]\n[[stage]]\nname = \"fall\"\nkind = \"dynamic\"\nduration = 1\n";
    simulation(text)
}

/// Overlaps (m) that the audit of the next step finds, with the right square put so deep (m) into the left one, and
/// raised (m).
fn overlaps(mut simulation: Simulation, depth: f64, raised: f64) -> Vec<Event> {
    for _ in 0..EVERY {
        simulation.advance(false).expect("a step");
    }
    assert!(simulation.state().events.overlapped.is_empty());
    let mut state = simulation.state().clone();
    let block = simulation.model().covers.blocks().find(|&b| simulation.model().covers.block_centroid(b).x > 2.0);
    for i in simulation.model().covers.covers_of(block.expect("an island")) {
        state.displacement[i] += Vector::new(-0.01 - depth, raised);
    }
    simulation.return_to(&state);
    simulation.advance(false).expect("a step");
    let events = &simulation.state().events;
    let found: Vec<_> = events.list.iter().filter(|event| event.kind == EventKind::Overlapped).copied().collect();
    assert_eq!(events.overlapped.len(), found.len());
    assert_eq!(events.overlap_max, found.iter().map(|event| event.depth).fold(0.0, f64::max));
    found
}

#[test]
fn a_block_in_another_is_seen_without_any_contact() {
    let found = overlaps(squares(), 0.04, 0.3);
    let [overlap] = found[..] else { panic!("{found:?}") };
    assert!((overlap.depth - 0.04).abs() < 1e-3, "{overlap:?}");
    assert_eq!([overlap.subject, overlap.other], [0, 1]);
}

/// Less than 1 % of the mesh size, with a contact that starts without force since it is first seen as deep, and with
/// constants for which there is no contact at all. The square has fallen by 5e-7 m meanwhile.
#[test]
fn a_block_is_seen_in_another_where_no_spring_holds_it() {
    let plain = DetectionRule::default();
    let none = DetectionRule { flush_sine: 1e-9, opposed_cosine: 1.0, ..plain };
    for rule in [plain, none] {
        for (depth, count) in [(0.0015, 0), (0.004, 1), (0.008, 1)] {
            let found = overlaps(squares().with_detection(rule), depth, 1.9);
            assert_eq!(found.len(), count, "{rule:?}, {depth} m: {found:?}");
            assert!(found.iter().all(|overlap| (overlap.depth - depth).abs() < 1e-6), "{found:?}");
        }
    }
}
