//! The first of eight lanes alone, in plain Rust: for work of which the others have no share.

use std::hint::select_unpredictable;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Arithmetic, LANES, Pair, Places, Values};

/// The first lane.
#[derive(Clone, Copy)]
pub struct First;

/// Its value.
#[derive(Clone, Copy)]
pub struct Value(f64);

macro_rules! operator {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl $trait for Value {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $operator other.0)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl Neg for Value {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Arithmetic for Value {}

impl Values for First {
    type F = Value;

    #[inline(always)]
    fn splat(self, value: f64) -> Value {
        Value(value)
    }

    #[inline(always)]
    fn load(self, values: &[f64; LANES]) -> Value {
        Value(values[0])
    }

    #[inline(always)]
    fn store(self, lanes: Value, out: &mut [f64; LANES]) {
        out[0] = lanes.0;
    }

    #[inline(always)]
    fn max(self, a: Value, b: Value) -> Value {
        if a.0 > b.0 { a } else { b }
    }

    #[inline(always)]
    fn min(self, a: Value, b: Value) -> Value {
        if a.0 < b.0 { a } else { b }
    }

    #[inline(always)]
    fn keep_above(self, values: Value, others: Value, limit: Value) -> Value {
        Value(select_unpredictable(others.0 > limit.0, values.0, 0.0))
    }

    #[inline(always)]
    fn at_most(self, a: Value, b: Value) -> u8 {
        u8::from(a.0 <= b.0)
    }

    #[inline(always)]
    fn gather_from(self, pairs: &[Pair], at: &Places) -> [Value; 2] {
        let pair = pairs[at.index(0) as usize];
        [Value(pair.x), Value(pair.y)]
    }

    #[inline(always)]
    fn scatter_to(self, [x, y]: [Value; 2], pairs: &mut [Pair], at: &Places) {
        pairs[at.index(0) as usize] = Pair::new(x.0, y.0);
    }
}
