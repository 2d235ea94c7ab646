//! Two blocks passed into each other by a sixth of the mesh size without force, and nothing told of it: penetration is
//! that of contacts, and the pair had none. The audit compares polygons, and the overlap is an event.

use std::path::Path;

use enmm::geometry::Vector;
use enmm::model::EventKind;
use enmm::model::Simulation;
use enmm::model::overlap::EVERY;
use enmm_io::parse_case;

/// Two squares of 2 m side by side, 1 cm apart.
fn squares() -> Simulation {
    let text = "title = \"t\"\n[domain]\noutline = [[0, 0], [2, 0], [2, 2], [0, 2]]\n\
                islands = [[[2.01, 0], [4.01, 0], [4.01, 2], [2.01, 2]]]\n[mesh]\nsize = 1.0\n\
                [rock.granite]\ndensity = 2650\nyoung = 50e9\npoisson = 0.25\n[joint_law.j]\nfriction_deg = 30\n\
                [[fix]]\nedge = [[0, 0], [2, 0]]\n[[stage]]\nname = \"fall\"\nkind = \"dynamic\"\nduration = 1\n";
    let loaded = parse_case(text, "case.toml", Path::new("")).expect("reads");
    Simulation::new(loaded.case).expect("builds")
}

#[test]
fn a_block_in_another_is_seen_without_any_contact() {
    let mut simulation = squares();
    for _ in 0..EVERY {
        simulation.advance(false).expect("a step");
    }
    assert!(simulation.state().events.overlapped.is_empty());
    let mut state = simulation.state().clone();
    let block = simulation.model().covers.blocks().find(|&b| simulation.model().covers.block_centroid(b).x > 2.0);
    for i in simulation.model().covers.covers_of(block.expect("an island")) {
        state.displacement[i] += Vector::new(-0.05, 0.3);
    }
    simulation.return_to(&state);
    simulation.advance(false).expect("a step");
    let list = &simulation.state().events.list;
    let overlaps: Vec<_> = list.iter().filter(|event| event.kind == EventKind::Overlapped).collect();
    let [overlap] = overlaps[..] else { panic!("{list:?}") };
    assert!((overlap.depth - 0.04).abs() < 1e-3, "{overlap:?}");
    assert_eq!([overlap.subject, overlap.other], [0, 1]);
    assert_eq!(simulation.state().events.overlap_max, overlap.depth);
}
