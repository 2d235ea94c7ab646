//! Everything behind the entry points that needs no pointer.
#![forbid(unsafe_code)]

pub mod enter;
pub mod failure;
pub mod handles;
pub mod inputs;
pub mod model;
pub mod observe;
pub mod record;
pub mod state;
