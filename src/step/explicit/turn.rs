//! The turn of blocks that spin: their covers have moved along tangents, and go on to the circles.

use enmm_lanes::{Lanes, Table};
use rayon::prelude::*;

use crate::contact::BlockImpulse;
use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::mechanics::{BlockStart, MassMatrix, Turn};
use crate::state::{Model, Workspace};

use super::chunk_runs::{self, Run, Work};
use super::finish::{Finished, is_near};
use super::{Step, report};

/// Blocks that one thread looks at, at least.
const BLOCKS: usize = 512;

impl Step<'_> {
    /// Turns the blocks that spin, after a step of `dt` (s).
    pub(super) fn turn(&mut self, dt: f64) {
        let (model, state) = (self.model, &mut *self.state);
        let Workspace { mass_matrix, predicted, start, push, sums, turns, serial, .. } = &mut *self.workspace;
        let of_block = |block| {
            let covers = report::block_covers(model, mass_matrix, &state.displacement, predicted, block);
            spins(mass_matrix, block, &start[block], &push[block], dt).then(|| Turn::new(&covers, dt))
        };
        turns.resize(model.covers.block_count(), None);
        let each = |(k, turn): (usize, &mut Option<Turn>)| *turn = of_block(BlockId::new(k));
        if *serial {
            turns.iter_mut().enumerate().for_each(each);
        } else {
            turns.par_iter_mut().with_min_len(BLOCKS).enumerate().for_each(each);
        }
        if turns.iter().any(Option::is_some) {
            let work = Turning { model, turns };
            let out = Finished { velocity: predicted, displacement: &mut state.displacement, sums };
            let chunks = &model.chunks;
            Run { work: &work, chunks, range: 0..chunks.len(), out }.share(chunk_runs::grain(*serial));
        }
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

impl Work for Turning<'_> {
    type Out<'o> = Finished<'o>;

    #[inline(always)]
    fn chunk<L: Lanes>(&self, _: L, k: usize, out: Finished, _: &[Vector], _: &mut [Table; 2]) {
        let (chunk, covers) = (self.model.chunks.get(k), &self.model.covers);
        let Finished { velocity, displacement, sums: [sums] } = out else { return };
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
