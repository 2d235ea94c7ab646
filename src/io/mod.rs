//! Case files, schema, results, pictures, checkpoints.

mod case_error;
mod case_file;
pub mod files;
mod geometry_file;
pub mod history;
mod lines;
pub mod picture;
mod schema;
pub mod vtu;

pub use case_error::CaseError;
pub use case_file::{CaseSource, LoadedCase, load_case, parse_case};
pub use schema::schema;
