//! Tells what a communication step of one internal step costs above the engine's own step; asserts no time.

mod support;

use std::process::Command;
use std::time::Instant;

use engine::cosimulation::Cosimulation;
use support::{host, root, say, succeed};

const CASE: &str = "examples/cases/block_on_incline.toml";
const STEPS: u32 = 5000;
const ROUNDS: u32 = 7;

#[test]
fn overhead_of_a_step() {
    let loaded = engine::io::load_case(&root().join(CASE)).expect("a case");
    let mut facade = Cosimulation::new(&loaded).expect("a model");
    facade.start().expect("an equilibrium");
    let mut engine = facade.simulation().clone();
    let own = least(|| {
        engine.advance(false).expect("a step");
    });
    let dt = facade.internal_step();
    let mut time = facade.time();
    let facade = least(|| time = facade.do_step(time, dt).expect("a step").time);
    let told = succeed(Command::new(host("ffi/capi/tests/c/bench.c")).args([CASE, &STEPS.to_string()]));
    let told: Vec<f64> = told.split_whitespace().map(|word| word.parse().expect("a number")).collect();
    let added = [facade, told[0]].map(|spent| spent - own);
    say(&format!(
        "{CASE}, one internal step: engine {own:.0} ns, façade +{:.0} ns, C ABI +{:.0} ns",
        added[0], added[1]
    ));
    say(&format!("a call that only reads the time: {:.0} ns", told[1]));
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
