//! Water that flows in the joints: the net of a model, what its pieces conduct, the conditions at its nodes, and where
//! its water presses. Knows nothing of time.

mod conditions;
mod network;
mod nodes;
mod wet;

pub use conditions::{Inlet, Outside};
pub use network::{FlowNet, FlowPiece, HeldHead, Outcrop};
pub use wet::{Wet, wet};
