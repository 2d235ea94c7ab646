//! Claim: a run that is continued from a checkpoint has the same state to the bit as one that was never stopped, for
//! any number of threads; a checkpoint that is not whole, or not of this case and version, is refused.

use crate::common::{simulation, through_bytes};
use enmm::model::bytes::{BytesError, Keeper, decode, decode_state, encode};
use enmm::model::{Simulation, State};
use enmm_io::checkpoint::{CheckpointError, read, save};

/// A jointed slope whose covers are enough to be shared between threads (more than 2048), falling apart.
const SLOPE: &str = r#"
title = "slope"
domain = { outline = [[0, 0], [20, 0], [20, 12], [10, 12], [4, 2], [0, 2]], joint_law = "joint" }
mesh = { size = 0.3, angle_deg = 7 }
joint_set = [
    { angle_deg = 40, spacing = 1.7 },
    { angle_deg = 115, spacing = 2.1 },
]
rock.any = { density = 2600, young = 1e8, poisson = 0.25 }
joint_law.joint = { friction_deg = 10, dilation_deg = 3, cohesion = 100 }
fix = [{ name = "bottom", edge = [[0, 0], [20, 0]] }]
stage = [
    { name = "settle", kind = "static", duration = 0.02 },
    { name = "fall", kind = "dynamic", duration = 1 },
]
"#;

fn advance(simulation: &mut Simulation, steps: usize) {
    for k in 0..steps {
        simulation.advance(k % 7 == 0).unwrap_or_else(|e| panic!("{e}"));
    }
}

/// `before` steps of the first stage, `after` steps of the second, in a pool of `threads`; through a checkpoint in the
/// middle of both stages when `stopped`.
fn run(threads: usize, stopped: bool) -> State {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let mut one = simulation(SLOPE);
        assert!(one.model().covers.cover_count() > 3000, "{}", one.model().covers.cover_count());
        let through = |one: Simulation| if stopped { through_bytes(&one, SLOPE) } else { one };
        advance(&mut one, 33);
        one = through(one);
        advance(&mut one, 20);
        assert!(one.next_stage().expect("a stage"));
        advance(&mut one, 71);
        one = through(one);
        advance(&mut one, 90);
        one.state().clone()
    })
}

#[test]
fn a_restored_run_is_the_same_to_the_bit_for_any_threads() {
    let plain = run(1, false);
    let bits = |state: &State| {
        let mut state = state.clone();
        // A restored model searches again at once: the one thing that it counts and an uninterrupted one does not.
        state.counters.searches = 0;
        encode(Keeper::Model, &state, "").expect("bytes")
    };
    assert!(!plain.contacts.is_empty() && plain.ledger.friction > 0.0, "the case must have contact and slip");
    for (threads, stopped) in [(1, true), (2, false), (2, true), (5, true)] {
        let other = run(threads, stopped);
        assert!(bits(&plain) == bits(&other), "{threads} threads, stopped: {stopped}");
    }
}

#[test]
fn what_is_shown_follows_from_the_state_alone() {
    let mut one = simulation(SLOPE);
    advance(&mut one, 50);
    let mut other = simulation(SLOPE);
    other.restore(one.state().clone());
    assert_eq!(one.block_states(), other.block_states());
    assert_eq!(format!("{:?}", one.contacts()), format!("{:?}", other.contacts()));
}

#[test]
fn a_file_gives_back_what_was_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint.enmm");
    let mut one = simulation(SLOPE);
    advance(&mut one, 5);
    save(&path, one.state(), "0123").expect("written");
    let (keeper, bytes) = read(&path, "0123").expect("read");
    assert_eq!(keeper, Keeper::Run);
    for own in [Keeper::Run, Keeper::Model] {
        assert_eq!(&decode_state(own, &bytes, "0123").expect("a state"), one.state());
    }
    let of_run = decode_state(Keeper::Fmu, &bytes, "0123").expect_err("no state of an FMU");
    assert!(matches!(of_run, BytesError::OtherKeeper { found: Keeper::Run, own: Keeper::Fmu }), "{of_run}");
    let error = read(&path.with_extension("absent"), "0123").expect_err("absent");
    assert!(matches!(error, CheckpointError::Unreadable(_)));
}

#[test]
fn what_is_no_whole_checkpoint_of_this_case_is_refused() {
    let mut one = simulation(SLOPE);
    advance(&mut one, 3);
    let good = encode(Keeper::Model, one.state(), "0123").expect("bytes");
    let refused = |bytes: &[u8], hash: &str| decode::<State>(Keeper::Model, bytes, hash).expect_err("refused");
    for length in [0, 4, 8, 11, 14, 20, 30, 40, good.len() / 2, good.len() - 1] {
        let error = refused(&good[..length], "0123");
        assert!(matches!(error, BytesError::Truncated(_) | BytesError::Foreign), "{length}: {error}");
    }
    let message = refused(&good, "4567").to_string();
    assert!(message.contains("0123") && message.contains("4567"), "{message}");
    assert!(matches!(refused(b"PK\x03\x04 something else", "0123"), BytesError::Foreign));
    for at in [good.len() - 1, good.len() / 2, 60] {
        let mut bad = good.clone();
        bad[at] ^= 0x10;
        assert!(matches!(refused(&bad, "0123"), BytesError::Damaged(_)), "{at}");
    }
    let mut newer = good.clone();
    newer[8] = 99;
    assert!(matches!(refused(&newer, "0123"), BytesError::Version { .. }));
    let mut longer = good;
    longer.push(0);
    assert!(matches!(refused(&longer, "0123"), BytesError::Damaged(_)));
}
