//! The first of eight lanes alone, in plain Rust: for work of which the others have no share.

use std::hint::select_unpredictable;

use super::{LANES, Pair, Places, Values};

/// The first lane.
#[derive(Clone, Copy)]
pub struct First;

impl Values for First {
    type F = f64;

    #[inline(always)]
    fn splat(self, value: f64) -> f64 {
        value
    }

    #[inline(always)]
    fn load(self, values: &[f64; LANES]) -> f64 {
        values[0]
    }

    #[inline(always)]
    fn store(self, lanes: f64, out: &mut [f64; LANES]) {
        out[0] = lanes;
    }

    #[inline(always)]
    fn max(self, a: f64, b: f64) -> f64 {
        if a > b { a } else { b }
    }

    #[inline(always)]
    fn min(self, a: f64, b: f64) -> f64 {
        if a < b { a } else { b }
    }

    #[inline(always)]
    fn keep_above(self, values: f64, others: f64, limit: f64) -> f64 {
        select_unpredictable(others > limit, values, 0.0)
    }

    #[inline(always)]
    fn at_most(self, a: f64, b: f64) -> u8 {
        u8::from(a <= b)
    }

    #[inline(always)]
    fn sqrt(self, value: f64) -> f64 {
        value.sqrt()
    }

    #[inline(always)]
    fn select(self, bits: u8, a: f64, b: f64) -> f64 {
        select_unpredictable(bits & 1 == 1, a, b)
    }

    #[inline(always)]
    fn gather_from(self, pairs: &[Pair], at: &Places) -> [f64; 2] {
        let pair = pairs[at.index(0) as usize];
        [pair.x, pair.y]
    }

    #[inline(always)]
    fn scatter_to(self, [x, y]: [f64; 2], pairs: &mut [Pair], at: &Places) {
        pairs[at.index(0) as usize] = Pair::new(x, y);
    }
}
