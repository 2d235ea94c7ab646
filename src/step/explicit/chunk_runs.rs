//! Work on all chunks, in parallel over runs of chunks. No sum goes over more than a chunk.

use std::cell::RefCell;
use std::ops::Range;

use enmm_lanes::{Kernel, Lanes, Table, dispatch};

use crate::geometry::Vector;
use crate::mechanics::Chunks;

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

/// Output slices that can be cut between chunks.
pub(super) trait Cut: Sized + Send {
    /// The outputs of some covers, blocks and chunks, and the rest.
    fn cut(self, covers: usize, blocks: usize, chunks: usize) -> (Self, Self);

    /// Outputs on covers that are prefetched before they are written.
    fn asked(&self) -> &[Vector] {
        &[]
    }
}

/// Work on a run of chunks with its outputs.
pub(super) trait Work: Sync {
    type Out<'o>: Cut;
    /// Does the work on a chunk; `next` are the following outputs, to prefetch.
    fn chunk<L: Lanes>(&self, lanes: L, chunk: usize, out: Self::Out<'_>, next: &[Vector], tables: &mut [Table; 2]);
}

/// A run of chunks in the hands of one thread.
pub(super) struct Run<'a, 'o, W: Work> {
    pub work: &'a W,
    pub chunks: &'a Chunks,
    pub range: Range<usize>,
    pub out: W::Out<'o>,
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
    pub fn share(self, grain: usize) {
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
