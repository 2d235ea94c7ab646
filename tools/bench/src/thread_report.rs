//! Writes what a step would take on more threads, as a page.

use std::fmt::Write as _;

use super::Machine;
use super::report::{Origin, digits, none, push_machine, push_table};
use super::threads::{Predicted, Prediction};

const INTRODUCTION: &str = "\
The tasks of some steps are timed one by one on one thread, cut as for several: each counts with its quickest time, so
that their sum is somewhat below the quickest step. They are then scheduled: a thread that is free takes a task that it
has made ready, else one of another thread, which costs what it costs here on two threads. Without a limit of memory the
times are the least that this order of work allows. With the bandwidth of this machine, no more bytes a second are moved
on any number of threads than two move here, and nothing stays in a cache from one part of a step to the next: a machine
with more memory channels lies between the two. Caches that are shared and clocks that fall with the number of busy
cores are left out.";

/// Cost (µs) of a task of another thread above which that thread was not there: a half of a branch that is timed.
const BUSY_US: f64 = 10.0;

/// What was predicted, as a page.
pub fn threads_markdown(machine: &Machine, predictions: &[Prediction], origin: &Origin) -> String {
    let mut text = String::from("# A step on more threads\n\n");
    let _ = writeln!(text, "{}.\n\n    {}\n\n{INTRODUCTION}\n", origin.label, origin.command);
    push_machine(&mut text, machine);
    for found in predictions {
        push_model(&mut text, found);
    }
    text
}

fn push_model(text: &mut String, found: &Prediction) {
    let head = ["threads", "ms, memory no limit", "times as fast", "ms, bandwidth of this machine", "measured ms"];
    let [Predicted { free_ms: one, .. }, ..] = found.threads[..] else { return };
    let rows = found.threads.iter().map(|predicted| {
        let Predicted { threads, free_ms, bound_ms, measured_ms } = *predicted;
        let measured = measured_ms.map_or_else(none, digits);
        vec![threads.to_string(), digits(free_ms), digits(one / free_ms), digits(bound_ms), measured]
    });
    push_table(text, &found.model, &head, rows);
    let [own, all] = found.bandwidth.map(|rate| digits(1e-9 * rate));
    let _ = writeln!(
        text,
        "{} tasks a step: work {} ms, longest chain {} ms. Taking a task of another thread costs {} µs.\n\
         Memory: {own} GB/s on one thread, {all} on all.\n",
        found.tasks,
        digits(found.work_ms),
        digits(found.span_ms),
        digits(found.fork_us)
    );
    if found.fork_us > BUSY_US {
        text.push_str(
            "The second core was busy with other programs: this cost and what was measured on two threads are too \
             high.\n\n",
        );
    }
    let parts = found.parts.iter().map(|&(name, megabytes, ms)| vec![name.to_owned(), digits(ms), digits(megabytes)]);
    push_table(text, &format!("{}: parallel parts", found.model), &["part", "ms on one thread", "MB"], parts);
    let serial = found.serial.iter().map(|(name, ms)| vec![name.clone(), digits(*ms)]);
    push_table(text, &format!("{}: serial stretches", found.model), &["between", "ms"], serial);
}
