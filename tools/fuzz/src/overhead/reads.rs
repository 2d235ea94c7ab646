//! What it costs to look at a model after a step: each read as a share of an internal step, for the first look and for
//! another one before the next step.

use std::hint::black_box;
use std::path::Path;

use engine::cosimulation::{Cosimulation, PortKind};
use enmm_io::load_case;

use super::{own_seconds, say};

/// Cases that are looked at.
const CASES: [&str; 3] = ["block_on_incline", "coupled_slope", "fractured_slope"];
/// Steps before the first measurement.
const WARM: u32 = 20;
/// Seconds of processor time for a row.
const SECONDS: f64 = 0.5;

/// A look at the model.
type Read = fn(&Cosimulation);

/// Looks by name.
const READS: [(&str, Read); 8] = [
    ("nothing", |_| ()),
    ("block states", |model| _ = black_box(model.simulation().blocks())),
    ("block port", |model| read_port(model, PortKind::Block)),
    ("boundary port", |model| read_port(model, PortKind::Boundary)),
    ("joint port", |model| read_port(model, PortKind::Joint)),
    ("energies and totals", |model| _ = black_box(model.totals())),
    ("number of contacts", |model| _ = black_box(model.contact_count())),
    ("contacts", |model| _ = black_box(model.contact_views())),
];

fn read_port(model: &Cosimulation, kind: PortKind) {
    if let Some(port) = model.ports().iter().position(|port| port.kind == kind) {
        black_box(model.port_state(port));
    }
}

/// Prints the table of reads.
pub fn table() {
    say("\n| model | blocks | step [us] | read | first read after a step [steps] | read again [steps] |");
    say("|---|---:|---:|---|---:|---:|");
    for name in CASES {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../examples/cases/{name}.toml"));
        let mut model = load_case(&path).expect("a case").cosimulation().expect("a model");
        model.start().expect("an equilibrium");
        let blocks = model.simulation().model().covers.block_count();
        rows(name, blocks, &mut model);
    }
}

fn rows(name: &str, blocks: usize, model: &mut Cosimulation) {
    (0..WARM).for_each(|_| step(model));
    let begun_at = model.save();
    for (read_name, read) in READS {
        let mut times = [const { Vec::new() }; 3];
        model.restore(&begun_at).expect("a state of this model");
        let begun = own_seconds();
        while own_seconds() - begun < SECONDS {
            times[0].push(time(|| step(model)));
            times[1].push(time(|| read(model)));
            times[2].push(time(|| read(model)));
        }
        let [step, first, again] = times.map(lower_quartile);
        let (us, first, again) = (step * 1e6, first / step, again / step);
        say(&format!("| {name} | {blocks} | {us:.1} | {read_name} | {first:.3} | {again:.3} |"));
    }
}

/// The time that a quarter of the calls do not need: it leaves out the few steps that look at more, and interruptions.
fn lower_quartile(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 4]
}

/// One communication step of one internal step.
fn step(model: &mut Cosimulation) {
    let (time, dt) = (model.time(), model.internal_step());
    model.do_step(time, dt).expect("a step");
}

/// Processor time (s) that `act` takes.
fn time(act: impl FnOnce()) -> f64 {
    let begun = own_seconds();
    act();
    own_seconds() - begun
}
