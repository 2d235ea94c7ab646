//! The end of a step: what contacts add to the velocities, new positions, sums for the works.

use enmm_lanes::{Lanes, Table};

use crate::contact::BlockImpulse;
use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::mechanics::block_lanes::{FinishFlags, FinishSlices, RigidVelocity, WorkSums};
use crate::mechanics::{BlockMotion, BlockStart, Damping, MassMatrix};
use crate::state::{ChunkSums, Model};

use super::blocks::{inertial, scatter};
use super::chunk_runs::{self, ChunkLoop, ChunkSlices};
use super::damp::is_damping;

/// Share of the square of the distance of failure below which no mean over covers reaches it, however it is rounded.
const NEAR: f64 = 0.99;

/// Whether no cover is as far as the distance of failure, given the largest square of a displacement (m²).
pub(super) fn is_near(model: &Model, farthest: f64) -> bool {
    farthest < NEAR * model.failure_displacement.powi(2)
}

/// The end of a step: contacts' part of the velocities, new positions, sums for the works.
pub(super) struct Finish<'a> {
    pub model: &'a Model,
    pub mass_matrix: &'a MassMatrix,
    /// Velocities before the step (m/s).
    pub before: &'a [Vector],
    pub motion: &'a [BlockMotion],
    pub start: &'a [BlockStart],
    pub push: &'a [BlockImpulse],
    /// Velocity increments of covers by contacts and supports (m/s).
    pub increment: &'a [Vector],
    /// Damping of each block.
    pub damping: &'a [Damping],
    /// Whether all covers of each chunk can move along both axes.
    pub movable: &'a [bool],
    /// Whether contacts, supports or bolts may read each cover.
    pub exposed: &'a [bool],
    /// Time (s) for which covers move now: 0 where a report wants the positions before.
    pub moves_for: f64,
    /// Whether the work of body loads is needed.
    pub is_loaded: bool,
    pub grain: usize,
}

impl ChunkLoop for Finish<'_> {
    #[inline(always)]
    fn chunk<L: Lanes>(&self, lanes: L, k: usize, out: ChunkSlices, _: &[Vector], _: &mut [Table; 2]) {
        let chunk = self.model.chunks.get(k);
        let ChunkSlices { velocity, displacement, sums: [sums], .. } = out else { return };
        (sums.works, sums.row_sum, sums.damping) = Default::default();
        (sums.fastest, sums.squares) = (0.0, 0.0);
        let mut farthest = 0.0;
        let common = sums.common;
        for (block, covers) in chunk.parts(&self.model.covers).filter(|&(b, _)| !self.mass_matrix.fixed[b]) {
            let local = covers.start - chunk.covers.start..covers.end - chunk.covers.start;
            let of_part = chunk
                .part_of
                .and_then(|_| scatter(self.mass_matrix, (chunk, block), self.movable[k], self.exposed, &common));
            let mut end = FinishSlices {
                scatter: of_part,
                star: &self.model.covers.star_position[covers.clone()],
                mass: &self.mass_matrix.mass[covers.clone()],
                inertial: &inertial(self.mass_matrix, block)[covers.clone()],
                row_sum: &self.mass_matrix.row_sum[covers.clone()],
                before: &self.before[covers.clone()],
                increment: &self.increment[covers],
                velocity: &mut velocity[local.clone()],
                displacement: &mut displacement[local],
            };
            let (works, speeds, distance) = self.block(lanes, block, &mut end);
            (sums.fastest, sums.squares) = (sums.fastest.max(speeds[0]), sums.squares + speeds[1]);
            farthest = f64::max(farthest, distance);
            sums.row_sum += works.row_sum;
            if chunk.part_of.is_some() {
                sums.works = works;
            } else {
                sums.damping += self.damping_work(block, &works);
            }
        }
        sums.is_near = is_near(self.model, farthest);
    }
}

impl Finish<'_> {
    #[inline(always)]
    fn block<L: Lanes>(&self, lanes: L, block: BlockId, end: &mut FinishSlices) -> (WorkSums, [f64; 2], f64) {
        let (mass_matrix, push, from) = (self.mass_matrix, &self.push[block], &self.start[block].from);
        let is_pushed = *push != BlockImpulse::default() && mass_matrix.is_free(block);
        let mut common = RigidVelocity::default();
        if is_pushed {
            let share = mass_matrix.inverse_total[block];
            let velocity = (push.impulse * (1.0 + mass_matrix.square[block] * share) - push.weighted) * share;
            let centre = self.motion[block].centre - from.position;
            common = RigidVelocity::about(velocity, mass_matrix.spin[block] * push.moment, centre);
            common.weighted = push.impulse * -share;
        }
        let is_damped = is_damping(self.damping[block]);
        let bits = end.increment.iter().fold(0, |bits, v| bits | v.x.to_bits() | v.y.to_bits());
        let flags = FinishFlags {
            moves_for: self.moves_for,
            is_pushed,
            is_touched: bits != 0,
            is_damped,
            is_loaded: self.is_loaded,
        };
        end.finish(lanes, from, &common, flags)
    }

    fn damping_work(&self, block: BlockId, works: &WorkSums) -> f64 {
        let damping = self.damping[block];
        if !is_damping(damping) {
            return 0.0;
        }
        self.start[block].damping_work(self.mass_matrix, block, works, damping)
    }

    /// Ends the step of all blocks; returns the sums over all chunks.
    pub fn run(&self, out: ChunkSlices) -> ChunkSums {
        let chunks = &self.model.chunks;
        let ChunkSlices { velocity, displacement, motion, start, sums: of_chunks } = out;
        let out = ChunkSlices { velocity, displacement, motion, start, sums: &mut *of_chunks };
        chunk_runs::run(self, chunks, out, self.grain);
        let mut totals = ChunkSums::default();
        for sums in &*of_chunks {
            totals.damping += sums.damping;
            totals.row_sum += sums.row_sum;
            totals.fastest = totals.fastest.max(sums.fastest);
            totals.squares += sums.squares;
        }
        for first in chunks.cut_blocks() {
            let mut works = WorkSums::default();
            chunks.parts(first).for_each(|part| works += of_chunks[part].works);
            let block = BlockId::new(chunks.get(first).blocks.start);
            if !self.mass_matrix.fixed[block] {
                totals.damping += self.damping_work(block, &works);
            }
        }
        totals
    }
}
