//! Lanes on AVX2: two registers of four.

use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Arithmetic, Kernel, LANES, Lanes, Pair, Places, Slot, Table, Values};

registers!(
    Avx2, Registers [__m256d; 0 1] by "avx2":
    _mm256_set1_pd _mm256_loadu_pd _mm256_storeu_pd _mm256_sqrt_pd _mm256_max_pd _mm256_min_pd
    _mm256_add_pd _mm256_sub_pd _mm256_mul_pd _mm256_div_pd
);

impl Neg for Registers {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: registers at hand prove AVX2.
        Self(unsafe {
            let sign = _mm256_set1_pd(-0.0);
            [_mm256_xor_pd(self.0[0], sign), _mm256_xor_pd(self.0[1], sign)]
        })
    }
}

/// x and y of the pairs 0–1 and 2–3.
#[inline(always)]
fn split(_: Avx2, low: __m256d, high: __m256d) -> [__m256d; 2] {
    // SAFETY: the token proves AVX2.
    unsafe {
        let x = _mm256_unpacklo_pd(low, high);
        let y = _mm256_unpackhi_pd(low, high);
        [_mm256_permute4x64_pd::<0b11_01_10_00>(x), _mm256_permute4x64_pd::<0b11_01_10_00>(y)]
    }
}

/// The pairs 0–1 and 2–3 of x and y.
#[inline(always)]
fn join(_: Avx2, x: __m256d, y: __m256d) -> [__m256d; 2] {
    // SAFETY: the token proves AVX2.
    unsafe {
        let (low, high) = (_mm256_unpacklo_pd(x, y), _mm256_unpackhi_pd(x, y));
        [_mm256_permute2f128_pd::<0x20>(low, high), _mm256_permute2f128_pd::<0x31>(low, high)]
    }
}

/// x and y of four pairs, each at its own address.
///
/// # Safety
/// Two f64 in a row must be at each address.
#[inline(always)]
unsafe fn four(_: Avx2, at: [*const f64; 4]) -> [__m256d; 2] {
    // SAFETY: the token proves AVX2; the caller answers for the addresses.
    unsafe {
        let even = _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(_mm_loadu_pd(at[0])), _mm_loadu_pd(at[2]));
        let odd = _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(_mm_loadu_pd(at[1])), _mm_loadu_pd(at[3]));
        [_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd)]
    }
}

/// x and y of eight pairs, each at its own address.
///
/// # Safety
/// Two f64 in a row must be at each address.
#[inline(always)]
unsafe fn eight(token: Avx2, [a, b, c, d, e, f, g, h]: [*const f64; LANES]) -> [Registers; 2] {
    // SAFETY: the caller answers for the addresses.
    let ([x, y], [z, w]) = unsafe { (four(token, [a, b, c, d]), four(token, [e, f, g, h])) };
    [Registers([x, z]), Registers([y, w])]
}

/// Four pairs of x and y.
#[inline(always)]
fn quarters(_: Avx2, x: __m256d, y: __m256d) -> [__m128d; 4] {
    // SAFETY: the token proves AVX2.
    unsafe {
        let (even, odd) = (_mm256_unpacklo_pd(x, y), _mm256_unpackhi_pd(x, y));
        let high = [_mm256_extractf128_pd::<1>(even), _mm256_extractf128_pd::<1>(odd)];
        [_mm256_castpd256_pd128(even), _mm256_castpd256_pd128(odd), high[0], high[1]]
    }
}

/// Eight pairs of x and y.
#[inline(always)]
fn apart(token: Avx2, [x, y]: [Registers; 2]) -> [__m128d; LANES] {
    let ([a, b, c, d], [e, f, g, h]) = (quarters(token, x.0[0], y.0[0]), quarters(token, x.0[1], y.0[1]));
    [a, b, c, d, e, f, g, h]
}

/// The pairs 0–1, 2–3, 4–5 and 6–7 of a run.
#[inline(always)]
fn run_of(_: Avx2, pairs: &[Pair; LANES]) -> [__m256d; 4] {
    let at = pairs.as_ptr().cast::<f64>();
    // SAFETY: the token proves AVX2; eight pairs are sixteen f64 in a row.
    unsafe {
        [_mm256_loadu_pd(at), _mm256_loadu_pd(at.add(4)), _mm256_loadu_pd(at.add(8)), _mm256_loadu_pd(at.add(12))]
    }
}

/// Adds to a run its pairs 0–1, 2–3, 4–5 and 6–7.
#[inline(always)]
fn add_run(_: Avx2, pairs: &mut [Pair; LANES], parts: [__m256d; 4]) {
    let at = pairs.as_mut_ptr().cast::<f64>();
    for (k, part) in parts.into_iter().enumerate() {
        // SAFETY: the token proves AVX2; eight pairs are sixteen f64 in a row.
        unsafe { _mm256_storeu_pd(at.add(4 * k), _mm256_add_pd(_mm256_loadu_pd(at.add(4 * k)), part)) }
    }
}

/// Pairs less those of the first corners, as x and y.
#[inline(always)]
fn less(token: Avx2, [a, b, c, d]: [__m256d; 4], first: [__m256d; 4]) -> [Registers; 2] {
    // SAFETY: the token proves AVX2.
    let ([x, y], [z, w]) = unsafe {
        (
            split(token, _mm256_sub_pd(a, first[0]), _mm256_sub_pd(b, first[1])),
            split(token, _mm256_sub_pd(c, first[2]), _mm256_sub_pd(d, first[3])),
        )
    };
    [Registers([x, z]), Registers([y, w])]
}

/// Pairs −1–0, 1–2, … less the sum of the pairs 0–1, 2–3, … of two.
#[inline(always)]
fn balance(_: Avx2, before: __m256d, second: __m256d, third: __m256d) -> __m256d {
    // SAFETY: the token proves AVX2.
    unsafe { _mm256_sub_pd(_mm256_permute2f128_pd::<0x21>(before, second), _mm256_add_pd(second, third)) }
}

/// Values where others are above a limit; zero elsewhere.
#[inline(always)]
fn keep_above(_: Avx2, values: Registers, others: Registers, limit: Registers) -> Registers {
    // SAFETY: the token proves AVX2.
    unsafe {
        let low = _mm256_cmp_pd::<_CMP_GT_OQ>(others.0[0], limit.0[0]);
        let high = _mm256_cmp_pd::<_CMP_GT_OQ>(others.0[1], limit.0[1]);
        Registers([_mm256_and_pd(low, values.0[0]), _mm256_and_pd(high, values.0[1])])
    }
}

/// Lanes in which the first is at most the second, as bits.
#[inline(always)]
fn at_most(_: Avx2, a: Registers, b: Registers) -> u8 {
    // SAFETY: the token proves AVX2.
    unsafe {
        let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(a.0[0], b.0[0]));
        let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(a.0[1], b.0[1]));
        (low | high << 4) as u8
    }
}

/// The first in lanes with a bit, the second elsewhere.
#[inline(always)]
fn select(_: Avx2, bits: u8, a: Registers, b: Registers) -> Registers {
    // SAFETY: the token proves AVX2.
    unsafe {
        let bits = _mm256_set1_epi64x(i64::from(bits));
        let (low, high) = (_mm256_setr_epi64x(1, 2, 4, 8), _mm256_setr_epi64x(16, 32, 64, 128));
        let low = _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(bits, low), low));
        let high = _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(bits, high), high));
        Registers([_mm256_blendv_pd(b.0[0], a.0[0], low), _mm256_blendv_pd(b.0[1], a.0[1], high)])
    }
}

impl Lanes for Avx2 {
    #[inline(always)]
    fn load_pairs(self, pairs: &[Pair; LANES]) -> [Registers; 2] {
        let [a, b, c, d] = run_of(self, pairs);
        let ([x, y], [z, w]) = (split(self, a, b), split(self, c, d));
        [Registers([x, z]), Registers([y, w])]
    }

    #[inline(always)]
    fn store_pairs(self, [x, y]: [Registers; 2], out: &mut [Pair; LANES]) {
        let at = out.as_mut_ptr().cast::<f64>();
        for k in 0..2 {
            let [low, high] = join(self, x.0[k], y.0[k]);
            // SAFETY: the token proves AVX2; eight pairs are sixteen f64 in a row.
            unsafe {
                _mm256_storeu_pd(at.add(8 * k), low);
                _mm256_storeu_pd(at.add(8 * k + 4), high);
            }
        }
    }

    #[inline(always)]
    fn greatest(self, lanes: Registers) -> f64 {
        // SAFETY: the token proves AVX2.
        unsafe {
            let four = _mm256_max_pd(lanes.0[0], lanes.0[1]);
            let two = _mm_max_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd::<1>(four));
            _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)))
        }
    }

    #[inline(always)]
    fn sum(self, lanes: Registers) -> f64 {
        // SAFETY: the token proves AVX2.
        unsafe {
            let four = _mm256_add_pd(lanes.0[0], lanes.0[1]);
            let two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd::<1>(four));
            _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)))
        }
    }

    registers!(Registers by slots);

    #[inline(always)]
    fn gather_triangles(self, table: &Table, [first, third]: [Slot; 2]) -> [[Registers; 2]; 2] {
        let low = run_of(self, table.run(first));
        [less(self, run_of(self, table.run_beside(first)), low), less(self, run_of(self, table.run(third)), low)]
    }

    #[inline(always)]
    fn scatter_triangles(
        self,
        table: &mut Table,
        [first, third]: [Slot; 2],
        [x, y]: [Registers; 2],
        [z, w]: [Registers; 2],
    ) -> Pair {
        let ([a, b], [c, d]) = (join(self, x.0[0], y.0[0]), join(self, x.0[1], y.0[1]));
        let ([e, f], [g, h]) = (join(self, z.0[0], w.0[0]), join(self, z.0[1], w.0[1]));
        // SAFETY: the token proves AVX2.
        let zero = unsafe { _mm256_setzero_pd() };
        let base = [balance(self, zero, a, e), balance(self, a, b, f), balance(self, b, c, g), balance(self, c, d, h)];
        add_run(self, table.run_mut(first), base);
        add_run(self, table.run_mut(third), [e, f, g, h]);
        // SAFETY: the token proves AVX2.
        unsafe {
            let last = _mm256_extractf128_pd::<1>(d);
            Pair::new(_mm_cvtsd_f64(last), _mm_cvtsd_f64(_mm_unpackhi_pd(last, last)))
        }
    }
}
