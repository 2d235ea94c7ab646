//! Tests of the entry points of FMI 2: exports, and calls that each state allows. `python_tests/test_fmu_*.py` test how
//! instances behave, for both versions at once.
#![allow(clippy::undocumented_unsafe_blocks, reason = "tests are hosts, whose pointers are to variables of their own")]

mod common;
mod fmu;
mod symbols;
