//! Tests of the entry points of FMI 2.

mod common;
mod fmu;
mod symbols;
