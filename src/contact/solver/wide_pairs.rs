//! Eight block pairs of one group that are solved side by side: what their blocks have in common, kept in registers.

use std::ops::Range;

use enmm_lanes::{First, LANES, Lanes, Places, Values};

use crate::contact::pair::common_share;
use crate::cover::BlockId;

use super::SolverView;
use super::anchor::{Accumulators, PACKED};
use super::wide_block::{F64x8, WideBlock, first, put_first};
use super::wide_contact::{ContactView, WideContact};
use super::wide_point::Bodies;

/// Change of a force, over what counts as settled, from which its bodies have moved.
const MOVES: f64 = 0.3;

/// Up to eight block pairs; lanes beyond them repeat the first one without taking part. Numbers begin at lines of the
/// cache.
#[doc(alias = "SIMD")]
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct WidePairs {
    /// (1 + S/M)/M (m/kg), C, and 1 for blocks that keep impulses; all 0 for others.
    common: [F64x8; 2],
    spin: [F64x8; 2],
    unit: [F64x8; 2],
    /// Sequence number up to which each pair is solved; pairs whose blocks have not moved since are skipped.
    solved: F64x8,
    /// A pair that is solved gets `share`·number + `shift`: a single contact also counts its own impulse as solved,
    /// block pairs without a free block are solved in every sweep, lanes without a block pair in none.
    share: F64x8,
    shift: F64x8,
    /// Blocks of the first and of the second points of each block pair.
    blocks: [[BlockId; LANES]; 2],
    /// Where the sums of the blocks begin in a run of blocks, those of a free one in the place of a held one.
    sums: [Places; 2],
    /// First row.
    pub first_row: u32,
    /// Number of rows, the contacts of the longest block pair, and of those with more than one contact.
    pub rows: u32,
    wide: u32,
    /// Number of contacts.
    pub contacts: u32,
    /// Largest force (N/m).
    pub force: f64,
}

/// By what changes are measured, and when.
#[derive(Debug, Clone, Copy)]
pub struct ChangeMeasure {
    /// Force (N/m) that counts at least as the size of a force.
    pub floor: f64,
    /// Sequence number of this solution of the block pairs; it grows with each.
    pub number: u32,
}

impl WidePairs {
    /// Block pairs by their blocks, a free one first when there is one, and numbers of contacts, the longest first;
    /// their rows begin at `first_row`.
    #[inline(always)]
    pub fn new(
        first_row: u32,
        block_pairs: impl ExactSizeIterator<Item = ([BlockId; 2], u32)>,
        view: &SolverView,
    ) -> Self {
        let mut wide_pairs = Self {
            first_row,
            rows: 0,
            wide: 0,
            contacts: 0,
            blocks: [[BlockId::default(); LANES]; 2],
            sums: [Places::default(); 2],
            common: [[0.0; LANES]; 2],
            spin: [[0.0; LANES]; 2],
            unit: [[0.0; LANES]; 2],
            solved: [0.0; LANES],
            share: [0.0; LANES],
            shift: [f64::INFINITY; LANES],
            force: 0.0,
        };
        let count = block_pairs.len();
        for (lane, (blocks, contacts)) in block_pairs.enumerate() {
            wide_pairs.take(lane, blocks, contacts, view);
        }
        for blocks in &mut wide_pairs.blocks {
            let first = blocks[0];
            blocks[count..].fill(first);
        }
        wide_pairs
    }

    #[inline(always)]
    fn take(&mut self, lane: usize, blocks: [BlockId; 2], contacts: u32, view: &SolverView) {
        let [a, b] = blocks;
        let free = blocks.map(|block| view.mass_matrix.is_free(block));
        self.contacts += contacts;
        if lane == 1 {
            self.wide = contacts;
        }
        self.rows = self.rows.max(contacts);
        self.share[lane] = f64::from(free[0]);
        self.shift[lane] = if free[0] && contacts == 1 { 0.0 } else { -1.0 };
        for k in 0..2 {
            self.blocks[k][lane] = blocks[k];
            if free[k] && a != b {
                self.common[k][lane] = common_share(view.mass_matrix, blocks[k]);
                (self.spin[k][lane], self.unit[k][lane]) = (view.mass_matrix.spin[blocks[k]], 1.0);
            }
        }
    }

    /// Its rows among those from `first` on.
    #[inline(always)]
    pub fn rows_after(&self, first: u32) -> Range<usize> {
        let start = (self.first_row - first) as usize;
        start..start + self.rows as usize
    }

    /// Whether a block has moved since the block pairs were solved.
    #[inline(always)]
    pub fn is_due<L: Lanes>(&self, lanes: L, accumulators: &Accumulators) -> bool {
        let moments = &accumulators.block_impulse.as_flattened()[2..];
        let [a, b] = [lanes.gather_from(moments, &self.sums[0])[1], lanes.gather_from(moments, &self.sums[1])[1]];
        lanes.at_most(lanes.max(a, b), lanes.load(&self.solved)) != u8::MAX
    }

    /// Prepares the rows, and starts warm: with the forces that are expected of the contacts.
    #[inline(always)]
    pub fn prepare<L: Lanes>(
        &mut self,
        lanes: L,
        rows: &mut [WideContact],
        row_start: &[u32],
        from: &ContactView,
        accumulators: &mut Accumulators,
    ) {
        let SolverView { mass_matrix, .. } = from.view;
        for lane in 0..LANES {
            let [a, b] = [self.blocks[0][lane], self.blocks[1][lane]];
            let keepers = [a, if mass_matrix.is_free(b) { b } else { a }];
            let sums = keepers.map(|block| PACKED as u32 * (block.number() - accumulators.first_block.number()));
            (0..2).for_each(|k| self.sums[k].set(lane, sums[k]));
        }
        let blocks = [0, 1].map(|k: usize| Bodies::new(&self.blocks[k], mass_matrix, from.approach.motion));
        for (k, (row, range)) in rows.iter_mut().zip(row_start.windows(2)).enumerate() {
            let (range, first_cover) = ([range[0], range[1]], accumulators.first_cover);
            if k < self.wide as usize {
                row.prepare(lanes, range, &blocks, from, first_cover);
            } else {
                row.prepare(First, range, &blocks, from, first_cover);
            }
        }
        let (wide, narrow) = rows.split_at(self.wide as usize);
        let mut all = self.gather(lanes, accumulators);
        for row in wide {
            all.warm_start(lanes, row, from, accumulators);
        }
        if !narrow.is_empty() {
            let mut first = all.first(lanes);
            for row in narrow {
                first.warm_start(First, row, from, accumulators);
            }
            all.rejoin(lanes, &first);
        }
        self.store_impulses(lanes, &all.sides, accumulators);
        self.force = lanes.greatest(all.largest);
    }

    /// Solves the block pairs row by row; returns the largest change of a force over its size.
    #[inline(always)]
    pub fn solve<L: Lanes>(
        &mut self,
        lanes: L,
        rows: &mut [WideContact],
        from: &ContactView,
        ChangeMeasure { floor, number }: ChangeMeasure,
        accumulators: &mut Accumulators,
    ) -> f64 {
        let (wide, narrow) = rows.split_at_mut(self.wide as usize);
        let mut all = self.gather(lanes, accumulators);
        for row in wide {
            all.solve(lanes, row, from, floor, accumulators);
        }
        if !narrow.is_empty() {
            let mut first = all.first(lanes);
            for row in narrow {
                first.solve(First, row, from, floor, accumulators);
            }
            all.rejoin(lanes, &first);
        }
        let number = lanes.splat(f64::from(number));
        let moved = lanes.keep_above(number, all.change, lanes.splat(MOVES * from.options.tolerance));
        for side in &mut all.sides {
            side.moved = lanes.max(moved, side.moved);
        }
        self.store_impulses(lanes, &all.sides, accumulators);
        let solved = lanes.load(&self.share) * number + lanes.load(&self.shift);
        lanes.store(solved, &mut self.solved);
        self.force = lanes.greatest(all.largest);
        lanes.greatest(all.change)
    }

    #[inline(always)]
    fn gather<L: Lanes>(&self, lanes: L, accumulators: &Accumulators) -> PairsInProgress<L> {
        let sides = [self.side(lanes, 0, accumulators), self.side(lanes, 1, accumulators)];
        PairsInProgress { sides, largest: lanes.splat(0.0), change: lanes.splat(0.0) }
    }

    #[inline(always)]
    fn side<L: Lanes>(&self, lanes: L, k: usize, accumulators: &Accumulators) -> WideBlock<L> {
        let (block_impulse, at) = (accumulators.block_impulse.as_flattened(), &self.sums[k]);
        let [moment, moved] = lanes.gather_from(&block_impulse[2..], at);
        WideBlock {
            impulse: lanes.gather_from(block_impulse, at),
            weighted: lanes.gather_from(&block_impulse[1..], at),
            moment,
            moved,
            common: lanes.load(&self.common[k]),
            spin: lanes.load(&self.spin[k]),
            unit: lanes.load(&self.unit[k]),
            centre: lanes.gather_from(&block_impulse[3..], at),
        }
    }

    /// Stores the impulse sums of blocks: second ones first, since a first one may stand in the place of a held one.
    #[inline(always)]
    fn store_impulses<L: Lanes>(&self, lanes: L, sides: &[WideBlock<L>; 2], accumulators: &mut Accumulators) {
        let block_impulse = accumulators.block_impulse.as_flattened_mut();
        for k in [1, 0] {
            let (side, at) = (&sides[k], &self.sums[k]);
            lanes.scatter_to(side.impulse, block_impulse, at);
            lanes.scatter_to(side.weighted, &mut block_impulse[1..], at);
            lanes.scatter_to([side.moment, side.moved], &mut block_impulse[2..], at);
        }
    }
}

/// Block pairs in hand.
struct PairsInProgress<L: Values> {
    sides: [WideBlock<L>; 2],
    /// Largest force (N/m), and largest change of a force over its size.
    largest: L::F,
    change: L::F,
}

impl<L: Values> PairsInProgress<L> {
    #[inline(always)]
    fn warm_start(&mut self, lanes: L, row: &WideContact, from: &ContactView, accumulators: &mut Accumulators) {
        let force = row.warm_start(lanes, from.options.kick, &mut self.sides, accumulators.cover_impulse);
        self.largest = lanes.max(force, self.largest);
    }

    #[inline(always)]
    fn solve(
        &mut self,
        lanes: L,
        row: &mut WideContact,
        from: &ContactView,
        floor: f64,
        accumulators: &mut Accumulators,
    ) {
        let [step, force] = row.solve(lanes, from, &mut self.sides, accumulators.cover_impulse);
        self.largest = lanes.max(force, self.largest);
        self.change = lanes.max(step / lanes.max(force, lanes.splat(floor)), self.change);
    }

    /// The first lane.
    #[inline(always)]
    fn first(&self, lanes: L) -> PairsInProgress<First> {
        let [a, b] = &self.sides;
        let (largest, change) = (first(lanes, self.largest), first(lanes, self.change));
        PairsInProgress { sides: [a.first(lanes), b.first(lanes)], largest, change }
    }

    /// Takes back the first lane.
    #[inline(always)]
    fn rejoin(&mut self, lanes: L, first: &PairsInProgress<First>) {
        for (side, first) in self.sides.iter_mut().zip(&first.sides) {
            for k in 0..2 {
                put_first(lanes, &mut side.impulse[k], first.impulse[k]);
                put_first(lanes, &mut side.weighted[k], first.weighted[k]);
            }
            put_first(lanes, &mut side.moment, first.moment);
        }
        put_first(lanes, &mut self.largest, first.largest);
        put_first(lanes, &mut self.change, first.change);
    }
}
