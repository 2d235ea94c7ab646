//! The turn of blocks that spin: their covers have moved along tangents, and go on to the circles.

use enmm_lanes::{Lanes, Table};
use rayon::prelude::*;

use crate::contact::BlockImpulse;
use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::mechanics::{BlockStart, MassMatrix, Turn};
use crate::state::{ChunkSums, Model, MotionBuffers};

use super::chunk_runs::{self, ChunkLoop, ChunkSlices};
use super::finish::is_near;
use super::{Substep, report};

/// Blocks that one thread looks at, at least.
const BLOCKS: usize = 512;

/// Turns the blocks that spin, after a sub-step.
pub(super) fn turn(
    model: &Model,
    step: &Substep,
    mass_matrix: &MassMatrix,
    push: &[BlockImpulse],
    motion: &mut MotionBuffers,
    displacement: &mut [Vector],
    sums: &mut [ChunkSums],
) {
    let MotionBuffers { predicted, start, turns, .. } = motion;
    let of_block = |block| {
        let covers = report::block_covers(model, mass_matrix, displacement, predicted, block);
        spins(mass_matrix, block, &start[block], &push[block], step.dt).then(|| Turn::new(&covers, step.dt))
    };
    turns.resize(model.covers.block_count(), None);
    let each = |(k, turn): (usize, &mut Option<Turn>)| *turn = of_block(BlockId::new(k));
    if step.serial {
        turns.iter_mut().enumerate().for_each(each);
    } else {
        turns.par_iter_mut().with_min_len(BLOCKS).enumerate().for_each(each);
    }
    if turns.iter().any(Option::is_some) {
        let out = ChunkSlices { velocity: predicted, displacement, sums, ..ChunkSlices::default() };
        chunk_runs::run(&Turning { model, turns }, &model.chunks, out, chunk_runs::grain(step.serial));
    }
}

/// Whether a block turns in `dt` (s) by an angle above the rounding of double precision.
fn spins(mass_matrix: &MassMatrix, block: BlockId, start: &BlockStart, push: &BlockImpulse, dt: f64) -> bool {
    if !mass_matrix.is_free(block) {
        return false;
    }
    let angle = (start.spin().abs() + (push.moment / mass_matrix.polar[block]).abs()) * dt;
    angle * angle > Turn::NONE
}

/// The turn of all blocks.
struct Turning<'a> {
    model: &'a Model,
    turns: &'a [Option<Turn>],
}

impl ChunkLoop for Turning<'_> {
    #[inline(always)]
    fn chunk<L: Lanes>(&self, _: L, k: usize, out: ChunkSlices, _: &[Vector], _: &mut [Table; 2]) {
        let (chunk, covers) = (self.model.chunks.get(k), &self.model.covers);
        let ChunkSlices { velocity, displacement, sums: [sums], .. } = out else { return };
        let mut farthest = 0.0;
        for (block, own) in chunk.parts(covers) {
            let Some(turn) = &self.turns[block.index()] else { continue };
            for i in own {
                let at = i - chunk.covers.start;
                turn.apply(covers.star_position[i], &mut displacement[at], &mut velocity[at]);
                farthest = f64::max(farthest, displacement[at].norm_squared());
            }
        }
        sums.is_near &= is_near(self.model, farthest);
    }
}
