//! A part of the order: its halves, which share no block and may be swept at once, and then what lies between them.

use enmm_lanes::{Kernel, LANES, Lanes, dispatch};

use super::abreast::{Abreast, Measure};
use super::body::Ground;
use super::row::{Row, RowView};

/// Rounds of a sweep over what belongs to one part, while its rows are in the cache.
pub const ROUNDS: u32 = 2;

/// Contacts below which both halves of a part stay in one thread.
const GRAIN: usize = 2048;

/// What is done with the manifolds.
#[derive(Debug, Clone, Copy)]
pub enum Work {
    /// Rows are made, and push with the forces that are expected.
    Load,
    /// Contacts are judged, in the first round `all` or those with a body that has moved since. Changes are measured
    /// against `floor` (N/m) at least; `turn` is the first one.
    Sweep { all: bool, floor: f64, turn: u32 },
}

/// What all parts share.
pub struct Pass<'a> {
    pub from: RowView<'a>,
    /// First turn of each row, and the number of turns.
    pub first_turn: &'a [u32],
    pub work: Work,
}

/// What a pass has done.
#[derive(Debug, Clone, Copy, Default)]
pub struct Swept {
    /// Largest change of a force over its size.
    pub change: f64,
    /// Contacts judged.
    pub judged: u64,
}

impl Swept {
    fn and(self, other: Self) -> Self {
        Self { change: self.change.max(other.change), judged: self.judged + other.judged }
    }
}

/// Manifolds of a part, and the blocks that they push.
pub struct Part<'a> {
    pub abreast: &'a mut [Abreast],
    pub rows: &'a mut [Row],
    /// First manifolds and first row.
    pub first: [u32; 2],
    /// Where the parts within this one end; itself is the last.
    pub ends: &'a [u32],
    /// First block and cover of each run of blocks, and their ends.
    pub cuts: &'a [[u32; 2]],
    pub ground: Ground<'a>,
}

/// Work on the manifolds of a part from `from` on, which belong to no half: compiled for every kind of lanes.
struct Own<'p, 'a, 'v> {
    part: &'p mut Part<'a>,
    from: usize,
    pass: &'p Pass<'v>,
}

impl Kernel for Own<'_, '_, '_> {
    type Output = Swept;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Swept {
        self.part.own(lanes, self.from, self.pass)
    }
}

impl Part<'_> {
    /// Does the work of a pass.
    pub fn run(&mut self, pass: &Pass) -> Swept {
        if self.ends.len() < 2 {
            return dispatch(Own { part: self, from: 0, pass });
        }
        let between = (self.ends[self.ends.len() - 2] - self.first[0]) as usize;
        let small = self.rows.len() * LANES < GRAIN;
        let (mut first, mut second) = self.halves();
        let (a, b) = if pass.from.options.serial || small {
            (first.run(pass), second.run(pass))
        } else {
            rayon::join(|| first.run(pass), || second.run(pass))
        };
        a.and(b).and(dispatch(Own { part: self, from: between, pass }))
    }

    fn halves(&mut self) -> (Part<'_>, Part<'_>) {
        let (half, whole) = (self.ends.len() / 2, self.ends.len() - 1);
        let [count, between] = [half - 1, whole - 1].map(|k| (self.ends[k] - self.first[0]) as usize);
        let row = |abreast: &[Abreast], k: usize| match abreast.get(k) {
            Some(abreast) => (abreast.first_row - self.first[1]) as usize,
            None => self.rows.len(),
        };
        let [row_count, row_between] = [row(self.abreast, count), row(self.abreast, between)];
        let middle = self.cuts.len() / 2;
        let [block, cover] = self.cuts[middle];
        let (abreast, abreast_rest) = self.abreast[..between].split_at_mut(count);
        let (rows, rows_rest) = self.rows[..row_between].split_at_mut(row_count);
        let (ground, ground_rest) = self.ground.split(block, cover);
        let first =
            Part { abreast, rows, first: self.first, ends: &self.ends[..half], cuts: &self.cuts[..=middle], ground };
        let second = Part {
            abreast: abreast_rest,
            rows: rows_rest,
            first: [self.ends[half - 1], self.first[1] + row_count as u32],
            ends: &self.ends[half..whole],
            cuts: &self.cuts[middle..],
            ground: ground_rest,
        };
        (first, second)
    }

    /// Does the work on the manifolds from `from` on, which belong to no half.
    #[inline(always)]
    fn own<L: Lanes>(&mut self, lanes: L, from: usize, pass: &Pass) -> Swept {
        let mut swept = Swept::default();
        match pass.work {
            Work::Load => self.load(lanes, from, pass),
            Work::Sweep { all, floor, turn } => {
                let first = turn + ROUNDS * (self.first[0] + from as u32);
                let count = (self.abreast.len() - from) as u32;
                for round in 0..ROUNDS {
                    let turn = first + round * count;
                    swept = swept.and(self.sweep(lanes, from, pass, all && round == 0, floor, turn));
                }
            }
        }
        swept
    }

    #[inline(always)]
    fn load<L: Lanes>(&mut self, lanes: L, from: usize, pass: &Pass) {
        let Self { abreast, rows, first, ground, .. } = self;
        for abreast in &mut abreast[from..] {
            let rows = &mut rows[abreast.rows_after(first[1])];
            abreast.load(lanes, rows, &pass.first_turn[abreast.first_row as usize..], &pass.from, ground);
        }
    }

    /// One round, of which the first manifolds have the given turn.
    #[inline(always)]
    fn sweep<L: Lanes>(&mut self, lanes: L, from: usize, pass: &Pass, all: bool, floor: f64, turn: u32) -> Swept {
        let Self { abreast, rows, first, ground, .. } = self;
        let mut swept = Swept::default();
        for (abreast, turn) in abreast[from..].iter_mut().zip(turn..) {
            if all || abreast.is_due(lanes, ground) {
                let rows = &mut rows[abreast.rows_after(first[1])];
                let change = abreast.judge(lanes, rows, &pass.from, Measure { floor, turn }, ground);
                swept = swept.and(Swept { change, judged: u64::from(abreast.contacts) });
            }
        }
        swept
    }
}
