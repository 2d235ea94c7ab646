//! What the user wrote ([`Case`]), how it is built, and the façade that callers hold.

pub mod case;
pub mod snapshot;

pub use case::Case;
pub use snapshot::Snapshot;
