//! Tests of the C library: hosts in C and C++, what is installed, the same bits as in Rust.

mod bits;
#[path = "../header/mod.rs"]
mod generator;
mod header;
mod hosts;
mod install;
mod support;
