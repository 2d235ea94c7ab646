//! Mathematical covers, physical covers, manifold elements and blocks, with their weights and integrals.
//! Knows nothing of stress or time.

mod covers;
mod crumbs;
mod cut;
mod host;
mod mesh;
mod order;
mod outlines;
mod union_find;

pub use covers::Covers;
pub use crumbs::{Crumb, CrumbRule, join_crumbs};
pub use cut::cut;
pub use mesh::{RegularMesh, Triangle};
pub use outlines::{BoundaryPiece, NodePlaces, Outlines};
pub use union_find::UnionFind;

use crate::geometry::{Vector, id};

id! {
    /// A block: rock that no joint cuts through.
    BlockId: plain
}
impl From<u32> for BlockId {
    /// The id of a number that a host gives; there need not be such a block.
    fn from(number: u32) -> Self {
        Self(number)
    }
}

id! {
    /// A manifold element.
    ElementId: optional
}
id! {
    /// A physical cover.
    CoverId: plain
}

/// Weights of the three physical covers of an element at a point.
pub type Weights = [f64; 3];

/// A field over all covers at the point where three of them have these weights.
#[inline(always)]
pub fn sample(covers: &[CoverId; 3], weights: &Weights, field: &[Vector]) -> Vector {
    let part = |k: usize| field[covers[k]] * weights[k];
    part(0) + part(1) + part(2)
}
