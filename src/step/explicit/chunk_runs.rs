//! Work on all chunks, in parallel over runs of chunks. No sum goes over more than a chunk.

use std::cell::RefCell;
use std::ops::Range;

use enmm_lanes::{Kernel, Lanes, Table, dispatch};

use crate::geometry::Vector;
use crate::mechanics::{BlockMotion, BlockStart, Chunks};
use crate::state::ChunkSums;

/// Covers below which a run of chunks is not split between threads.
const GRAIN: usize = 4096;

/// Covers below which a run of chunks is not split between threads.
pub(super) fn grain(serial: bool) -> usize {
    if serial || rayon::current_num_threads() == 1 { usize::MAX } else { GRAIN }
}

thread_local! {
    /// Displacements and forces of the chunk in hand.
    static TABLES: RefCell<[Table; 2]> = RefCell::default();
}

/// Slices that loops over chunks write: for all chunks, for a run of them or for one. A loop leaves out what it does
/// not write.
#[derive(Default)]
pub(super) struct ChunkSlices<'o> {
    /// Velocities of covers (m/s).
    pub velocity: &'o mut [Vector],
    /// Displacements of covers (m).
    pub displacement: &'o mut [Vector],
    /// Centroid and spin of blocks.
    pub motion: &'o mut [BlockMotion],
    /// How blocks moved at the start of the step.
    pub start: &'o mut [BlockStart],
    /// Sums over each chunk.
    pub sums: &'o mut [ChunkSums],
}

impl ChunkSlices<'_> {
    /// The slices of some covers, blocks and chunks, and the rest.
    fn cut(self, covers: usize, blocks: usize, chunks: usize) -> (Self, Self) {
        let (velocity, v) = split(self.velocity, covers);
        let (displacement, u) = split(self.displacement, covers);
        let (motion, m) = split(self.motion, blocks);
        let (start, from) = split(self.start, blocks);
        let (sums, s) = split(self.sums, chunks);
        let rest = Self { velocity: v, displacement: u, motion: m, start: from, sums: s };
        (Self { velocity, displacement, motion, start, sums }, rest)
    }
}

/// Cuts a slice, which may be left out.
fn split<T>(slice: &mut [T], at: usize) -> (&mut [T], &mut [T]) {
    let at = at.min(slice.len());
    slice.split_at_mut(at)
}

/// A loop over chunks.
pub(super) trait ChunkLoop: Sync {
    /// Does the work on a chunk; `next` are the velocities behind its own, to prefetch.
    fn chunk<L: Lanes>(&self, lanes: L, chunk: usize, out: ChunkSlices, next: &[Vector], tables: &mut [Table; 2]);
}

/// Does a loop over all chunks, split between threads down to `grain` covers.
pub(super) fn run<W: ChunkLoop>(work: &W, chunks: &Chunks, out: ChunkSlices, grain: usize) {
    Run { work, chunks, range: 0..chunks.len(), out }.share(grain);
}

/// A run of chunks in the hands of one thread.
struct Run<'a, 'o, W> {
    work: &'a W,
    chunks: &'a Chunks,
    range: Range<usize>,
    out: ChunkSlices<'o>,
}

impl<W: ChunkLoop> Run<'_, '_, W> {
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
struct InHand<'a, 'o, 't, W> {
    run: Run<'a, 'o, W>,
    tables: &'t mut [Table; 2],
}

impl<W: ChunkLoop> Kernel for InHand<'_, '_, '_, W> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Self { run: mut rest, tables } = self;
        while rest.range.len() > 1 {
            let next = rest.range.start + 1;
            let (first, others) = rest.cut(next);
            first.work.chunk(lanes, first.range.start, first.out, others.out.velocity, tables);
            rest = others;
        }
        rest.work.chunk(lanes, rest.range.start, rest.out, &[], tables);
    }
}
