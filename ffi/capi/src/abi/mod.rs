//! Entry points: pointers in, references to [`crate::safe`], pointers out.

pub mod inputs;
pub mod library;
pub mod model;
pub mod observe;
mod pointers;
pub mod record;
pub mod state;
