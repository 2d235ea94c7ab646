//! The kick: forces and predicted velocities of every block while its chunk is in the cache. Sums over the parts of one
//! block are joined in their order.

use std::ops::Range;

use enmm_lanes::{LANES, Lanes, Table, prefetch};

use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::mechanics::block_lanes::{CoverKick, Reference, RigidVelocity, Span};
use crate::mechanics::chunk::YieldPlaces;
use crate::mechanics::element_lanes::{self, Elastic, Relief};
use crate::mechanics::{
    BlockMotion, BlockStart, Chunk, Damping, Deformation, KickStep, MassMatrix, Strained, YieldingRock,
};
use crate::state::{ChunkSums, Model, MotionBuffers, State, YieldBuffers};

use super::blocks::{inertial, inverse, scatter};
use super::chunk_runs::{self, ChunkLoop, ChunkSlices};
use super::{Substep, applied, records};

/// Covers from which on a step does not find them in the caches, and the next chunk is prefetched.
const ASKED: usize = 1 << 17;

/// Data that every block of a step shares.
struct Kick<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    pub mass_matrix: &'a MassMatrix,
    pub acceleration: Vector,
    /// Covers below which a run of chunks is not split between threads.
    pub grain: usize,
    /// Damping of each block.
    pub damping: &'a [Damping],
    /// Whether all covers of each chunk can move along both axes.
    pub movable: &'a [bool],
    /// Whether contacts, supports or bolts may read each cover.
    pub exposed: &'a [bool],
    /// Time (s) for which forces act.
    pub kick: f64,
    /// Forces of loads on covers (N/m); empty when nothing pushes.
    pub load_force: &'a [Vector],
    /// Mean stress (Pa) of each patch of elements that average it.
    pub patch_mean: &'a [[f64; 2]],
}

/// Internal forces and the kick of every block, with the forces of loads and without those of contacts.
pub(super) fn predict(
    model: &Model,
    state: &State,
    step: &Substep,
    (load_force, yielding): (&[Vector], &YieldBuffers),
    mass_matrix: &mut MassMatrix,
    motion: &mut MotionBuffers,
    sums: &mut [ChunkSums],
) {
    let MotionBuffers { predicted, blocks, start, damping, movable, exposed, speed_max, .. } = motion;
    let kick = Kick {
        model,
        state,
        mass_matrix,
        acceleration: acceleration(model, state, step),
        damping,
        movable,
        exposed,
        kick: step.kick,
        grain: chunk_runs::grain(step.serial),
        load_force,
        patch_mean: &yielding.averages.patch_mean,
    };
    kick.run(ChunkSlices { velocity: predicted, motion: blocks, start, sums, ..ChunkSlices::default() });
    *speed_max = sums.iter().map(|s| s.fastest).fold(0.0, f64::max).sqrt();
    for (spin, motion) in mass_matrix.spin.iter_mut().zip(blocks) {
        *spin = motion.spin;
    }
}

/// Acceleration of all rock (m/s²) while forces act.
pub(super) fn acceleration(model: &Model, state: &State, step: &Substep) -> Vector {
    let base = records::base_motion(model, step.regime, state, step.window);
    applied::acceleration(model, state, step.time) * step.ramp(state) - base
}

impl Kick<'_> {
    fn step(&self, block: BlockId) -> KickStep {
        KickStep { acceleration: self.acceleration, damping: self.damping[block], kick: self.kick }
    }

    fn span(&self, block: BlockId, covers: Range<usize>) -> Span<'_> {
        Span {
            star: &self.model.covers.star_position[covers.clone()],
            displacement: &self.state.displacement[covers.clone()],
            velocity: &self.state.velocity[covers.clone()],
            mass: &self.mass_matrix.mass[covers.clone()],
            inertial: &inertial(self.mass_matrix, block)[covers],
        }
    }

    fn reference(&self, block: BlockId) -> Reference {
        self.span(block, self.model.covers.covers_of(block)).reference()
    }

    /// How the covers of a block in a chunk are written.
    fn own(&self, chunk: usize, block: BlockId, covers: Range<usize>, step: &KickStep) -> CoverKick<'_> {
        let held = !self.mass_matrix.is_free(block);
        let (factor, masked) = match step.damping {
            Damping::Deformation(factor) => (factor, factor < 1.0),
            Damping::Mass(factor) => (factor, false),
        };
        CoverKick {
            factor,
            kick: self.kick,
            acceleration: self.acceleration,
            held: held.then(|| {
                (&self.mass_matrix.row_sum[covers.clone()], inverse(self.mass_matrix, self.movable[chunk], covers))
            }),
            masked,
        }
    }

    /// Prefetches the data that the chunk after this one will read, a piece with each call, while this one is computed.
    fn ahead<'a>(&'a self, chunk: &Chunk, mut next: &'a [Vector]) -> impl FnMut() + use<'a> {
        let Kick { model, state, mass_matrix, .. } = self;
        let (start, count) = (chunk.covers.end, state.displacement.len());
        let end = if count < ASKED { start } else { (start + chunk.covers.len()).min(count) };
        let times = model.chunks.eights(chunk).div_ceil(element_lanes::TOGETHER).max(1);
        let (mut covers, piece) = (start..end, (end - start).div_ceil(times));
        move || {
            if covers.is_empty() {
                return;
            }
            let range = covers.start..(covers.start + piece).min(covers.end);
            covers.start = range.end;
            let (now, later) = next.split_at(range.len().min(next.len()));
            next = later;
            prefetch(now);
            prefetch(&state.displacement[range.clone()]);
            prefetch(&state.velocity[range.clone()]);
            prefetch(&model.covers.star_position[range.clone()]);
            prefetch(&mass_matrix.mass[range.clone()]);
            prefetch(&mass_matrix.row_sum[range]);
        }
    }

    /// Adds the element forces of a chunk to the table of its covers (Eq. 7).
    #[inline(always)]
    fn push_elements<L: Lanes>(&self, lanes: L, chunk: &Chunk, next: &[Vector], tables: &mut [Table; 2]) {
        let (model, u) = (self.model, &self.state.displacement);
        let chunks = &model.chunks;
        let [displacement, force] = &mut *tables;
        let (own, halo) = (chunk.covers.len(), chunks.halo(chunk));
        let local = displacement.first_mut(own + halo.len() + LANES);
        let (local, behind) = local.split_at_mut(own + halo.len());
        local[..own].copy_from_slice(&u[chunk.covers.clone()]);
        for (pair, &cover) in local[own..].iter_mut().zip(halo) {
            *pair = u[cover];
        }
        // Missing elements of a row may reach beyond the last slot.
        behind.fill(Vector::zeros());
        lanes.clear(force, own + halo.len() + LANES);
        if let Some(load) = self.load_force.get(chunk.covers.clone()) {
            force.first_mut(own).copy_from_slice(load);
        }
        let mut ahead = self.ahead(chunk, next);
        for batch in chunks.batches(chunk) {
            let rock = &model.rocks[batch.rock as usize];
            let [in_row, in_group] = chunks.gradients(batch, &model.covers.gradients[batch.set as usize]);
            if let Some(strength) = &model.strengths[batch.rock as usize] {
                let relief = Yielded { strength, kick: self };
                element_lanes::push_forces(lanes, chunks.groups(batch), (rock, in_group, relief), tables, &mut ahead);
                continue;
            }
            element_lanes::push_forces(lanes, chunks.rows(batch), (rock, in_row, Elastic), tables, &mut ahead);
            element_lanes::push_forces(lanes, chunks.groups(batch), (rock, in_group, Elastic), tables, &mut ahead);
        }
    }
}

/// Rock with plastic strain and averages of its patches.
#[derive(Clone, Copy)]
struct Yielded<'a> {
    strength: &'a YieldingRock,
    kick: &'a Kick<'a>,
}

impl Relief for Yielded<'_> {
    #[inline(always)]
    fn taken_off<L: Lanes>(&self, lanes: L, of: Option<&YieldPlaces>, at: &Deformation<L::F>) -> Option<[L::F; 4]> {
        let ((patches, plastic), Kick { state, patch_mean, .. }) = (of?, self.kick);
        let plastic = plastic.of(lanes, &state.plastic);
        let [mean, _] = patches.means(lanes, patch_mean);
        let more = self.strength.more(&Strained { deformation: *at, mean }, &plastic);
        let more = lanes.select(patches.outside, lanes.splat(0.0), more);
        Some(self.strength.taken_off(at, &plastic, more))
    }
}

impl ChunkLoop for Kick<'_> {
    /// Forces and kick of the blocks of a chunk; of a part of a block all but what is common to the block.
    #[inline(always)]
    fn chunk<L: Lanes>(&self, lanes: L, number: usize, out: ChunkSlices, next: &[Vector], tables: &mut [Table; 2]) {
        let chunk = self.model.chunks.get(number);
        let ChunkSlices { velocity: predicted, motion, start, sums: [sums], .. } = out else { return };
        sums.fastest = 0.0;
        let fixed = match chunk.part_of {
            Some(block) => self.mass_matrix.fixed[block],
            None => chunk.blocks.clone().all(|b| self.mass_matrix.fixed[b]),
        };
        if fixed {
            let squares = self.state.velocity[chunk.covers.clone()].iter().map(|v| v.norm_squared());
            sums.fastest = squares.fold(0.0, f64::max);
            predicted.fill(Vector::zeros());
            motion.fill(BlockMotion::default());
            return;
        }
        self.push_elements(lanes, chunk, next, tables);
        let force = tables[1].first(chunk.covers.len());
        if let Some(block) = chunk.part_of {
            self.kick_part(lanes, (number, block), force, predicted, sums);
            return;
        }
        for (k, block) in BlockId::range(chunk.blocks.clone()).enumerate() {
            let covers = self.model.covers.covers_of(block);
            let local = covers.start - chunk.covers.start..covers.end - chunk.covers.start;
            let (force, predicted) = (&force[local.clone()], &mut predicted[local]);
            (motion[k], start[k]) = self.kick_block(lanes, (number, block), force, predicted, &mut sums.fastest);
        }
    }
}

impl Kick<'_> {
    #[inline(always)]
    fn kick_block<L: Lanes>(
        &self,
        lanes: L,
        (chunk, block): (usize, BlockId),
        force: &[Vector],
        predicted: &mut [Vector],
        fastest: &mut f64,
    ) -> (BlockMotion, BlockStart) {
        let covers = self.model.covers.covers_of(block);
        if self.mass_matrix.fixed[block] {
            let squares = self.state.velocity[covers].iter().map(|v| v.norm_squared());
            *fastest = squares.fold(*fastest, f64::max);
            predicted.fill(Vector::zeros());
            return Default::default();
        }
        let (span, step) = (self.span(block, covers.clone()), self.step(block));
        let from = span.reference();
        let sums = span.sums(lanes, &from, self.mass_matrix.is_free(block).then_some(force));
        let start = BlockStart::new(self.mass_matrix, block, from, &sums);
        let common = start.common(self.mass_matrix, block, &sums, &step);
        let own = self.own(chunk, block, covers, &step);
        *fastest = fastest.max(span.kick(lanes, &from, &own, &common, (force, predicted)));
        (start.motion(self.mass_matrix, block), start)
    }

    #[inline(always)]
    fn kick_part<L: Lanes>(
        &self,
        lanes: L,
        (chunk, block): (usize, BlockId),
        force: &[Vector],
        predicted: &mut [Vector],
        sums: &mut ChunkSums,
    ) {
        let covers = self.model.chunks.get(chunk).covers.clone();
        let (span, step, from) = (self.span(block, covers.clone()), self.step(block), self.reference(block));
        let own = self.own(chunk, block, covers, &step);
        (sums.block, sums.fastest) = span.sum_and_kick(lanes, &from, &own, (force, predicted));
    }

    /// Fills predicted velocities, block motions, and the sums of chunks with the largest speed before.
    fn run(&self, mut out: ChunkSlices) {
        let chunks = &self.model.chunks;
        let ChunkSlices { velocity, displacement, motion, start, sums } = &mut out;
        chunk_runs::run(self, chunks, ChunkSlices { velocity, displacement, motion, start, sums }, self.grain);
        let mut is_cut = false;
        for first in chunks.cut_blocks() {
            is_cut |= self.join_parts(first, &mut out);
        }
        if is_cut {
            let scatter = Scatter { kick: self, start: out.start };
            let out = ChunkSlices { velocity: out.velocity, sums: out.sums, ..ChunkSlices::default() };
            chunk_runs::run(&scatter, chunks, out, self.grain);
        }
    }

    /// Joins the sums over the parts of a block; returns whether its covers have anything in common.
    fn join_parts(&self, first: usize, out: &mut ChunkSlices) -> bool {
        let chunks = &self.model.chunks;
        let block = BlockId::new(chunks.get(first).blocks.start);
        if self.mass_matrix.fixed[block] {
            return false;
        }
        let mut sums = out.sums[first].block;
        let parts = chunks.parts(first);
        parts.clone().skip(1).for_each(|part| sums += out.sums[part].block);
        let start = BlockStart::new(self.mass_matrix, block, self.reference(block), &sums);
        let common = start.common(self.mass_matrix, block, &sums, &self.step(block));
        parts.for_each(|part| out.sums[part].common = common);
        (out.motion[block], out.start[block]) = (start.motion(self.mass_matrix, block), start);
        common != RigidVelocity::default()
    }
}

/// Adds the rigid-body velocity of a block to covers of its parts that contacts, supports or bolts may read.
struct Scatter<'a> {
    kick: &'a Kick<'a>,
    start: &'a [BlockStart],
}

impl ChunkLoop for Scatter<'_> {
    #[inline(always)]
    fn chunk<L: Lanes>(&self, lanes: L, k: usize, out: ChunkSlices, _: &[Vector], _: &mut [Table; 2]) {
        let Kick { model, mass_matrix, movable, exposed, .. } = *self.kick;
        let ChunkSlices { velocity: predicted, sums: [sums], .. } = out else { return };
        let chunk = model.chunks.get(k);
        let Some(block) = chunk.part_of.filter(|&b| !mass_matrix.fixed[b]) else { return };
        if let Some(scatter) = scatter(mass_matrix, (chunk, block), movable[k], exposed, &sums.common) {
            let from = &self.start[block].from;
            self.kick.span(block, chunk.covers.clone()).scatter(lanes, from, &scatter, predicted);
        }
    }
}
