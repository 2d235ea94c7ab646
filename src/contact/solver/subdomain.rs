//! A part of the order: its halves, which share no block and may be swept at once, and then what lies between them.

use enmm_lanes::{Kernel, LANES, Lanes, dispatch};

use crate::cover::{BlockId, CoverId};

use super::anchor::Accumulators;
use super::wide_contact::{ContactView, WideContact};
use super::wide_pairs::{ChangeMeasure, WidePairs};

/// Rounds of a sweep over what belongs to one part, while its rows are in the cache.
pub const ROUNDS: u32 = 2;

/// Contacts below which both halves of a part stay in one thread.
const GRAIN: usize = 2048;

/// Kind of a pass over the block pairs.
#[derive(Debug, Clone, Copy)]
pub enum PassKind {
    /// Prepares the rows, and starts warm: with the forces that are expected.
    Prepare,
    /// Solves the contacts, in the first round `all` or those with a body that has moved since. Changes are measured
    /// against `floor` (N/m) at least; `number` is the first sequence number.
    Sweep { all: bool, floor: f64, number: u32 },
}

/// Data that all parts share.
pub struct SubdomainPass<'a> {
    pub from: ContactView<'a>,
    /// First position of each row in the order of the contacts, and the number of positions.
    pub row_start: &'a [u32],
    pub kind: PassKind,
}

/// Outcome of a pass.
#[derive(Debug, Clone, Copy, Default)]
pub struct SweepOutcome {
    /// Largest change of a force over its size.
    pub change: f64,
    /// Contacts solved.
    pub contacts_solved: u64,
}

impl SweepOutcome {
    fn and(self, other: Self) -> Self {
        Self { change: self.change.max(other.change), contacts_solved: self.contacts_solved + other.contacts_solved }
    }
}

/// Block pairs of a part, and the blocks that they push.
pub struct Subdomain<'a> {
    pub wide_pairs: &'a mut [WidePairs],
    pub rows: &'a mut [WideContact],
    /// First block pairs and first row.
    pub first: [u32; 2],
    /// Where the parts within this one end; itself is the last.
    pub ends: &'a [u32],
    /// First block and cover of each run of blocks, and their ends.
    pub cuts: &'a [(BlockId, CoverId)],
    pub accumulators: Accumulators<'a>,
}

/// Kernel over the separator, the pairs from `from` on, which connect the two halves; compiled for every kind of lanes.
struct SubdomainKernel<'p, 'a, 'v> {
    subdomain: &'p mut Subdomain<'a>,
    from: usize,
    pass: &'p SubdomainPass<'v>,
}

impl Kernel for SubdomainKernel<'_, '_, '_> {
    type Output = SweepOutcome;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> SweepOutcome {
        self.subdomain.between_halves(lanes, self.from, self.pass)
    }
}

impl Subdomain<'_> {
    /// Does the work of a pass.
    pub fn run(&mut self, pass: &SubdomainPass) -> SweepOutcome {
        if self.ends.len() < 2 {
            return dispatch(SubdomainKernel { subdomain: self, from: 0, pass });
        }
        let between = (self.ends[self.ends.len() - 2] - self.first[0]) as usize;
        let small = self.rows.len() * LANES < GRAIN;
        let (mut first, mut second) = self.halves();
        let (a, b) = if pass.from.options.serial || small {
            (first.run(pass), second.run(pass))
        } else {
            rayon::join(|| first.run(pass), || second.run(pass))
        };
        a.and(b).and(dispatch(SubdomainKernel { subdomain: self, from: between, pass }))
    }

    fn halves(&mut self) -> (Subdomain<'_>, Subdomain<'_>) {
        let (half, all_blocks) = (self.ends.len() / 2, self.ends.len() - 1);
        let [count, between] = [half - 1, all_blocks - 1].map(|k| (self.ends[k] - self.first[0]) as usize);
        let row = |wide_pairs: &[WidePairs], k: usize| match wide_pairs.get(k) {
            Some(wide_pairs) => (wide_pairs.first_row - self.first[1]) as usize,
            None => self.rows.len(),
        };
        let [row_count, row_between] = [row(self.wide_pairs, count), row(self.wide_pairs, between)];
        let middle = self.cuts.len() / 2;
        let (block, cover) = self.cuts[middle];
        let (wide_pairs, wide_pairs_rest) = self.wide_pairs[..between].split_at_mut(count);
        let (rows, rows_rest) = self.rows[..row_between].split_at_mut(row_count);
        let (accumulators, accumulators_rest) = self.accumulators.split(block, cover);
        let first = Subdomain {
            wide_pairs,
            rows,
            first: self.first,
            ends: &self.ends[..half],
            cuts: &self.cuts[..=middle],
            accumulators,
        };
        let second = Subdomain {
            wide_pairs: wide_pairs_rest,
            rows: rows_rest,
            first: [self.ends[half - 1], self.first[1] + row_count as u32],
            ends: &self.ends[half..all_blocks],
            cuts: &self.cuts[middle..],
            accumulators: accumulators_rest,
        };
        (first, second)
    }

    /// Does a pass over the separator: the block pairs from `from` on, which connect the two halves.
    #[inline(always)]
    fn between_halves<L: Lanes>(&mut self, lanes: L, from: usize, pass: &SubdomainPass) -> SweepOutcome {
        let mut outcome = SweepOutcome::default();
        match pass.kind {
            PassKind::Prepare => self.prepare(lanes, from, pass),
            PassKind::Sweep { all, floor, number } => {
                let first = number + ROUNDS * (self.first[0] + from as u32);
                let count = (self.wide_pairs.len() - from) as u32;
                for round in 0..ROUNDS {
                    let number = first + round * count;
                    outcome = outcome.and(self.sweep(lanes, from, pass, all && round == 0, floor, number));
                }
            }
        }
        outcome
    }

    #[inline(always)]
    fn prepare<L: Lanes>(&mut self, lanes: L, from: usize, pass: &SubdomainPass) {
        let Self { wide_pairs, rows, first, accumulators, .. } = self;
        for wide_pairs in &mut wide_pairs[from..] {
            let rows = &mut rows[wide_pairs.rows_after(first[1])];
            wide_pairs.prepare(lanes, rows, &pass.row_start[wide_pairs.first_row as usize..], &pass.from, accumulators);
        }
    }

    /// One round, of which the first block pairs have the given sequence number.
    #[inline(always)]
    fn sweep<L: Lanes>(
        &mut self,
        lanes: L,
        from: usize,
        pass: &SubdomainPass,
        all: bool,
        floor: f64,
        number: u32,
    ) -> SweepOutcome {
        let Self { wide_pairs, rows, first, accumulators, .. } = self;
        let mut outcome = SweepOutcome::default();
        for (wide_pairs, number) in wide_pairs[from..].iter_mut().zip(number..) {
            if all || wide_pairs.is_due(lanes, accumulators) {
                let rows = &mut rows[wide_pairs.rows_after(first[1])];
                let change = wide_pairs.solve(lanes, rows, &pass.from, ChangeMeasure { floor, number }, accumulators);
                outcome = outcome.and(SweepOutcome { change, contacts_solved: u64::from(wide_pairs.contacts) });
            }
        }
        outcome
    }
}
