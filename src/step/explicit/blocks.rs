//! Passes over chunks: forces and kick of every block while its chunk is in the cache, and the end of a step; in
//! parallel over runs of chunks. No sum goes over more than a chunk, or over the parts of one block in their order.

use std::cell::RefCell;
use std::ops::Range;

use enmm_lanes::{Kernel, LANES, Lanes, Table, dispatch, prefetch};

use crate::contact::BlockImpulse;
use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::mechanics::block_lanes::{Common, End, Own, Reference, Span, Spread, Wants, WorkSums};
use crate::mechanics::{BlockMotion, BlockStart, Chunk, Chunks, Damping, KickStep, MassMatrix, element_lanes};
use crate::state::{Model, PatchSums, State};

use super::DECAY_MAX;

/// Covers below which a run of chunks is not split between threads.
const GRAIN: usize = 4096;
/// Covers from which on a step does not find them in the caches, and the next chunk is asked for in advance.
const ASKED: usize = 1 << 17;

/// Covers below which a run of chunks is not split between threads.
pub(super) fn grain(serial: bool) -> usize {
    if serial || rayon::current_num_threads() == 1 { usize::MAX } else { GRAIN }
}

thread_local! {
    /// Displacements and forces of the chunk in hand.
    static TABLES: RefCell<[Table; 2]> = RefCell::default();
}

/// Output slices that can be cut between chunks.
trait Cut: Sized + Send {
    /// The outputs of some covers, blocks and chunks, and the rest.
    fn cut(self, covers: usize, blocks: usize, chunks: usize) -> (Self, Self);

    /// Outputs on covers that are asked for before they are written.
    fn asked(&self) -> &[Vector] {
        &[]
    }
}

/// Work on a run of chunks with its outputs.
trait Work: Sync {
    type Out<'o>: Cut;
    /// Does the work on a chunk; `next` is what of the outputs behind it is asked for before it is written.
    fn chunk<L: Lanes>(&self, lanes: L, chunk: usize, out: Self::Out<'_>, next: &[Vector], tables: &mut [Table; 2]);
}

/// A run of chunks in the hands of one thread.
struct Run<'a, 'o, W: Work> {
    work: &'a W,
    chunks: &'a Chunks,
    range: Range<usize>,
    out: W::Out<'o>,
}

impl<W: Work> Run<'_, '_, W> {
    fn cut(self, at: usize) -> (Self, Self) {
        let Self { work, chunks, range, out } = self;
        let (start, end) = (chunks.get(range.start), chunks.get(at));
        let covers = end.covers.start - start.covers.start;
        let (left, right) = out.cut(covers, end.blocks.start - start.blocks.start, at - range.start);
        let run = |range, out| Self { work, chunks, range, out };
        (run(range.start..at, left), run(at..range.end, right))
    }

    /// Splits the run between threads down to `grain` covers.
    fn share(self, grain: usize) {
        let Range { start, end } = self.range;
        let covers = self.chunks.get(end - 1).covers.end - self.chunks.get(start).covers.start;
        if covers > grain && end - start > 1 {
            let (left, right) = self.cut(start + (end - start) / 2);
            rayon::join(|| left.share(grain), || right.share(grain));
        } else {
            TABLES.with_borrow_mut(|tables| dispatch(InHand { run: self, tables }));
        }
    }
}

/// A run with the tables of its thread.
struct InHand<'a, 'o, 't, W: Work> {
    run: Run<'a, 'o, W>,
    tables: &'t mut [Table; 2],
}

impl<W: Work> Kernel for InHand<'_, '_, '_, W> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { run: mut rest, tables } = self;
        while rest.range.len() > 1 {
            let next = rest.range.start + 1;
            let (first, others) = rest.cut(next);
            first.work.chunk(lanes, first.range.start, first.out, others.out.asked(), tables);
            rest = others;
        }
        rest.work.chunk(lanes, rest.range.start, rest.out, &[], tables);
    }
}

/// What every block of a step shares.
pub(super) struct Pass<'a> {
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
    /// Whether contacts, supports or bolts may ask for each cover.
    pub exposed: &'a [bool],
    /// Time (s) for which forces act.
    pub kick: f64,
    /// Forces of loads on covers (N/m); empty when nothing pushes.
    pub load_force: &'a [Vector],
}

impl Pass<'_> {
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
    fn own(&self, chunk: usize, block: BlockId, covers: Range<usize>, step: &KickStep) -> Own<'_> {
        let held = !self.mass_matrix.is_free(block);
        let (factor, masked) = match step.damping {
            Damping::Deformation(factor) => (factor, factor < 1.0),
            Damping::Mass(factor) => (factor, false),
        };
        Own {
            factor,
            kick: self.kick,
            acceleration: self.acceleration,
            held: held.then(|| {
                (&self.mass_matrix.row_sum[covers.clone()], inverse(self.mass_matrix, self.movable[chunk], covers))
            }),
            masked,
        }
    }

    /// What the chunk after this one will read.
    fn ahead<'a>(&'a self, chunk: &Chunk, next: &'a [Vector]) -> Ahead<'a> {
        let (start, count) = (chunk.covers.end, self.state.displacement.len());
        let end = if count < ASKED { start } else { (start + chunk.covers.len()).min(count) };
        let times = self.model.chunks.eights(chunk).div_ceil(element_lanes::TOGETHER).max(1);
        Ahead { pass: self, covers: start..end, next, piece: (end - start).div_ceil(times) }
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
            element_lanes::push_forces(lanes, chunks.rows(batch), (rock, in_row), tables, || ahead.ask());
            element_lanes::push_forces(lanes, chunks.groups(batch), (rock, in_group), tables, || ahead.ask());
        }
        if !self.state.plastic.is_empty() {
            self.relieve(chunk, &mut tables[1]);
        }
    }

    /// Adds what plastic strain takes from the forces of the elements of a chunk.
    #[inline(never)]
    fn relieve(&self, chunk: &Chunk, force: &mut Table) {
        let (model, chunks) = (self.model, &self.model.chunks);
        for batch in chunks.batches(chunk) {
            let Some(strength) = &model.strengths[batch.rock as usize] else { continue };
            let g = &model.covers.gradients[batch.set as usize];
            for (e, slots) in chunks.elements(batch) {
                let plastic = &self.state.plastic[e];
                if *plastic == [0.0; 4] {
                    continue;
                }
                let deformation = model.deformation(e, &self.state.displacement);
                let relief = strength.forces(&deformation, g, model.covers.element_area[e], plastic);
                slots.into_iter().zip(relief).for_each(|(slot, f)| *force.at_mut(slot) += f);
            }
        }
    }
}

/// Covers whose values will be read soon, and are asked for piece by piece: memory is slow to come, and idle while a
/// chunk is in hand.
struct Ahead<'a> {
    pass: &'a Pass<'a>,
    covers: Range<usize>,
    /// Predicted velocities from there on.
    next: &'a [Vector],
    piece: usize,
}

impl Ahead<'_> {
    #[inline(always)]
    fn ask(&mut self) {
        if self.covers.is_empty() {
            return;
        }
        let end = (self.covers.start + self.piece).min(self.covers.end);
        let covers = self.covers.start..end;
        self.covers.start = end;
        let (now, later) = self.next.split_at(covers.len().min(self.next.len()));
        self.next = later;
        prefetch(now);
        let Pass { model, state, mass_matrix, .. } = self.pass;
        prefetch(&state.displacement[covers.clone()]);
        prefetch(&state.velocity[covers.clone()]);
        prefetch(&model.covers.star_position[covers.clone()]);
        prefetch(&mass_matrix.mass[covers.clone()]);
        prefetch(&mass_matrix.row_sum[covers]);
    }
}

/// Output slices of a kick.
struct Kicked<'o> {
    predicted: &'o mut [Vector],
    motion: &'o mut [BlockMotion],
    start: &'o mut [BlockStart],
    sums: &'o mut [PatchSums],
}

impl Cut for Kicked<'_> {
    fn cut(self, covers: usize, blocks: usize, chunks: usize) -> (Self, Self) {
        let (predicted, predicted_rest) = self.predicted.split_at_mut(covers);
        let (motion, motion_rest) = self.motion.split_at_mut(blocks);
        let (start, start_rest) = self.start.split_at_mut(blocks);
        let (sums, sums_rest) = self.sums.split_at_mut(chunks);
        let rest = Kicked { predicted: predicted_rest, motion: motion_rest, start: start_rest, sums: sums_rest };
        (Kicked { predicted, motion, start, sums }, rest)
    }

    fn asked(&self) -> &[Vector] {
        self.predicted
    }
}

impl Work for Pass<'_> {
    type Out<'o> = Kicked<'o>;

    /// Forces and kick of the blocks of a chunk; of a part of a block all but what is common to the block.
    #[inline(always)]
    fn chunk<L: Lanes>(&self, lanes: L, number: usize, out: Kicked, next: &[Vector], tables: &mut [Table; 2]) {
        let chunk = self.model.chunks.get(number);
        let Kicked { predicted, motion, start, sums: [sums] } = out else { return };
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

impl Pass<'_> {
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
        sums: &mut PatchSums,
    ) {
        let covers = self.model.chunks.get(chunk).covers.clone();
        let (span, step, from) = (self.span(block, covers.clone()), self.step(block), self.reference(block));
        let own = self.own(chunk, block, covers, &step);
        (sums.block, sums.fastest) = span.sum_and_kick(lanes, &from, &own, (force, predicted));
    }

    /// Fills predicted velocities and block motions of the workspace, and the largest speed before.
    pub fn kick(&self, out: &mut KickOut) {
        let chunks = &self.model.chunks;
        let kicked = Kicked { predicted: out.predicted, motion: out.motion, start: out.start, sums: out.sums };
        Run { work: self, chunks, range: 0..chunks.len(), out: kicked }.share(self.grain);
        let mut is_cut = false;
        for first in chunks.cut_blocks() {
            is_cut |= self.join_parts(first, out);
        }
        if is_cut {
            let exposed = Exposed { pass: self, sums: out.sums, start: out.start };
            Run { work: &exposed, chunks, range: 0..chunks.len(), out: Predicted(out.predicted) }.share(self.grain);
        }
    }

    /// Joins the sums over the parts of a block; returns whether its covers have anything in common.
    fn join_parts(&self, first: usize, out: &mut KickOut) -> bool {
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
        common != Common::default()
    }
}

/// What a kick fills.
pub(super) struct KickOut<'a> {
    pub predicted: &'a mut [Vector],
    pub motion: &'a mut [BlockMotion],
    pub start: &'a mut [BlockStart],
    pub sums: &'a mut [PatchSums],
}

/// Adds what is common to a block to covers of its parts that contacts, supports or bolts may ask for.
struct Exposed<'a> {
    pass: &'a Pass<'a>,
    sums: &'a [PatchSums],
    start: &'a [BlockStart],
}

struct Predicted<'o>(&'o mut [Vector]);

impl Cut for Predicted<'_> {
    fn cut(self, covers: usize, _: usize, _: usize) -> (Self, Self) {
        let (left, right) = self.0.split_at_mut(covers);
        (Self(left), Self(right))
    }
}

impl Work for Exposed<'_> {
    type Out<'o> = Predicted<'o>;

    #[inline(always)]
    fn chunk<L: Lanes>(&self, lanes: L, k: usize, Predicted(predicted): Predicted, _: &[Vector], _: &mut [Table; 2]) {
        let Pass { model, mass_matrix, movable, exposed, .. } = *self.pass;
        let chunk = model.chunks.get(k);
        let Some(block) = chunk.part_of.filter(|&b| !mass_matrix.fixed[b]) else { return };
        if let Some(spread) = spread(mass_matrix, (chunk, block), movable[k], exposed, &self.sums[k].common) {
            let from = &self.start[block].from;
            self.pass.span(block, chunk.covers.clone()).spread(lanes, from, &spread, predicted);
        }
    }
}

/// What covers of a part of a block that can move have in common with the others of the block.
fn spread<'a>(
    mass_matrix: &'a MassMatrix,
    (part, block): (&Chunk, BlockId),
    movable: bool,
    exposed: &'a [bool],
    common: &'a Common,
) -> Option<Spread<'a>> {
    let covers = part.covers.clone();
    let inverse = inverse(mass_matrix, movable || mass_matrix.is_free(block), covers.clone());
    (*common != Common::default()).then(|| Spread { common, inverse, exposed: &exposed[covers] })
}

/// 1/m of covers unless they can all move.
fn inverse(mass_matrix: &MassMatrix, movable: bool, covers: Range<usize>) -> Option<&[Vector]> {
    (!movable).then(|| &mass_matrix.inverse[covers])
}

/// Share of the square of the distance of failure below which no mean over covers reaches it, however it is rounded.
const NEAR: f64 = 0.99;

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
    /// Whether contacts, supports or bolts may ask for each cover.
    pub exposed: &'a [bool],
    /// Time (s) for which covers move now: 0 where a report wants the positions before.
    pub moves_for: f64,
    /// Whether the work of body loads is asked for.
    pub is_loaded: bool,
    pub grain: usize,
}

/// Output slices of the end of a step.
pub(super) struct Finished<'o> {
    pub velocity: &'o mut [Vector],
    pub displacement: &'o mut [Vector],
    pub sums: &'o mut [PatchSums],
}

impl Cut for Finished<'_> {
    fn cut(self, covers: usize, _: usize, chunks: usize) -> (Self, Self) {
        let (velocity, velocity_rest) = self.velocity.split_at_mut(covers);
        let (displacement, displacement_rest) = self.displacement.split_at_mut(covers);
        let (sums, sums_rest) = self.sums.split_at_mut(chunks);
        let rest = Finished { velocity: velocity_rest, displacement: displacement_rest, sums: sums_rest };
        (Finished { velocity, displacement, sums }, rest)
    }
}

impl Work for Finish<'_> {
    type Out<'o> = Finished<'o>;

    #[inline(always)]
    fn chunk<L: Lanes>(&self, lanes: L, k: usize, out: Finished, _: &[Vector], _: &mut [Table; 2]) {
        let chunk = self.model.chunks.get(k);
        let Finished { velocity, displacement, sums: [sums] } = out else { return };
        (sums.works, sums.row_sum, sums.damping) = Default::default();
        (sums.fastest, sums.squares) = (0.0, 0.0);
        let mut farthest = 0.0;
        let common = sums.common;
        let blocks = chunk.part_of.map_or(chunk.blocks.clone(), |b| b.index()..b.index() + 1);
        for block in BlockId::range(blocks).filter(|&b| !self.mass_matrix.fixed[b]) {
            let own = self.model.covers.covers_of(block);
            let covers = own.start.max(chunk.covers.start)..own.end.min(chunk.covers.end);
            let local = covers.start - chunk.covers.start..covers.end - chunk.covers.start;
            let of_part = chunk
                .part_of
                .and_then(|_| spread(self.mass_matrix, (chunk, block), self.movable[k], self.exposed, &common));
            let mut end = End {
                spread: of_part,
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
        sums.is_near = farthest < NEAR * self.model.failure_displacement.powi(2);
    }
}

impl Finish<'_> {
    #[inline(always)]
    fn block<L: Lanes>(&self, lanes: L, block: BlockId, end: &mut End) -> (WorkSums, [f64; 2], f64) {
        let (mass_matrix, push, from) = (self.mass_matrix, &self.push[block], &self.start[block].from);
        let is_pushed = *push != BlockImpulse::default() && mass_matrix.is_free(block);
        let mut common = Common::default();
        if is_pushed {
            let share = mass_matrix.inverse_total[block];
            let velocity = (push.impulse * (1.0 + mass_matrix.square[block] * share) - push.weighted) * share;
            let centre = self.motion[block].centre - from.position;
            common = Common::about(velocity, mass_matrix.spin[block] * push.moment, centre);
            common.weighted = push.impulse * -share;
        }
        let is_damped = is_damping(self.damping[block]);
        let bits = end.increment.iter().fold(0, |bits, v| bits | v.x.to_bits() | v.y.to_bits());
        let wants =
            Wants { moves_for: self.moves_for, is_pushed, is_touched: bits != 0, is_damped, is_loaded: self.is_loaded };
        end.finish(lanes, from, &common, wants)
    }

    fn damping_work(&self, block: BlockId, works: &WorkSums) -> f64 {
        let damping = self.damping[block];
        if !is_damping(damping) {
            return 0.0;
        }
        self.start[block].damping_work(self.mass_matrix, block, works, damping)
    }

    /// Ends the step of all blocks.
    pub fn run(&self, out: Finished) -> Totals {
        let chunks = &self.model.chunks;
        let Finished { velocity, displacement, sums } = out;
        let out = Finished { velocity, displacement, sums: &mut *sums };
        Run { work: self, chunks, range: 0..chunks.len(), out }.share(self.grain);
        let mut totals = Totals::default();
        for sums in &*sums {
            totals.damping += sums.damping;
            totals.row_sum += sums.row_sum;
            totals.fastest = totals.fastest.max(sums.fastest);
            totals.squares += sums.squares;
        }
        for first in chunks.cut_blocks() {
            let mut works = WorkSums::default();
            chunks.parts(first).for_each(|part| works += sums[part].works);
            let block = BlockId::new(chunks.get(first).blocks.start);
            if !self.mass_matrix.fixed[block] {
                totals.damping += self.damping_work(block, &works);
            }
        }
        totals
    }
}

/// Sums over all covers at the end of a step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Totals {
    /// Work that damping took (J/m).
    pub damping: f64,
    /// Σ(∫ρw)(v + v') of velocities before and after the step (kg/s).
    pub row_sum: Vector,
    /// Square of the largest speed (m²/s²).
    pub fastest: f64,
    /// Sum of the squares of speeds (m²/s²): not finite when any is not.
    pub squares: f64,
}

/// Masses by which covers count in the centroid of a block: those of a held one are its lumped ones, read once.
fn inertial(mass_matrix: &MassMatrix, block: BlockId) -> &[f64] {
    if mass_matrix.is_free(block) { &mass_matrix.inertial } else { &mass_matrix.mass }
}

/// Whether damping takes anything.
fn is_damping(damping: Damping) -> bool {
    let (Damping::Deformation(factor) | Damping::Mass(factor)) = damping;
    factor < 1.0
}

/// Damping factor of one block: exp(−2ξπ·cs/√A·dt) relative to its rigid motion; or the common one, of a block that is
/// lighter by the root of that faster (Eq. 76).
pub(super) fn block_damping(model: &Model, mass_matrix: &MassMatrix, damping: Damping, block: BlockId) -> Damping {
    match damping {
        Damping::Deformation(ratio_dt) if ratio_dt > 0.0 => {
            Damping::Deformation((-(ratio_dt * model.block_frequency[block]).min(DECAY_MAX)).exp())
        }
        Damping::Deformation(_) => Damping::Deformation(1.0),
        Damping::Mass(factor) if mass_matrix.lightness > 1.0 && mass_matrix.is_free(block) => {
            Damping::Mass(factor.powf(mass_matrix.lightness.sqrt()).max((-DECAY_MAX).exp()))
        }
        mass => mass,
    }
}
