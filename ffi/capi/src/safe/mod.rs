//! Everything behind the entry points that needs no pointer.
#![forbid(unsafe_code)]

pub mod batch;
pub mod control;
pub mod enter;
pub mod failure;
pub mod handles;
pub mod inputs;
pub mod model;
pub mod names;
pub mod observe;
pub mod parameters;
pub mod record;
pub mod state;
