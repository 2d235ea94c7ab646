//! Case files, schema, results, pictures, checkpoints.

pub mod files;
pub mod history;
pub mod picture;
pub mod vtu;
