//! Tests of the entry points of FMUs: exports, calls that each state allows, calls from callbacks and other threads.
//! `python_tests/test_fmu_*.py` test how instances behave, for both versions at once.
#![allow(clippy::undocumented_unsafe_blocks, reason = "tests are hosts, whose pointers are to variables of their own")]

mod boxed;
mod fmi2;
mod fmi3;
mod symbols;
