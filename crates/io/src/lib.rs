//! Files of enmm: case files with the geometry and records that they name, their schema, checkpoints.
//!
//! [`load_case`] reads a case, whose errors name file, line and key; [`files`] writes what is whole or absent.
#![forbid(unsafe_code)]

mod case_error;
mod case_file;
pub mod checkpoint;
pub mod files;
mod geometry_file;
mod lines;
mod record_file;
mod schema;

pub use case_error::CaseError;
pub use case_file::{CaseSource, LoadedCase, load_case, load_case_with, parse_case};
pub use schema::schema;
