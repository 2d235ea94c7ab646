//! Breaking of intact rock: which section of a block is nearest to its strength (theory §13).

mod blocks;
mod chord;
mod cores;
mod forces;
mod masses;
mod outline;
mod search;

pub use blocks::BreakableBlocks;
pub use search::{Search, Watched, watch};
