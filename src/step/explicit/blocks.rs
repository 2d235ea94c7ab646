//! Data of a block for kick and end of a step: its masses, and the velocity that its parts share.

use std::ops::Range;

use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::mechanics::block_lanes::{RigidScatter, RigidVelocity};
use crate::mechanics::{Chunk, MassMatrix};

/// Rigid-body velocity that the covers of a chunk receive from their block, when it can move.
pub(super) fn scatter<'a>(
    mass_matrix: &'a MassMatrix,
    (part, block): (&Chunk, BlockId),
    movable: bool,
    exposed: &'a [bool],
    common: &'a RigidVelocity,
) -> Option<RigidScatter<'a>> {
    let covers = part.covers.clone();
    let inverse = inverse(mass_matrix, movable || mass_matrix.is_free(block), covers.clone());
    (*common != RigidVelocity::default()).then(|| RigidScatter { common, inverse, exposed: &exposed[covers] })
}

/// 1/m of covers unless they can all move.
pub(super) fn inverse(mass_matrix: &MassMatrix, movable: bool, covers: Range<usize>) -> Option<&[Vector]> {
    (!movable).then(|| &mass_matrix.inverse[covers])
}

/// Masses by which covers count in the centroid of a block: those of a held one are its lumped ones, read once.
pub(super) fn inertial(mass_matrix: &MassMatrix, block: BlockId) -> &[f64] {
    if mass_matrix.is_free(block) { &mass_matrix.inertial } else { &mass_matrix.mass }
}
