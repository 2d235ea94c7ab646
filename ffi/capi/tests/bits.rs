//! A run through the C ABI, with its second half in another model, gives the bits of the façade.

use std::fmt::Write;
use std::process::Command;

use crate::support::{SMALL, host, root, succeed};
use engine::geometry::Vector;
use engine::model::BlockState;

const H: f64 = 0.003;
const STEPS: usize = 40;

#[test]
fn the_c_abi_gives_the_bits_of_the_facade() {
    let loaded = enmm_io::load_case(&root().join(SMALL)).expect("a case");
    let mut model = loaded.cosimulation().expect("a model");
    let mut own = String::new();
    for k in 0..STEPS {
        model.set_gravity(Vector::new(0.1 * k as f64, -9.81)).expect("gravity");
        model.do_step(k as f64 * H, H).expect("a step");
        model.block_states().iter().for_each(|state| write_state(&mut own, state));
    }
    let mut trace = Command::new(host("ffi/capi/tests/c/trace.c"));
    let other = succeed(trace.args([SMALL, &STEPS.to_string(), &H.to_string()]));
    let differing = own.lines().zip(other.lines()).position(|(a, b)| a != b);
    assert_eq!((differing, own.lines().count()), (None, other.lines().count()));
    assert!(own.lines().count() == 2 * STEPS);
}

fn write_state(text: &mut String, s: &BlockState) {
    let places = [s.centroid.x, s.centroid.y, s.displacement.x, s.displacement.y];
    let motion = [s.rotation, s.velocity.x, s.velocity.y, s.angular_velocity];
    let sums = [s.area, s.mass, s.kinetic_energy, s.strain_energy, s.contacts.penetration_max];
    let values = [&places[..], &motion, &s.mean_stress, &sums].concat();
    let bits: String = values.iter().map(|value| format!(" {:016x}", value.to_bits())).collect();
    writeln!(text, "{} {}{bits}", s.id, s.contacts.count).expect("text takes text");
}
