//! The parts: each makes an input of random numbers and tries it.

mod calls;
mod cases;
mod fmus;
mod networks;
mod states;

use crate::random::Random;
use crate::trace::Trace;

/// Outcome of an input that broke nothing.
pub enum Outcome {
    /// It was tried, with so many calls.
    Done(u64),
    /// It asks for more than a campaign can spend: left out.
    Skipped,
}

/// Tries an input; a broken promise is an error.
pub type Act = Box<dyn FnMut(&mut Random, &mut Trace) -> Result<Outcome, String>>;

/// A part.
pub struct Part {
    /// Its name.
    pub name: &'static str,
    /// Inputs in a turn; one turn is the share of `cargo xtask test`.
    pub turn: u64,
    /// Makes what its inputs have in common.
    pub make: fn() -> Result<Act, String>,
}

/// All parts.
pub const PARTS: [Part; 6] = [
    Part { name: "cases", turn: 800, make: cases::make },
    Part { name: "networks", turn: 700, make: networks::make },
    Part { name: "calls", turn: 120, make: calls::make },
    Part { name: "bursts", turn: 10, make: calls::bursts },
    Part { name: "states", turn: 20000, make: states::make },
    Part { name: "fmus", turn: 1500, make: fmus::make },
];

/// The part with a name.
pub fn find(name: &str) -> Result<&'static Part, String> {
    let found = PARTS.iter().find(|part| part.name == name);
    found.ok_or_else(|| format!("there is no part {name:?}: {}", PARTS.map(|part| part.name).join(", ")))
}

/// An error unless all values are finite.
fn finite(what: &str, values: &[f64]) -> Result<(), String> {
    let bad = values.iter().position(|value| !value.is_finite());
    bad.map_or(Ok(()), |k| Err(format!("{what}: value {k} of {} is {}", values.len(), values[k])))
}
