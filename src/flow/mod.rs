//! Water that flows in the joints: the net of a model, what its pieces conduct, the conditions at its nodes, and where
//! its water presses. Knows nothing of time.

mod anderson;
mod conditions;
mod drains;
mod network;
mod nodes;
mod parting;
mod wet;

pub use anderson::{DEPTH, accelerate};
pub use conditions::{Inlet, Outside, is_open};
pub use drains::{Drain, is_on, part};
pub use network::{FallingRain, FlowNet, FlowPiece, HeldHead, Outcrop};
pub use parting::Parting;
pub use wet::{Wet, wet};
