//! Case files, schema, results, pictures, checkpoints.

mod case_error;
mod case_file;
mod geometry_file;
mod lines;
mod schema;

pub use case_error::CaseError;
pub use case_file::{CaseSource, LoadedCase, load_case, parse_case};
pub use schema::schema;
