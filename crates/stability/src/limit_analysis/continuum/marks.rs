//! Rock, joint and loads on both sides of a side of the drawing.

use enmm::model::tables::{BlockId, LawId};

/// Properties that are the same all along a side.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Marks {
    /// Block on its left.
    pub left: Option<BlockId>,
    /// Block on its right.
    pub right: Option<BlockId>,
    /// Law of the joint between them.
    pub law: Option<LawId>,
    /// Axes along which a fixity holds it.
    pub held: [bool; 2],
    /// Loads on it, by their place in the case.
    pub loads: Vec<usize>,
    /// Whether water reaches it.
    pub is_wet: bool,
    /// Whether it only parts two rocks of one block.
    pub is_seam: bool,
}
