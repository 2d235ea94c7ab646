//! Breaking of intact rock: which section of a block is nearest to its strength (theory §13).

mod chord;
mod cores;
mod forces;
mod outline;
mod search;

pub use outline::Outlines;
pub use search::{Search, Watched, watch};
