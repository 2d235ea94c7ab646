//! FMI 2 co-simulation entry points over `enmm_fmi`. The functions are those of `fmi2Functions.h`.
//!
//! A component is the number of a live instance in the form of a pointer, and so is a saved state: one that was freed,
//! or never made, is refused. Whatever goes wrong inside is a status and a log line; nothing unwinds into the importer.

mod common;
mod cosimulation;
mod model_exchange;
mod types;
mod variables;

pub use common::*;
pub use cosimulation::*;
pub use model_exchange::*;
pub use types::*;
pub use variables::*;
