//! Eight `f64` side by side on AVX-512, on AVX2 or on plain Rust, chosen at run time, with the same bits on all three.
//!
//! A [`Kernel`] is written once over [`Lanes`] and run by [`dispatch`]. Every operation is the IEEE one, in the same
//! order on every path and never fused, so that results do not depend on the machine. Safe to use: all `unsafe` of the
//! engine outside `ffi/` is fenced in here.

#[cfg(target_arch = "x86_64")]
#[macro_use]
mod registers;

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod first;
mod path;
mod places;
mod portable;
mod prefetch;
mod table;

pub use first::First;
pub use path::{Path, VARIABLE, dispatch, dispatch_on, requested};
pub use places::Places;
pub use prefetch::prefetch;
pub use table::{SLOTS, Slot, Table};

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A pair x, y: a point or a vector of the plane.
pub type Pair = nalgebra::Vector2<f64>;

/// Number of lanes.
pub const LANES: usize = 8;

/// Numbers that are reckoned with as one.
pub trait Arithmetic:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// One value in all lanes.
    fn splat(self, value: f64) -> Self;
}

impl Arithmetic for f64 {
    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        value
    }
}

/// Pairs that stand as plain numbers.
pub fn as_pairs(values: &[[f64; 2]]) -> &[Pair] {
    // SAFETY: a pair is two f64 in a row (`repr(C)` and `repr(transparent)` all the way).
    unsafe { std::slice::from_raw_parts(values.as_ptr().cast(), values.len()) }
}

/// Arithmetic on values of eight lanes at once, or on that of the first lane only.
pub trait Values: Copy {
    /// Values of the lanes.
    type F: Arithmetic;

    /// One value in all lanes.
    fn splat(self, value: f64) -> Self::F;

    /// Eight values in a row.
    fn load(self, values: &[f64; LANES]) -> Self::F;

    /// Writes eight values.
    fn store(self, lanes: Self::F, out: &mut [f64; LANES]);

    /// The greater of each lane; the second where the first is not a number.
    fn max(self, a: Self::F, b: Self::F) -> Self::F;

    /// The lesser of each lane; the second where the first is not a number.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;

    /// Square root.
    fn sqrt(self, lanes: Self::F) -> Self::F;

    /// Values where others are above a limit; zero elsewhere.
    fn keep_above(self, values: Self::F, others: Self::F, limit: Self::F) -> Self::F;

    /// Lanes in which the first is at most the second, as bits from the lowest on.
    fn at_most(self, a: Self::F, b: Self::F) -> u8;

    /// The first in lanes with a bit, from the lowest on, the second elsewhere.
    fn select(self, bits: u8, a: Self::F, b: Self::F) -> Self::F;

    /// Pairs of a list.
    ///
    /// # Panics
    /// When a place is not below the length.
    fn gather_from(self, pairs: &[Pair], at: &Places) -> [Self::F; 2];

    /// Writes pairs of a list, the last lane first: of lanes with one place the first one counts.
    ///
    /// # Panics
    /// When a place is not below the length.
    fn scatter_to(self, lanes: [Self::F; 2], pairs: &mut [Pair], at: &Places);
}

/// Instructions of a processor for eight `f64` at once; a value of this type proves that the processor has them.
pub trait Lanes: Values {
    /// Whether registers hold several lanes. Where they do not, long formulas are faster lane by lane.
    const IN_REGISTERS: bool = true;

    /// Eight pairs in a row, as x and y.
    fn load_pairs(self, pairs: &[Pair; LANES]) -> [Self::F; 2];

    /// Writes eight pairs.
    fn store_pairs(self, lanes: [Self::F; 2], out: &mut [Pair; LANES]);

    /// ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7)).
    fn sum(self, lanes: Self::F) -> f64;

    /// The greatest lane; none may be what is not a number.
    fn greatest(self, lanes: Self::F) -> f64;

    /// Pairs of a table by their slots.
    fn gather(self, table: &Table, slots: &[Slot; LANES]) -> [Self::F; 2];

    /// Adds to pairs of a table, lane after lane.
    fn scatter_add(self, table: &mut Table, slots: &[Slot; LANES], lanes: [Self::F; 2]);

    /// Of eight triangles in a row, with first corners in a run of slots, second ones in the run beside it and third
    /// ones in a run elsewhere: pairs of the second and of the third corners less those of the first.
    #[inline(always)]
    fn gather_triangles(self, table: &Table, [first, third]: [Slot; 2]) -> [[Self::F; 2]; 2] {
        let a = self.load_pairs(table.run(first));
        let b = self.load_pairs(table.run_beside(first));
        let c = self.load_pairs(table.run(third));
        [[b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]]
    }

    /// Adds pairs to the second and third corners of such triangles, and what holds them in balance to the first.
    /// Returns the last of the pairs for the last second corner, which waits for [`Table::add_beside`], so that no run
    /// is read that has been written in part.
    #[inline(always)]
    fn scatter_triangles(
        self,
        table: &mut Table,
        [first, third]: [Slot; 2],
        second: [Self::F; 2],
        other: [Self::F; 2],
    ) -> Pair {
        let mut pairs = [[Pair::zeros(); LANES]; 2];
        self.store_pairs(second, &mut pairs[0]);
        self.store_pairs(other, &mut pairs[1]);
        let mut before = Pair::zeros();
        for ((at, b), c) in table.run_mut(first).iter_mut().zip(&pairs[0]).zip(&pairs[1]) {
            *at += before - (b + c);
            before = *b;
        }
        table.run_mut(third).iter_mut().zip(&pairs[1]).for_each(|(at, c)| *at += c);
        before
    }

    /// Writes zeros to the first pairs of a table, and to what of a last eight stands behind them.
    #[inline(always)]
    fn clear(self, table: &mut Table, count: usize) {
        let zero = self.splat(0.0);
        for eight in table.first_eights_mut(count) {
            self.store_pairs([zero; 2], eight);
        }
    }

    /// Up to eight values in a row; lanes beyond the end take `fill`.
    #[inline(always)]
    fn load_some(self, values: &[f64], fill: f64) -> Self::F {
        match values.first_chunk() {
            Some(full) => self.load(full),
            None => {
                let mut padded = [fill; LANES];
                padded[..values.len()].copy_from_slice(values);
                self.load(&padded)
            }
        }
    }

    /// Up to eight pairs in a row; lanes beyond the end take `fill`.
    #[inline(always)]
    fn load_some_pairs(self, pairs: &[Pair], fill: Pair) -> [Self::F; 2] {
        match pairs.first_chunk() {
            Some(full) => self.load_pairs(full),
            None => {
                let mut padded = [fill; LANES];
                padded[..pairs.len()].copy_from_slice(pairs);
                self.load_pairs(&padded)
            }
        }
    }

    /// Writes as many pairs as `out` takes, eight at most.
    #[inline(always)]
    fn store_some_pairs(self, lanes: [Self::F; 2], out: &mut [Pair]) {
        match out.first_chunk_mut() {
            Some(full) => self.store_pairs(lanes, full),
            None => {
                let mut padded = [Pair::zeros(); LANES];
                self.store_pairs(lanes, &mut padded);
                let count = out.len();
                out.copy_from_slice(&padded[..count]);
            }
        }
    }
}

/// Work that is written once for all kinds of lanes; its methods should be `#[inline(always)]`.
pub trait Kernel {
    /// Result.
    type Output;

    /// Does the work with lanes of one kind.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}
