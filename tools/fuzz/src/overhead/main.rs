//! Measures the cost of one internal step through the façade, the C ABI and both FMUs above the engine's own step, that
//! of getters, setters and saved states, how often each allocates, and the effect of threads on a small model.
//!
//! All of it is linked into one program, whose hosts take turns. Times are the least of many turns: processor time of
//! the calling thread, and of threads wall time.

mod host;
mod model;
mod reads;

use std::io::Write;
use std::sync::LazyLock;
use std::time::Instant;

use engine::cosimulation::Cosimulation;
use enmm_fmi::table::Version;

use host::{C, Engine, Facade, Host, Imported};
use model::Model;

/// Calls in a turn.
const CALLS: u32 = 10;
/// Turns of every host.
const TURNS: u32 = 200;
/// Steps before the first turn.
const WARM: u32 = 100;

fn main() {
    say("| model | through | step [ns] | above the engine | step and read 3 | set and step | save \
         | allocations: step / read / set / save | bytes of a save over the state's |");
    say("|---|---|---:|---:|---:|---:|---:|---:|---:|");
    for model in model::models() {
        exports(&model);
    }
    say("\n| model | threads | step [ns] |\n|---|---:|---:|");
    for model in model::models() {
        threads(&model);
    }
    reads::table();
}

/// A line for whoever asked; a closed pipe is no error.
fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

fn started(model: &Model) -> Cosimulation {
    let mut facade = model.loaded.cosimulation().expect("a model");
    facade.start().expect("an equilibrium");
    facade
}

/// Allocations of this thread while it does something, and their bytes.
fn count(act: impl FnOnce()) -> [u64; 2] {
    let made = allocation_counter::measure(act);
    [made.count_total, made.bytes_total]
}

/// Work of a host in one call that is timed.
type Act = fn(&mut dyn Host, u32);

const STEP: Act = |host, _| host.step();
const STEP_AND_READ: Act = |host, _| {
    host.step();
    host.read();
};
const SET_AND_STEP: Act = |host, call| {
    host.write(1e-9 * f64::from(call % 2));
    host.step();
};
const SAVE: Act = |host, _| host.save();

fn exports(model: &Model) {
    let facade = started(model);
    let state = {
        let state = facade.simulation().state();
        count(|| drop(state.clone()))[1] as f64
    };
    let mut hosts: Vec<(&str, Box<dyn Host>)> = vec![
        ("engine", Box::new(Engine(facade.simulation().clone()))),
        ("façade", Box::new(Facade::new(facade))),
        ("C ABI", Box::new(C::new(model))),
        ("FMI 3", Box::new(Imported::new(model, Version::Three))),
        ("FMI 2", Box::new(Imported::new(model, Version::Two))),
    ];
    for (_, host) in &mut hosts {
        (0..WARM).for_each(|_| host.step());
    }
    let [step, read, set, save] =
        [STEP, STEP_AND_READ, SET_AND_STEP, SAVE].map(|act| least(&mut hosts, own_seconds, act));
    for (k, (name, host)) in hosts.iter_mut().enumerate() {
        let mut of = |act: &mut dyn FnMut(&mut dyn Host)| count(|| act(host.as_mut()));
        let made = [
            of(&mut |host| host.step()),
            of(&mut |host| host.read()),
            of(&mut |host| host.write(2e-9)),
            of(&mut |host| host.save()),
        ];
        let calls = made.map(|[calls, _]| calls.to_string()).join(" / ");
        say(&format!(
            "| {} | {name} | {:.0} | {:+.0} | {:.0} | {:.0} | {:.0} | {calls} | {:.2} |",
            model.name,
            step[k],
            step[k] - step[0],
            read[k],
            set[k],
            save[k],
            made[3][1] as f64 / state,
        ));
    }
}

/// Processor time of this thread (s).
fn own_seconds() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: room for a time is there.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &raw mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Wall time (s).
fn wall_seconds() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// Least mean time (ns) of a call of each host by a clock (s), in turns.
fn least(hosts: &mut [(&str, Box<dyn Host>)], clock: fn() -> f64, act: Act) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; hosts.len()];
    for _ in 0..TURNS {
        for ((_, host), least) in hosts.iter_mut().zip(&mut least) {
            let start = clock();
            (0..CALLS).for_each(|call| act(host.as_mut(), call));
            *least = least.min((clock() - start) * 1e9 / f64::from(CALLS));
        }
    }
    least
}

fn threads(model: &Model) {
    let first = started(model);
    let mut own = first.simulation().clone();
    own.set_serial(false);
    let mut hosts: Vec<(&str, Box<dyn Host>)> = vec![("engine, as many as there are", Box::new(Engine(own)))];
    for (name, threads) in [("façade, 1", 1), ("façade, 2", 2), ("façade, 8", 8)] {
        let mut facade = first.clone();
        facade.set_threads(threads).expect("threads");
        hosts.push((name, Box::new(Facade::new(facade))));
    }
    for (_, host) in &mut hosts {
        (0..WARM).for_each(|_| host.step());
    }
    let step = least(&mut hosts, wall_seconds, STEP);
    for ((name, _), step) in hosts.iter().zip(step) {
        say(&format!("| {} | {name} | {step:.0} |", model.name));
    }
}
