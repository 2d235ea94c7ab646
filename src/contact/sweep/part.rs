//! A part of the order: its halves, which share no block and may be swept at once, and then what lies between them.

use enmm_lanes::{Kernel, Lanes, dispatch};

use crate::contact::VertexEdge;

use super::body::Ground;
use super::row::{Row, Watch, larger};

/// Rows below which both halves of a part stay in one thread.
pub const GRAIN: usize = 2048;

/// Change of a force, over what counts as settled, from which its bodies have moved.
const MOVES: f64 = 0.3;

/// What is done with the rows.
#[derive(Debug, Clone, Copy)]
pub enum Work {
    /// The forces so far push.
    Warm,
    /// Rows are judged: `all`, or those with a body that has moved since. Changes are measured against `floor` (N/m) at
    /// least; `turn` is that of the first row.
    Sweep { all: bool, floor: f64, turn: u32 },
}

/// What all parts share.
pub struct Pass<'a> {
    pub contacts: &'a [VertexEdge],
    pub kick: f64,
    pub tolerance: f64,
    pub serial: bool,
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
        Self { change: larger(self.change, other.change), judged: self.judged + other.judged }
    }
}

/// Rows of a part, and the blocks that they push.
pub struct Part<'a> {
    pub rows: &'a mut [Row],
    pub watch: &'a mut [Watch],
    pub list: &'a mut [u32],
    /// Turn of the first row.
    pub first_row: u32,
    /// Turns at which the parts within this one end; itself is the last.
    pub ends: &'a [u32],
    /// First block and cover of each run of blocks, and their ends.
    pub cuts: &'a [[u32; 2]],
    pub ground: Ground<'a>,
}

/// Work on the rows of a part from `from` on, which belong to no half: compiled for every kind of lanes.
struct Own<'p, 'a, 'v> {
    part: &'p mut Part<'a>,
    from: usize,
    pass: &'p Pass<'v>,
}

impl Kernel for Own<'_, '_, '_> {
    type Output = Swept;

    #[inline(always)]
    fn run<L: Lanes>(self, _: L) -> Swept {
        self.part.own(self.from, self.pass)
    }
}

impl Part<'_> {
    /// Does the work of a pass.
    pub fn run(&mut self, pass: &Pass) -> Swept {
        if self.ends.len() < 2 {
            return dispatch(Own { part: self, from: 0, pass });
        }
        let between = (self.ends[self.ends.len() - 2] - self.first_row) as usize;
        let (mut first, mut second) = self.halves();
        let (a, b) = if pass.serial || between < GRAIN {
            (first.run(pass), second.run(pass))
        } else {
            rayon::join(|| first.run(pass), || second.run(pass))
        };
        a.and(b).and(dispatch(Own { part: self, from: between, pass }))
    }

    fn halves(&mut self) -> (Part<'_>, Part<'_>) {
        let (half, whole) = (self.ends.len() / 2, self.ends.len() - 1);
        let [count, between] = [half - 1, whole - 1].map(|k| (self.ends[k] - self.first_row) as usize);
        let middle = self.cuts.len() / 2;
        let [block, cover] = self.cuts[middle];
        let (rows, rows_rest) = self.rows[..between].split_at_mut(count);
        let (watch, watch_rest) = self.watch[..between].split_at_mut(count);
        let (list, list_rest) = self.list[..between].split_at_mut(count);
        let (ground, ground_rest) = self.ground.split(block, cover);
        let first = Part {
            rows,
            watch,
            list,
            ground,
            first_row: self.first_row,
            ends: &self.ends[..half],
            cuts: &self.cuts[..=middle],
        };
        let second = Part {
            rows: rows_rest,
            watch: watch_rest,
            list: list_rest,
            ground: ground_rest,
            first_row: self.ends[half - 1],
            ends: &self.ends[half..whole],
            cuts: &self.cuts[middle..],
        };
        (first, second)
    }

    /// Does the work on the rows from `from` on, which belong to no half.
    #[inline(always)]
    fn own(&mut self, from: usize, pass: &Pass) -> Swept {
        match pass.work {
            Work::Warm => {
                let ground = &mut self.ground;
                self.rows[from..].iter().for_each(|row| row.warm(pass.kick, ground));
                Swept::default()
            }
            Work::Sweep { all, floor, turn } => {
                let due = self.list_due(from, all);
                let change = self.judge(due, pass, floor, turn + self.first_row);
                Swept { change, judged: due as u64 }
            }
        }
    }

    /// Lists the rows from `from` on that are judged in a sweep; returns their number.
    #[inline(always)]
    fn list_due(&mut self, from: usize, all: bool) -> usize {
        let ground = self.ground.all();
        let mut count = 0;
        for (k, watch) in self.watch.iter().enumerate().skip(from) {
            self.list[count] = k as u32;
            count += usize::from(all || watch.is_due(&ground));
        }
        count
    }

    /// Judges the rows listed, the first row having its turn at `first`; returns the largest change of a force over
    /// its size.
    #[inline(always)]
    fn judge(&mut self, due: usize, pass: &Pass, floor: f64, first: u32) -> f64 {
        let mut ground = self.ground.all();
        let moves = MOVES * pass.tolerance;
        let mut change = 0.0;
        for &k in &self.list[..due] {
            let (row, watch) = (&mut self.rows[k as usize], &mut self.watch[k as usize]);
            let [step, force] = row.judge(pass.kick, pass.contacts, &mut ground);
            let share = step / larger(force, floor);
            change = larger(share, change);
            watch.judged(first + k, force);
            // The sign of the difference, since a comparison ends as a branch.
            let moved = ((moves - share).to_bits() >> 63) as u32;
            ground.mark(watch.blocks, (first + k) * moved);
        }
        change
    }
}
