//! Tests of the entry points of FMI 3.

mod common;
mod instances;
mod meddling;
mod saved;
mod steps;
mod symbols;
