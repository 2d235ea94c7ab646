//! Throws wrong cases, calls and states at every entrance of enmm and watches that it neither breaks nor lies: no
//! panic, no abort, no endless loop, no value that is no number, no byte outside a buffer, no model that a failed call
//! changed.
//!
//! Inputs are made of seed, part and number alone. A child process takes them one by one, so that one which kills it or
//! never ends costs only itself; what was found is written to a folder with the command that repeats it.

mod driver;
mod parts;
mod random;
mod trace;
mod worker;

use std::io::Write;
use std::process::ExitCode;

use driver::Plan;

const USAGE: &str = "\
usage: cargo xtask fuzz [--minutes N] [--seed S] [--part NAME] [--from K] [--inputs N] [--finds DIR]

  --minutes N   goes on for so long; without it, takes the share that cargo xtask test takes
  --seed S      another number gives other inputs (default: 1)
  --part NAME   one part alone: bursts, calls, cases, fmus, networks, states
  --from K      number of the first input
  --inputs N    inputs of each part
  --finds DIR   where what is found is written";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let done = match words[..] {
        ["worker", ref words @ ..] => worker::Task::read(words).and_then(|task| task.run()).map(|()| true),
        _ => Plan::read(&words).and_then(|plan| plan.run()),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            say(&message);
            ExitCode::from(2)
        }
    }
}

/// A line for whoever asked; one who has gone away is not told.
fn say(line: &str) {
    let mut out = std::io::stdout();
    let _ = writeln!(out, "{line}").and_then(|()| out.flush());
}
