//! Entry points: pointers in, references to [`crate::safe`], pointers out.

pub mod batch;
pub mod inputs;
pub mod library;
pub mod model;
pub mod names;
pub mod observe;
pub mod parameters;
mod pointers;
pub mod record;
pub mod state;
