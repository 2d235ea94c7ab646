//! Lanes on AVX-512F: one register of eight.

use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Arithmetic, Kernel, LANES, Lanes, Pair, Places, Slot, Table, Values};

registers!(
    Avx512, Register [__m512d; 0] by "avx512f":
    _mm512_set1_pd _mm512_loadu_pd _mm512_storeu_pd _mm512_sqrt_pd _mm512_max_pd _mm512_min_pd
    _mm512_add_pd _mm512_sub_pd _mm512_mul_pd _mm512_div_pd
);

impl Neg for Register {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: a register at hand proves AVX-512F.
        Self(unsafe {
            let sign = _mm512_set1_epi64(i64::MIN);
            [_mm512_castsi512_pd(_mm512_xor_si512(_mm512_castpd_si512(self.0[0]), sign))]
        })
    }
}

/// x and y of the pairs 0–3 and 4–7.
#[inline(always)]
fn split(_: Avx512, low: __m512d, high: __m512d) -> [Register; 2] {
    // SAFETY: the token proves AVX-512F.
    unsafe {
        let x = _mm512_setr_epi64(0, 2, 4, 6, 8, 10, 12, 14);
        let y = _mm512_setr_epi64(1, 3, 5, 7, 9, 11, 13, 15);
        [Register([_mm512_permutex2var_pd(low, x, high)]), Register([_mm512_permutex2var_pd(low, y, high)])]
    }
}

/// The pairs 0–3 and 4–7 of x and y.
#[inline(always)]
fn join(_: Avx512, [x, y]: [Register; 2]) -> [__m512d; 2] {
    // SAFETY: the token proves AVX-512F.
    unsafe {
        let low = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11);
        let high = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
        [_mm512_permutex2var_pd(x.0[0], low, y.0[0]), _mm512_permutex2var_pd(x.0[0], high, y.0[0])]
    }
}

/// Mask of the first `count` lanes, all when there are fewer lanes.
#[inline(always)]
fn first(count: usize) -> __mmask8 {
    ((1_u32 << count.min(LANES)) - 1) as __mmask8
}

/// Masks of the values 0–7 and 8–15 of the first `count` pairs.
#[inline(always)]
fn first_pairs(count: usize) -> [__mmask8; 2] {
    [first(2 * count), first((2 * count).saturating_sub(LANES))]
}

/// Four pairs, each at its own address.
///
/// # Safety
/// Two f64 in a row must be at each address.
#[inline(always)]
unsafe fn four(_: Avx512, at: [*const f64; 4]) -> __m512d {
    // SAFETY: the token proves AVX-512F; the caller answers for the addresses.
    unsafe {
        let a = _mm256_castpd128_pd256(_mm_loadu_pd(at[0]));
        let b = _mm256_castpd128_pd256(_mm_loadu_pd(at[2]));
        let a = _mm256_insertf128_pd::<1>(a, _mm_loadu_pd(at[1]));
        let b = _mm256_insertf128_pd::<1>(b, _mm_loadu_pd(at[3]));
        _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(a), b)
    }
}

/// x and y of eight pairs, each at its own address. The pairs of even and of odd lanes stand together, so that each
/// quarter of a register needs its own values only.
///
/// # Safety
/// Two f64 in a row must be at each address.
#[inline(always)]
unsafe fn eight(token: Avx512, [a, b, c, d, e, f, g, h]: [*const f64; LANES]) -> [Register; 2] {
    // SAFETY: the token proves AVX-512F; the caller answers for the addresses.
    unsafe {
        let (even, odd) = (four(token, [a, c, e, g]), four(token, [b, d, f, h]));
        [Register([_mm512_unpacklo_pd(even, odd)]), Register([_mm512_unpackhi_pd(even, odd)])]
    }
}

/// Four pairs of a register.
#[inline(always)]
fn quarters(_: Avx512, four: __m512d) -> [__m128d; 4] {
    // SAFETY: the token proves AVX-512F.
    unsafe {
        let (low, high) = (_mm512_castpd512_pd256(four), _mm512_extractf64x4_pd::<1>(four));
        let [b, d] = [_mm256_extractf128_pd::<1>(low), _mm256_extractf128_pd::<1>(high)];
        [_mm256_castpd256_pd128(low), b, _mm256_castpd256_pd128(high), d]
    }
}

/// Eight pairs of x and y.
#[inline(always)]
fn apart(token: Avx512, [x, y]: [Register; 2]) -> [__m128d; LANES] {
    // SAFETY: the token proves AVX-512F.
    let (even, odd) = unsafe { (_mm512_unpacklo_pd(x.0[0], y.0[0]), _mm512_unpackhi_pd(x.0[0], y.0[0])) };
    let ([a, c, e, g], [b, d, f, h]) = (quarters(token, even), quarters(token, odd));
    [a, b, c, d, e, f, g, h]
}

/// The pairs 0–3 and 4–7 of a run.
#[inline(always)]
fn run_of(_: Avx512, pairs: &[Pair; LANES]) -> [__m512d; 2] {
    let at = pairs.as_ptr().cast::<f64>();
    // SAFETY: the token proves AVX-512F; eight pairs are sixteen f64 in a row.
    unsafe { [_mm512_loadu_pd(at), _mm512_loadu_pd(at.add(LANES))] }
}

/// Adds to a run its pairs 0–3 and 4–7.
#[inline(always)]
fn add_run(_: Avx512, pairs: &mut [Pair; LANES], low: __m512d, high: __m512d) {
    let at = pairs.as_mut_ptr().cast::<f64>();
    // SAFETY: the token proves AVX-512F; eight pairs are sixteen f64 in a row.
    unsafe {
        _mm512_storeu_pd(at, _mm512_add_pd(_mm512_loadu_pd(at), low));
        _mm512_storeu_pd(at.add(LANES), _mm512_add_pd(_mm512_loadu_pd(at.add(LANES)), high));
    }
}

/// Values where others are above a limit; zero elsewhere.
#[inline(always)]
fn keep_above(_: Avx512, values: Register, others: Register, limit: Register) -> Register {
    // SAFETY: the token proves AVX-512F.
    Register(unsafe { [_mm512_maskz_mov_pd(_mm512_cmp_pd_mask::<_CMP_GT_OQ>(others.0[0], limit.0[0]), values.0[0])] })
}

/// Lanes in which the first is at most the second, as bits.
#[inline(always)]
fn at_most(_: Avx512, a: Register, b: Register) -> u8 {
    // SAFETY: the token proves AVX-512F.
    unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(a.0[0], b.0[0]) }
}

/// The first in lanes with a bit, the second elsewhere.
#[inline(always)]
fn select(_: Avx512, bits: u8, a: Register, b: Register) -> Register {
    // SAFETY: the token proves AVX-512F.
    Register(unsafe { [_mm512_mask_mov_pd(b.0[0], bits, a.0[0])] })
}

impl Lanes for Avx512 {
    #[inline(always)]
    fn load_pairs(self, pairs: &[Pair; LANES]) -> [Register; 2] {
        let [low, high] = run_of(self, pairs);
        split(self, low, high)
    }

    #[inline(always)]
    fn store_pairs(self, lanes: [Register; 2], out: &mut [Pair; LANES]) {
        let [low, high] = join(self, lanes);
        let at = out.as_mut_ptr().cast::<f64>();
        // SAFETY: the token proves AVX-512F; eight pairs are sixteen f64 in a row.
        unsafe {
            _mm512_storeu_pd(at, low);
            _mm512_storeu_pd(at.add(LANES), high);
        }
    }

    #[inline(always)]
    fn load_some(self, values: &[f64], fill: f64) -> Register {
        match values.first_chunk() {
            Some(full) => self.load(full),
            None => {
                // SAFETY: the token proves AVX-512F; lanes beyond the end are not read.
                Register(unsafe { [_mm512_mask_loadu_pd(_mm512_set1_pd(fill), first(values.len()), values.as_ptr())] })
            }
        }
    }

    #[inline(always)]
    fn load_some_pairs(self, pairs: &[Pair], fill: Pair) -> [Register; 2] {
        let Some(full) = pairs.first_chunk() else {
            let (at, [low, high]) = (pairs.as_ptr().cast::<f64>(), first_pairs(pairs.len()));
            let (x, y) = (fill.x, fill.y);
            // SAFETY: the token proves AVX-512F; pairs are f64 in a row, lanes beyond the end are not read.
            let (low, high) = unsafe {
                let fill = _mm512_setr_pd(x, y, x, y, x, y, x, y);
                let high = _mm512_mask_loadu_pd(fill, high, at.wrapping_add(LANES));
                (_mm512_mask_loadu_pd(fill, low, at), high)
            };
            return split(self, low, high);
        };
        self.load_pairs(full)
    }

    #[inline(always)]
    fn store_some_pairs(self, lanes: [Register; 2], out: &mut [Pair]) {
        let Some(full) = out.first_chunk_mut() else {
            let [low, high] = join(self, lanes);
            let (at, masks) = (out.as_mut_ptr().cast::<f64>(), first_pairs(out.len()));
            // SAFETY: the token proves AVX-512F; pairs are f64 in a row, lanes beyond the end are not written.
            unsafe {
                _mm512_mask_storeu_pd(at, masks[0], low);
                _mm512_mask_storeu_pd(at.wrapping_add(LANES), masks[1], high);
            }
            return;
        };
        self.store_pairs(lanes, full);
    }

    #[inline(always)]
    fn greatest(self, lanes: Register) -> f64 {
        // SAFETY: the token proves AVX-512F.
        unsafe { _mm512_reduce_max_pd(lanes.0[0]) }
    }

    #[inline(always)]
    fn sum(self, lanes: Register) -> f64 {
        // SAFETY: the token proves AVX-512F.
        unsafe {
            let four = _mm256_add_pd(_mm512_castpd512_pd256(lanes.0[0]), _mm512_extractf64x4_pd::<1>(lanes.0[0]));
            let two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd::<1>(four));
            _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)))
        }
    }

    registers!(Register by slots);

    #[inline(always)]
    fn gather_triangles(self, table: &Table, [first, third]: [Slot; 2]) -> [[Register; 2]; 2] {
        let [low, high] = run_of(self, table.run(first));
        let [a, b] = run_of(self, table.run_beside(first));
        let [c, d] = run_of(self, table.run(third));
        // SAFETY: the token proves AVX-512F.
        unsafe {
            [
                split(self, _mm512_sub_pd(a, low), _mm512_sub_pd(b, high)),
                split(self, _mm512_sub_pd(c, low), _mm512_sub_pd(d, high)),
            ]
        }
    }

    #[inline(always)]
    fn scatter_triangles(
        self,
        table: &mut Table,
        [first, third]: [Slot; 2],
        second: [Register; 2],
        other: [Register; 2],
    ) -> Pair {
        let ([a, b], [c, d]) = (join(self, second), join(self, other));
        // SAFETY: the token proves AVX-512F.
        let [low, high] = unsafe {
            let (p, q) = (_mm512_castpd_si512(a), _mm512_castpd_si512(b));
            let p_before = _mm512_castsi512_pd(_mm512_alignr_epi64::<6>(p, _mm512_setzero_si512()));
            let q_before = _mm512_castsi512_pd(_mm512_alignr_epi64::<6>(q, p));
            [_mm512_sub_pd(p_before, _mm512_add_pd(a, c)), _mm512_sub_pd(q_before, _mm512_add_pd(b, d))]
        };
        add_run(self, table.run_mut(first), low, high);
        add_run(self, table.run_mut(third), c, d);
        // SAFETY: the token proves AVX-512F.
        unsafe {
            let last = _mm256_extractf128_pd::<1>(_mm512_extractf64x4_pd::<1>(b));
            Pair::new(_mm_cvtsd_f64(last), _mm_cvtsd_f64(_mm_unpackhi_pd(last, last)))
        }
    }
}
