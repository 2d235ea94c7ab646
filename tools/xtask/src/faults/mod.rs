//! Runs of the program that something goes wrong with from outside: killed, interrupted, without room, without a
//! folder, without a reader. Each says what was tried; results are compared with those of an undisturbed run, to the
//! bit.

mod harm;
mod place;

use crate::counts::Counts;
use crate::repository::Repository;
use crate::steps::{Verdict, attempt};
use place::Place;

/// Rounds when no number is given.
const ROUNDS: u64 = 5;

/// A fault: name and what tries it, with a number that differs from round to round.
type Fault = (&'static str, fn(&Place, u64) -> Result<Verdict, String>);

/// All faults; a round of them runs in `cargo xtask test`.
const FAULTS: [Fault; 9] = [
    ("killed at random moments, then resumed", harm::killed),
    ("interrupted by SIGINT or SIGTERM, then resumed", harm::interrupted),
    ("nobody reads what it prints", harm::closed_pipe),
    ("it prints to a full device", harm::full_device),
    ("its folder cannot be written to", harm::read_only),
    ("its disk is full", harm::full_disk),
    ("its folder vanishes", harm::vanished),
    ("its folder is a file", harm::no_folder),
    ("two runs of a case in one folder", harm::together),
];

/// Reads `[--rounds N]` and tries all faults so often; fails when one did harm.
///
/// # Errors
/// When the arguments are wrong, or the undisturbed run fails.
pub fn run(repository: &Repository, words: &[&str]) -> Result<(), String> {
    let rounds = match words {
        [] => ROUNDS,
        ["--rounds", number] => number.parse().map_err(|_| format!("{number} is no number"))?,
        _ => return Err("usage: cargo xtask faults [--rounds N]".to_owned()),
    };
    repository.build(&["--workspace"])?;
    let counts = rounds_of(repository, rounds)?;
    println!("{} held, {} did harm", counts.passed, counts.failed);
    if counts.failed == 0 { Ok(()) } else { Err(format!("{} faults did harm: see above", counts.failed)) }
}

/// Tries all faults in each round.
pub fn rounds_of(repository: &Repository, rounds: u64) -> Result<Counts, String> {
    let place = Place::new(repository)?;
    let mut counts = Counts::default();
    for round in 0..rounds {
        for (name, act) in FAULTS {
            let is_held = attempt(["held", "HARM"], &format!("{name} (round {round})"), || act(&place, round));
            counts.passed += u64::from(is_held == Some(true));
            counts.failed += u64::from(is_held == Some(false));
        }
    }
    Ok(counts)
}
