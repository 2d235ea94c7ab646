//! Blocks that overlap by more than 1 % of the mesh size are an event, told once for each pair, whatever the steps of
//! the host, and through saved states.

use std::path::Path;

use enmm::cosimulation::{Cosimulation, Event, EventKind};
use enmm::model::State;
use enmm::model::overlap::{DEEP, EVERY, UNHELD};
use enmm_io::{load_case, parse_case};

const SOFT: &str = "ffi/capi/tests/cases/soft.toml";
/// Mesh size of that case (m).
const SIZE: f64 = 0.5;

fn soft() -> Cosimulation {
    load_case(Path::new(SOFT)).expect("reads").cosimulation().expect("builds")
}

fn run(model: &mut Cosimulation, h: f64, end: f64) -> Vec<Event> {
    while model.time() < end {
        model.do_step(model.time(), h.min(end - model.time())).expect("a step");
    }
    model.events().filter(|event| event.kind == EventKind::Overlapped).collect()
}

/// Falls by g·t²/2 until the joint has closed by a hundredth of the mesh size, 5 mm, in 32 ms where nothing bears it
/// and a little later where the spring does; an audit comes at most [`EVERY`] steps after that.
#[test]
fn a_block_that_sinks_into_another_is_told_once() {
    let mut model = soft();
    let events = run(&mut model, 0.01, 0.2);
    let [event] = events[..] else { panic!("{events:?}") };
    assert_eq!([event.subject, event.other], [0, 1]);
    let late = EVERY as f64 * model.internal_step();
    assert!(event.time > 0.0319 && event.time < 0.036 + late, "{event:?}, {late} s");
    assert!(event.depth > 0.01 * SIZE && event.depth < 0.011 * SIZE + 0.35 * late, "{event:?}");
    let totals = model.totals();
    // Twice the closure at rest, g/ω² with ω² = 1.3e6/2650 1/s², but for what damping and the spring's hardening take.
    assert!(totals.overlap_max > event.depth && totals.overlap_max < 0.04, "{totals:?}");
    assert_eq!(totals.overlapping_pairs, 1);
    let text = event.overlap_text(SIZE);
    assert!(text.starts_with("blocks 0 and 1 overlap by ") && text.ends_with(" % of the mesh size"), "{text}");
}

/// With a joint ten times as stiff the block sinks by 2.1 mm, and twice that at first: more than a fifth of a per cent
/// of the mesh size, and less than a whole one. Its springs explain it.
#[test]
fn what_springs_hold_is_no_overlap() {
    let text = std::fs::read_to_string(SOFT).expect("reads").replace("1.3e6", "1.3e7");
    let mut model = parse_case(&text, "case.toml", Path::new("")).expect("reads").cosimulation().expect("builds");
    assert_eq!(run(&mut model, 0.01, 0.2), []);
    let totals = model.totals();
    assert!(totals.penetration_max > 2.0 * UNHELD * SIZE && totals.penetration_max < DEEP * SIZE, "{totals:?}");
    assert_eq!((totals.overlap_max, totals.overlapping_pairs), (0.0, 0));
}

#[test]
fn overlaps_are_found_at_the_same_time_whatever_the_steps_of_the_host() {
    let mut whole = soft();
    let expected = run(&mut whole, 0.2, 0.2);
    for h in [0.01, 0.2 / 7.0, 0.00123] {
        let mut model = soft();
        assert_eq!(run(&mut model, h, 0.2), expected, "{h} s");
        assert_eq!(model.totals().overlap_max, whole.totals().overlap_max, "{h} s");
    }
}

#[test]
fn a_pair_that_is_known_is_not_told_again_after_a_rollback() {
    let mut model = soft();
    assert_eq!(run(&mut model, 0.02, 0.02), []);
    let before = model.save();
    let expected = run(&mut model, 0.02, 0.1);
    let bytes = model.serialize(&model.save()).expect("bytes");
    model.restore(&before).expect("a state of this model");
    assert_eq!((run(&mut model, 0.02, 0.02), model.totals().overlapping_pairs), (vec![], 0));
    assert_eq!(run(&mut model, 0.02, 0.1), expected);
    let mut other = soft();
    let saved = other.deserialize(&bytes).expect("a state of this case");
    other.restore(&saved).expect("restores");
    assert_eq!(run(&mut other, 0.02, 0.2), expected, "told once");
}

/// The initial equilibrium comes before time 0, and a block may be in another when it ends.
#[test]
fn an_overlap_of_the_initial_equilibrium_is_an_event_before_time_0() {
    let text = std::fs::read_to_string(SOFT).expect("reads");
    let rest = "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 0.5\n[[stage]]\n";
    let loaded = parse_case(&text.replace("[[stage]]\n", rest), "case.toml", Path::new("")).expect("reads");
    let mut model = loaded.cosimulation().expect("builds");
    model.start().expect("starts");
    let events: Vec<Event> = model.events().collect();
    let [event] = events[..] else { panic!("{events:?}") };
    assert!(event.kind == EventKind::Overlapped && event.time <= 0.0, "{event:?}");
    // Static stages follow no motion: the closure at rest is 0.02 m, with hardening less.
    assert!(model.totals().overlap_max > 0.01 * SIZE, "{:?}", model.totals());
}

/// A state is changed, and refused with the name of the number that cannot be.
#[test]
fn states_with_overlaps_that_cannot_be_are_refused_by_name() {
    let mut model = soft();
    run(&mut model, 0.05, 0.1);
    let simulation = model.simulation();
    let at = simulation.state().events.list.iter().position(|event| event.kind == EventKind::Overlapped);
    let at = at.expect("an overlap");
    let refused = |name: &str, change: &dyn Fn(&mut State)| {
        let mut state = simulation.state().clone();
        assert_eq!(simulation.check(&state), Ok(()));
        change(&mut state);
        let unfit = simulation.check(&state).expect_err(name);
        assert!(unfit.what.contains(name), "{unfit}");
    };
    refused("other", &|state| state.events.list[at].other = 2);
    refused("subject", &|state| state.events.list[at].subject = 2);
    refused("depth", &|state| state.events.list[at].depth = -1.0);
    refused("events.overlap_max", &|state| state.events.overlap_max = f64::NAN);
    refused("events.overlapped", &|state| {
        let pair = state.events.overlapped[0];
        state.events.overlapped.push(pair);
    });
}
