//! What the user wrote ([`Case`]), how it is built, and the façade that callers hold ([`Simulation`]).

pub mod assemble;
pub mod case;
pub mod fit;
pub mod limit_analysis;
mod observe;
pub mod settle;
mod simulation;
pub mod snapshot;
pub mod strength_reduction;

pub use assemble::{BuildStage, Built, build};
pub use case::Case;
pub use fit::Unfit;
pub use observe::BlockState;
pub use simulation::Simulation;
pub use snapshot::Snapshot;
