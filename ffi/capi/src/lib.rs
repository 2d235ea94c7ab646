//! C ABI of the engine: twin files of safe Rust and pointers.
//!
//! [`safe`] does the work and forbids `unsafe`; the file of the same name in [`abi`] holds the entry points, which only
//! turn pointers into references and back. `include/enmm.h` is generated from [`types`] and [`abi`].
//!
//! Handles are integers cast to pointers: slot and generation of an entry in a table of the process. They are never
//! dereferenced, so that a handle which is NULL, dead or made up is an error and never a crash. The table
//! is the only thing that the process shares; it is locked for the look-up alone.
#![deny(unsafe_op_in_unsafe_fn)]
// C sees the names of this crate as they are.
#![allow(non_camel_case_types)]

// The library of a wheel is that of its FMUs as well: one copy of the engine.
use enmm_fmu as _;

#[macro_use]
pub mod growing;

pub mod abi;
pub mod layout;
pub mod numbers;
pub mod safe;
pub mod types;
