//! Mathematical covers, physical covers, manifold elements and blocks, with their weights and integrals.
//! Knows nothing of stress or time.

mod cut;
mod host;
mod mesh;
mod order;
mod outlines;

pub use cut::{Covers, cut};
pub use mesh::{RegularMesh, Triangle};
pub use outlines::{BoundaryPiece, Outlines};

/// Weights of the three physical covers of an element at a point.
pub type Weights = [f64; 3];
