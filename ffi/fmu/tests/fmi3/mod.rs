//! FMI 3.

mod common;
mod instances;
mod meddling;
