//! Lanes in plain Rust: what the others must equal bit by bit.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Arithmetic, LANES, Lanes, Pair, Places, Slot, Table, Values};

/// Plain Rust.
#[derive(Clone, Copy)]
pub struct Portable;

/// Eight values.
#[derive(Clone, Copy)]
pub struct Array([f64; LANES]);

impl Array {
    #[inline(always)]
    fn with(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|k| f(self.0[k], other.0[k])))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Array {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with(other, f64::$method)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Array {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|v| -v))
    }
}

impl Arithmetic for Array {
    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Self([value; LANES])
    }
}

impl Values for Portable {
    type F = Array;

    #[inline(always)]
    fn splat(self, value: f64) -> Array {
        Array([value; LANES])
    }

    #[inline(always)]
    fn load(self, values: &[f64; LANES]) -> Array {
        Array(*values)
    }

    #[inline(always)]
    fn store(self, lanes: Array, out: &mut [f64; LANES]) {
        *out = lanes.0;
    }

    #[inline(always)]
    fn max(self, a: Array, b: Array) -> Array {
        a.with(b, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn min(self, a: Array, b: Array) -> Array {
        a.with(b, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn keep_above(self, values: Array, others: Array, limit: Array) -> Array {
        Array(std::array::from_fn(|k| if others.0[k] > limit.0[k] { values.0[k] } else { 0.0 }))
    }

    #[inline(always)]
    fn at_most(self, a: Array, b: Array) -> u8 {
        (0..LANES).fold(0, |bits, k| bits | u8::from(a.0[k] <= b.0[k]) << k)
    }

    #[inline(always)]
    fn sqrt(self, lanes: Array) -> Array {
        Array(lanes.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn select(self, bits: u8, a: Array, b: Array) -> Array {
        Array(std::array::from_fn(|k| if bits >> k & 1 == 1 { a.0[k] } else { b.0[k] }))
    }

    #[inline(always)]
    fn gather_from(self, pairs: &[Pair], at: &Places) -> [Array; 2] {
        self.load_pairs(&std::array::from_fn(|k| pairs[at.index(k) as usize]))
    }

    #[inline(always)]
    fn scatter_to(self, [x, y]: [Array; 2], pairs: &mut [Pair], at: &Places) {
        for k in (0..LANES).rev() {
            pairs[at.index(k) as usize] = Pair::new(x.0[k], y.0[k]);
        }
    }
}

impl Lanes for Portable {
    const IN_REGISTERS: bool = false;

    #[inline(always)]
    fn load_pairs(self, pairs: &[Pair; LANES]) -> [Array; 2] {
        [Array(std::array::from_fn(|k| pairs[k].x)), Array(std::array::from_fn(|k| pairs[k].y))]
    }

    #[inline(always)]
    fn store_pairs(self, [x, y]: [Array; 2], out: &mut [Pair; LANES]) {
        for (k, pair) in out.iter_mut().enumerate() {
            *pair = Pair::new(x.0[k], y.0[k]);
        }
    }

    #[inline(always)]
    fn greatest(self, lanes: Array) -> f64 {
        lanes.0.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    #[inline(always)]
    fn sum(self, Array(v): Array) -> f64 {
        ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]))
    }

    #[inline(always)]
    fn gather(self, table: &Table, slots: &[Slot; LANES]) -> [Array; 2] {
        let pairs = slots.map(|slot| *table.at(slot));
        self.load_pairs(&pairs)
    }

    #[inline(always)]
    fn scatter_add(self, table: &mut Table, slots: &[Slot; LANES], [x, y]: [Array; 2]) {
        for (k, slot) in slots.iter().enumerate() {
            *table.at_mut(*slot) += Pair::new(x.0[k], y.0[k]);
        }
    }
}
