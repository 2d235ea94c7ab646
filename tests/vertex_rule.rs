//! Claim: the lanes that go ahead of the vertex rule leave out nothing that the rule accepts. In a step that finds all
//! contacts, these are what the rule accepts of all near sides; it is applied one node at a time, without the lanes.

use std::path::Path;

use enmm::internals::contact::{ContactCandidate, VertexRule, prefiltered};
use enmm::model::Simulation;

use crate::common::extent::by_extent;
use crate::common::{root, step, without_found};

/// Near sides of a step, how many of them the lanes leave, and how many contacts there are.
type Counts = [usize; 3];

/// Applies the rule to the near sides of the next step, which finds all contacts, and compares.
fn compare(simulation: &Simulation, case: &str) -> Counts {
    let (model, (state, workspace)) = (simulation.model(), without_found(simulation).look_ahead());
    let (size, constants) = (model.covers.mesh.size, model.detection);
    let dt = state.rest_of_step(model);
    let rule = VertexRule {
        boundary: &model.boundary,
        frames: &workspace.frames,
        history: &state.contacts,
        cache: &workspace.selection.cache,
        penetrating: &workspace.selection.penetrating,
        size,
        constants,
        flush_cosine: constants.flush_cosine(),
        reach: constants.reach * size + constants.reach_steps * dt * workspace.motion.speed_max,
    };
    let (pairs, near_sides) = (&state.neighbours.pairs, &workspace.selection.near_sides);
    let nearest = |k: usize| -> ContactCandidate {
        let pairs = near_sides.pairs_of(pairs, k);
        let key = (pairs[0].node, pairs[0].side);
        let known = state.contacts.binary_search_by_key(&key, |contact| (contact.node, contact.side));
        let candidates = pairs.iter().map(|pair| rule.candidate(pair, k as u32, known.ok().map(|known| known as u32)));
        candidates.reduce(|best, other| if other.distance() < best.distance() { other } else { best }).unwrap()
    };
    let all: Vec<ContactCandidate> = (0..near_sides.as_slice().len()).map(nearest).collect();
    let left = prefiltered(&rule, near_sides);
    assert_eq!(left.len(), all.len(), "{case}");
    for (candidate, left) in all.iter().zip(&left) {
        assert!(*left || rule.admit(*candidate).is_none(), "{case}: left out {candidate:?}");
    }
    let mut contacts = workspace.contacts.iter().map(|contact| contact.history);
    let (mut entered, mut buffer) = (Vec::new(), Vec::new());
    for sides in all.chunk_by(|a, b| a.node == b.node) {
        rule.enter(sides.iter().copied(), || sides.iter().copied(), &mut entered, &mut buffer);
        for side in &entered {
            let found = contacts.next().map(|contact| (contact.node, contact.side, contact.edge));
            assert_eq!(found, Some((side.node, side.side, side.edge)), "{case}: {side:?}");
        }
    }
    assert!(contacts.next().is_none(), "{case}: contacts that the rule does not accept");
    [all.len(), left.iter().filter(|left| **left).count(), workspace.contacts.len()]
}

/// The first steps of all stages of a case; returns the sums of counts.
fn follow(path: &Path) -> Counts {
    let name = path.display().to_string();
    let loaded = enmm_io::load_case(path).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(loaded.case).unwrap_or_else(|e| panic!("{name}: {e}"));
    let mut sums = [0; 3];
    loop {
        for steps in by_extent([&[0, 1, 30, 50][..], &[0, 1, 30, 50], &[0, 1, 30, 50, 500, 5000, 5000]]) {
            for _ in 0..*steps {
                simulation.advance(false).unwrap_or_else(|e| panic!("{name}: {e}"));
            }
            let counts = compare(&simulation, &name);
            sums = [0, 1, 2].map(|k| sums[k] + counts[k]);
        }
        if !simulation.next_stage().unwrap_or_else(|e| panic!("{name}: {e}")) {
            return sums;
        }
    }
}

#[test]
fn contacts_are_those_that_the_rule_accepts_of_all_near_sides() {
    let folder = std::fs::read_dir(root().join("examples/cases")).expect("the example cases");
    let mut cases: Vec<_> = folder.map(|entry| entry.expect("an entry").path()).collect();
    cases.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    cases.sort();
    let mut sums = [0; 3];
    for case in &cases {
        let counts = follow(case);
        println!("{}: near sides, left by lanes, contacts: {counts:?}", case.display());
        sums = [0, 1, 2].map(|k| sums[k] + counts[k]);
    }
    let [near, left, contacts] = sums;
    assert!(cases.len() > 10 && contacts > 10_000, "{} cases, {contacts} contacts", cases.len());
    assert!(left < near && left > contacts, "of {near} near sides {left} are left, and {contacts} are contacts");
}

/// Tips of two blocks that fall on each other, boundaries that turn, and cuts in one block are not in the examples.
#[test]
fn corners_that_meet_are_decided_by_the_rule_alone() {
    let mut simulation = crate::common::simulation(
        "title = \"tips\"\n[domain]\noutline = [[0, -1], [12, -1], [12, 0], [0, 0]]\n\
         islands = [[[4, 0.001], [5, 1], [4, 2], [3, 1]], [[4.02, 2.01], [5.02, 3], [4.02, 4], [3.02, 3]]]\n\
         [mesh]\nsize = 1.0\norigin = [0.137, 0.071]\n[[joint]]\npoints = [[5.0, 0.0], [4.7, -0.6]]\n\
         [rock.rock]\nyoung = 1e9\npoisson = 0.25\ndensity = 2500\n[joint_law.joint]\nfriction_deg = 20\n\
         [[fix]]\nblock = [0.1, -0.9]\n[[stage]]\nname = \"fall\"\nkind = \"dynamic\"\nduration = 2.0\n",
    );
    while !simulation.stage_is_over(None) {
        compare(&simulation, "tips");
        step(&mut simulation, 5);
    }
}
