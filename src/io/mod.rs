//! Case files, schema, results, pictures, checkpoints.

mod annotations;
mod base64;
pub mod bench;
pub mod blocks;
mod bound;
mod case_error;
mod case_file;
pub mod check;
pub mod checkpoint;
pub mod files;
pub mod fos;
mod geometry_file;
pub mod history;
mod lines;
pub mod picture;
mod record_file;
mod run;
mod schema;
pub mod summary;
pub mod vtu;

pub use annotations::model_annotations;
pub use bound::{BoundFailure, bound, bound_record};
pub use case_error::CaseError;
pub use case_file::{CaseSource, LoadedCase, load_case, parse_case};
pub use check::check;
pub use fos::{FosError, FosOptions, fos};
pub(crate) use run::Plan as RestPlan;
pub use run::{Observer, RunError, RunOptions, RunProgress, run};
pub use schema::schema;
pub use summary::{RunStatus, Summary};
