//! Water that flows in the joints: the net of a model, what its pieces conduct, what holds at its nodes, and where its
//! water presses. Knows nothing of time.

mod conditions;
mod network;
mod nodes;
mod wet;

pub use conditions::{HeldHead, Inlet, Outside};
pub use network::{FlowNet, FlowPiece, Outcrop};
pub use wet::{Wet, wet};
