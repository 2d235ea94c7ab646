//! Cuts of rock in the middle of a run: where the parts of the model after them come from, and the state in which they
//! go on.

mod carry;
mod contacts;
mod kept_nodes;
mod lineage;
mod parents;
mod places;

pub use carry::{carry, carry_break};
pub use kept_nodes::keep_nodes;
pub use lineage::Lineage;
