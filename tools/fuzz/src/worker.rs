//! The child process: takes inputs one by one and tells of each on its standard output.
//!
//! Lines are `at K` before an input, then `done K CALLS`, `skip K` or `bad K MESSAGE`. A panic ends the process, also
//! one that an entry point would have caught.

use std::fs::File;

use crate::parts::{self, Outcome};
use crate::random::Random;
use crate::say;
use crate::trace::Trace;

/// Status of a process that ended by a panic.
pub const PANICKED: i32 = 101;
/// Address space (bytes) that a process may have: an input that floods the memory is a find, and no harm to others.
const MEMORY: libc::rlim_t = 4 << 30;
/// Where an address sanitizer has its options, the limit among them: it takes more address space than any machine has.
const SANITIZER: &str = "ASAN_OPTIONS";

/// Inputs of one part.
pub struct Task {
    part: &'static parts::Part,
    seed: u64,
    from: u64,
    count: u64,
    trace: Option<String>,
}

impl Task {
    /// Reads `PART SEED FROM COUNT [TRACE]`.
    pub fn read(words: &[&str]) -> Result<Self, String> {
        let number = |word: &str| word.parse::<u64>().map_err(|_| format!("{word} is no number"));
        match *words {
            [part, seed, from, count, ref trace @ ..] => Ok(Self {
                part: parts::find(part)?,
                seed: number(seed)?,
                from: number(from)?,
                count: number(count)?,
                trace: trace.first().map(|&path| path.to_owned()),
            }),
            _ => Err("worker PART SEED FROM COUNT [TRACE]".to_owned()),
        }
    }

    /// Takes the inputs.
    pub fn run(&self) -> Result<(), String> {
        guard();
        let mut act = (self.part.make)()?;
        for index in self.from..self.from + self.count {
            say(&format!("at {index}"));
            let mut trace = Trace(match &self.trace {
                Some(path) => Some(File::create(path).map_err(|error| format!("{path}: {error}"))?),
                None => None,
            });
            let outcome = act(&mut Random::new(self.seed, self.part.name, index), &mut trace);
            match outcome {
                Ok(Outcome::Done(calls)) => say(&format!("done {index} {calls}")),
                Ok(Outcome::Skipped) => say(&format!("skip {index}")),
                Err(problem) => say(&format!("bad {index} {}", problem.replace('\n', " "))),
            }
        }
        Ok(())
    }
}

/// Limits the memory, and makes every panic the end, wherever it would be caught.
fn guard() {
    let limit = libc::rlimit { rlim_cur: MEMORY, rlim_max: MEMORY };
    if std::env::var_os(SANITIZER).is_none() {
        // SAFETY: the limits are there. Without them a flood only ends later.
        unsafe { libc::setrlimit(libc::RLIMIT_AS, &raw const limit) };
    }
    let told = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        told(panic);
        std::process::exit(PANICKED);
    }));
}
