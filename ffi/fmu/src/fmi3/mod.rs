//! FMI 3 co-simulation entry points over `enmm_fmi`. The functions are those of `fmi3Functions.h`.
//!
//! An instance is the number of a live one in the form of a pointer, and so is a saved state: one that was freed, or
//! never made, is refused. Whatever goes wrong inside is a status and a log line; nothing unwinds into the importer.

mod common;
mod cosimulation;
mod events;
mod refused;
mod saved;
mod types;
mod variables;

pub use common::*;
pub use cosimulation::*;
pub use events::*;
pub use refused::*;
pub use saved::*;
pub use types::*;
pub use variables::*;
