//! Tests of the readers: case files, geometry files, and the reference of keys.

#[path = "../../../tests/common/mod.rs"]
mod common;
mod errors;
mod expand;
mod geometry_files;
mod key_reference;
mod limits;
mod support;
mod tables;
