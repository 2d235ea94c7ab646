//! Claim: bytes with a good checksum whose numbers, indices or lengths no state of the model can have are refused when
//! they are read, by the name of what is wrong; whatever is not refused makes nothing panic.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use crate::common::saved::Whole;
use enmm::cosimulation::Cosimulation;
use enmm::geometry::Vector;
use enmm::model::bytes::{Keeper, checksum, decode, encode};
use enmm::model::tables::{EdgeId, LawId, NodeId, SideId};
use enmm_io::load_case;

/// A block on a slab, pushed by a host, between two internal steps; and the bytes of its state.
fn model() -> (Cosimulation, Vec<u8>) {
    let loaded = load_case(Path::new("ffi/capi/tests/cases/small.toml")).expect("a case");
    let mut model = loaded.cosimulation().expect("a model");
    model.start().expect("an equilibrium");
    model.set_gravity(Vector::new(20.0, -9.81)).expect("gravity");
    let h = model.internal_step();
    model.do_step(0.0, 100.0 * h).expect("a step");
    model.do_step(100.0 * h, 2.5 * h).expect("a step");
    let bytes = model.serialize(&model.save()).expect("bytes");
    (model, bytes)
}

type Damage = (&'static str, fn(&mut Whole));

const DAMAGES: [Damage; 33] = [
    ("displacement[3].x", |w| w.state.displacement[3].x = f64::INFINITY),
    ("displacement[0].y", |w| w.state.displacement[0].y = f64::NAN),
    ("displacement[0].y", |w| w.state.displacement[0].y = -1e300),
    ("velocity[1].x", |w| w.state.velocity[1].x = f64::NEG_INFINITY),
    ("the length of velocity", |w| w.state.velocity.truncate(2)),
    ("the length of stage_displacement", |w| w.state.stage_displacement.push(Vector::zeros())),
    ("contacts[0].node", |w| w.state.contacts[0].node = NodeId::new(1 << 31)),
    ("contacts[0].edge", |w| w.state.contacts[0].edge = EdgeId::new(1 << 20)),
    ("contacts[1].normal_force", |w| w.state.contacts[1].normal_force = f64::NAN),
    ("contacts[0].trend[1]", |w| w.state.contacts[0].trend[1] = f64::INFINITY),
    ("the order of contacts", |w| w.state.contacts.reverse()),
    ("neighbours.pairs[0].side", |w| w.state.neighbours.pairs[0].side = SideId::new(1 << 31)),
    ("the order of neighbours.pairs", |w| w.state.neighbours.pairs.reverse()),
    ("stage is", |w| w.state.stage = 2),
    ("stage_starts[1]", |w| w.state.stage_starts[1] = f64::NAN),
    ("part is", |w| w.state.part = 1.0),
    ("part is", |w| w.state.part = f64::NAN),
    ("dt_last", |w| w.state.dt_last = -1.0),
    ("stage_step", |w| w.state.stage_step = u64::MAX),
    ("support", |w| w.state.support_force.push(0.0)),
    ("laws[0].friction", |w| w.state.laws[0].friction = f64::NAN),
    ("joint_law.joint.friction", |w| w.parameters[3] = f64::NAN),
    ("drive.moved[1]", |w| w.state.drive.moved[1].x = f64::NAN),
    ("length of parameters", |w| w.parameters.push(0.0)),
    ("law_switch[0]", |w| w.state.law_switch[0] = LawId::new(99)),
    ("drive.to.gravity.y", |w| w.state.drive.to.gravity.y = f64::INFINITY),
    ("drive.from.block_moment[1]", |w| w.state.drive.from.block_moment[1] = f64::NAN),
    ("drive.until", |w| w.state.drive.until = f64::INFINITY),
    ("events.list[0].subject", |w| w.state.events.list[0].subject = 1000),
    ("ledger", |w| w.state.ledger.friction = f64::NAN),
    ("counters.dt_min", |w| w.state.counters.dt_min = f64::INFINITY),
    ("host_time", |w| w.progress.told = f64::NAN),
    ("between: displacement[2].y", |w| {
        if let Some(between) = &mut w.between {
            between.displacement[2].y = f64::INFINITY;
        }
    }),
];

#[test]
fn what_no_state_can_have_is_refused_by_name() {
    let (mut model, bytes) = model();
    let whole: Whole = decode(Keeper::Model, &bytes, model.hash()).expect("a state");
    for (name, damage) in DAMAGES {
        let mut damaged = whole.clone();
        damage(&mut damaged);
        let damaged = encode(Keeper::Model, &damaged, model.hash()).expect("bytes");
        let Err(error) = model.deserialize(&damaged) else { panic!("{name} is taken") };
        let error = error.to_string();
        assert!(error.contains(name) && error.contains("must be"), "{name}: {error}");
    }
    assert_eq!(model.serialize(&model.save()).expect("bytes"), bytes, "the model is as it was");
    let saved = model.deserialize(&bytes).expect("good bytes");
    model.restore(&saved).expect("a good state");
}

/// The bytes with one of the payload changed, and the checksum made good: it stands in the four bytes before.
fn forged(bytes: &[u8], start: usize, at: usize, by: u8) -> Vec<u8> {
    let mut forged = bytes.to_vec();
    forged[at] ^= by;
    let checksum = checksum(&forged[..start - 12], &forged[start..]);
    forged[start - 4..start].copy_from_slice(&checksum.to_le_bytes());
    forged
}

/// Every byte of the state once, with a bit that differs from byte to byte: signs, exponents, indices, flags, lengths.
#[test]
fn no_forged_byte_makes_a_model_panic() {
    let (model, bytes) = model();
    let is_start = |&k: &usize| checksum(&bytes[..k - 12], &bytes[k..]).to_le_bytes() == bytes[k - 4..k];
    let start = (12..bytes.len()).find(is_start);
    let start = start.expect("a payload");
    let mut taken = 0;
    for at in start..bytes.len() {
        let forged = forged(&bytes, start, at, 1 << (7 - at % 8));
        let Ok(saved) = model.deserialize(&forged) else { continue };
        let mut other = model.clone();
        other.restore(&saved).expect("what is read can be restored");
        let used = catch_unwind(AssertUnwindSafe(|| {
            let (time, h) = (other.time(), 1.5 * other.internal_step());
            let ports: Vec<_> = (0..other.ports().len()).map(|k| other.port_state(k)).collect();
            let seen = (ports, other.totals(), other.contacts(), other.block_states());
            let stepped = other.do_step(time, h);
            (seen, stepped.is_ok(), other.totals())
        }));
        assert!(used.is_ok(), "byte {} of {}", at - start, bytes.len() - start);
        taken += 1;
    }
    assert!(taken > bytes.len() / 4, "{taken} of {}", bytes.len());
}
