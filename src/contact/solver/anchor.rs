//! Bodies under impulses: what a material point of a block moves by, and what its block keeps of them (Eq. 17).

use crate::contact::Pair;
use crate::contact::pair::{common_share, velocity_of_body};
use crate::cover::{BlockId, CoverId};
use crate::geometry::Vector;

use super::SolverView;

/// Impulse sums of a block: what turns one contact's impulse into everybody's velocity in constant time (Eq. 17).
#[doc(alias = "solver velocity")]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BlockImpulse {
    /// P = Σ impulses (N·s/m).
    pub impulse: Vector,
    /// Z = Σ z·impulse (N·s/m).
    pub weighted: Vector,
    /// L = Σ arm × impulse (N·m·s/m).
    pub moment: f64,
}

/// The same within the iteration: P, Z/M (m/s), L beside the sequence number at which the block last moved by more
/// than what has settled, and the centroid of the block (m).
pub type PackedImpulse = [Vector; PACKED];
/// Pairs of numbers of a [`PackedImpulse`].
pub const PACKED: usize = 4;

/// A run of blocks under impulses.
pub struct Accumulators<'a> {
    /// √m times the velocity increment of each cover by its own impulses (kg½·m½/s).
    pub cover_impulse: &'a mut [Vector],
    /// First cover of the run.
    pub first_cover: CoverId,
    /// Impulse sums of the blocks.
    pub block_impulse: &'a mut [PackedImpulse],
    /// First block of the run.
    pub first_block: BlockId,
}

impl Accumulators<'_> {
    /// Notes the sequence number at which a block of the run moves. Numbers grow.
    pub fn mark(&mut self, block: BlockId, number: u32) {
        self.block_impulse[block.index() - self.first_block.index()][2].y = f64::from(number);
    }

    /// The runs before and from a block whose first cover is `cover` on.
    pub fn split(&mut self, block: BlockId, cover: CoverId) -> (Accumulators<'_>, Accumulators<'_>) {
        let Accumulators { first_cover, first_block, .. } = *self;
        let (cover_impulse, covers) = self.cover_impulse.split_at_mut(cover.index() - first_cover.index());
        let (block_impulse, blocks) = self.block_impulse.split_at_mut(block.index() - first_block.index());
        let before = Accumulators { cover_impulse, first_cover, block_impulse, first_block };
        (before, Accumulators { cover_impulse: covers, first_cover: cover, block_impulse: blocks, first_block: block })
    }
}

/// A material point of a block. Weights are divided by the roots of the covers' masses, so that the same ones give and
/// take.
#[derive(Debug, Clone, Copy, Default)]
pub struct Anchor {
    /// Covers.
    pub covers: [CoverId; 3],
    /// w/√m along each axis, 0 where held.
    pub weights: [Vector; 3],
    /// Block, or none when it is held: it then moves by its covers alone.
    pub block: Option<BlockId>,
    /// J90·(arm from the block's centroid) (m).
    pub lever: Vector,
    /// z/M (m/kg).
    pub mass_share: f64,
    /// (1 + S/M)/M (m/kg).
    pub common: f64,
    /// C of the block.
    pub spin: f64,
}

impl Anchor {
    /// Point `k` of a pair, at the end of an `arm` (m) from the centroid of its block.
    pub fn new(pair: &Pair, k: usize, arm: Vector, view: &SolverView) -> Self {
        let SolverView { mass_matrix, .. } = view;
        let (block, covers) = (pair.blocks[k], pair.covers[k]);
        let mut weights = [Vector::zeros(); 3];
        for j in 0..3 {
            weights[j] = mass_matrix.inverse[covers[j]].map(f64::sqrt) * pair.weights[k][j];
        }
        if !mass_matrix.is_free(block) {
            return Self { covers, weights, block: None, ..Self::default() };
        }
        Self {
            covers,
            weights,
            block: Some(block),
            lever: Vector::new(-arm.y, arm.x),
            mass_share: pair.z(k, mass_matrix) * mass_matrix.inverse_total[block],
            common: common_share(mass_matrix, block),
            spin: mass_matrix.spin[block],
        }
    }

    /// Velocity (m/s) that all impulses so far give it.
    pub fn velocity(&self, accumulators: &Accumulators) -> Vector {
        let cover_impulse = |j: usize| {
            self.weights[j]
                .component_mul(&accumulators.cover_impulse[self.covers[j].index() - accumulators.first_cover.index()])
        };
        let velocity = cover_impulse(0) + cover_impulse(1) + cover_impulse(2);
        let Some(block) = self.block else { return velocity };
        let [impulse, weighted, moment, _] =
            accumulators.block_impulse[block.index() - accumulators.first_block.index()];
        let (share, turn) = (self.common - self.mass_share, self.spin * moment.x);
        velocity + Vector::from(velocity_of_body(impulse.into(), weighted.into(), turn, share, self.lever.into()))
    }

    /// Takes an impulse (N·s/m).
    pub fn push(&self, impulse: Vector, accumulators: &mut Accumulators) {
        for (cover, weight) in self.covers.iter().zip(&self.weights) {
            accumulators.cover_impulse[cover.index() - accumulators.first_cover.index()] +=
                weight.component_mul(&impulse);
        }
        if let Some(block) = self.block {
            let block_impulse = &mut accumulators.block_impulse[block.index() - accumulators.first_block.index()];
            block_impulse[0] += impulse;
            block_impulse[1] += impulse * self.mass_share;
            block_impulse[2].x += self.lever.dot(&impulse);
        }
    }
}
