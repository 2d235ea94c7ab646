//! Prints the cost of a communication step of one internal step above the engine's own step; asserts no time.

use std::process::Command;
use std::time::Instant;

use crate::support::{host, root, say, succeed};

const CASE: &str = "examples/cases/block_on_incline.toml";
const STEPS: u32 = 5000;
const ROUNDS: u32 = 7;
const TURNS: u32 = 5;

#[test]
fn overhead_of_a_step() {
    let loaded = enmm_io::load_case(&root().join(CASE)).expect("a case");
    let mut facade = loaded.cosimulation().expect("a model");
    facade.start().expect("an equilibrium");
    let (start, dt) = (facade.time(), facade.internal_step());
    let bench = host("ffi/capi/tests/c/bench.c");
    let mut least_of = [f64::INFINITY; 4];
    // In turns, so that whatever else the machine does meets all of them.
    for _ in 0..TURNS {
        let mut engine = facade.simulation().clone();
        let own = least(|| {
            engine.advance(false).expect("a step");
        });
        let (mut model, mut time) = (facade.clone(), start);
        let through = least(|| time = model.do_step(time, dt).expect("a step").time);
        let told = succeed(Command::new(&bench).args([CASE, &STEPS.to_string()]));
        let told: Vec<f64> = told.split_whitespace().map(|word| word.parse().expect("a number")).collect();
        let spent = [own, through, told[0], told[1]];
        least_of.iter_mut().zip(spent).for_each(|(least, spent)| *least = least.min(spent));
    }
    let [own, through, abi, call] = least_of;
    let added = format!("façade {:+.0} ns, C ABI {:+.0} ns", through - own, abi - own);
    say(&format!("{CASE}, one internal step: engine {own:.0} ns, {added}; a call that only reads: {call:.0} ns"));
}

/// Least mean of several rounds (ns).
fn least(mut act: impl FnMut()) -> f64 {
    let mut round = || {
        let start = Instant::now();
        (0..STEPS).for_each(|_| act());
        start.elapsed().as_secs_f64() * 1e9 / f64::from(STEPS)
    };
    (0..ROUNDS).map(|_| round()).fold(f64::INFINITY, f64::min)
}
