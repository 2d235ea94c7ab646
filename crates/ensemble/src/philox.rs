//! Counter-based random numbers: Philox4x64-10 (J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC
//! 2011, section 3.3).

use sha2::{Digest, Sha256};

const ROUNDS: usize = 10;
const MULTIPLIERS: [u64; 2] = [0xD2E7_470E_E14C_6C93, 0xCA5A_8263_9512_1157];
/// Increment of the key after each round.
const WEYL: [u64; 2] = [0x9E37_79B9_7F4A_7C15, 0xBB67_AE85_84CA_A73B];

/// The four words of a counter.
fn block(mut key: [u64; 2], mut counter: [u64; 4]) -> [u64; 4] {
    for _ in 0..ROUNDS {
        let wide = |m: u64, x: u64| u128::from(m) * u128::from(x);
        let (first, second) = (wide(MULTIPLIERS[0], counter[0]), wide(MULTIPLIERS[1], counter[2]));
        counter = [
            (second >> 64) as u64 ^ counter[1] ^ key[0],
            second as u64,
            (first >> 64) as u64 ^ counter[3] ^ key[1],
            first as u64,
        ];
        key = [key[0].wrapping_add(WEYL[0]), key[1].wrapping_add(WEYL[1])];
    }
    counter
}

/// Key of the random numbers of a variable: the seed, and the first eight bytes of SHA-256 of its name, big-endian.
fn key_of(seed: u64, name: &str) -> [u64; 2] {
    let digest = Sha256::digest(name.as_bytes());
    [seed, digest.iter().take(8).fold(0, |label, byte| label << 8 | u64::from(*byte))]
}

/// The random number from 0 to 1 of a variable for sample `k`.
pub fn uniform(seed: u64, name: &str, k: u64) -> f64 {
    let word = block(key_of(seed, name), [k + 1, 0, 0, 0])[0];
    ((word >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
}

/// The strata of `n` samples in a random order: which of `n` equal parts each sample lies in.
pub fn strata(seed: u64, name: &str, n: usize) -> Vec<usize> {
    let key = key_of(seed, &format!("{name} strata"));
    let words: Vec<u64> = (1..).flat_map(|counter| block(key, [counter, 0, 0, 0])).take(n).collect();
    places(&words, u64::cmp)
}

/// Place of each value when all are sorted; equal ones keep their order.
pub fn places<T>(values: &[T], compare: impl Fn(&T, &T) -> std::cmp::Ordering) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| compare(&values[a], &values[b]));
    let mut places = vec![0; values.len()];
    order.into_iter().enumerate().for_each(|(place, k)| places[k] = place);
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known answers that the authors publish with their library (Random123, kat_vectors, philox4x64-10).
    #[test]
    fn blocks_are_those_of_the_authors() {
        assert_eq!(
            block([0; 2], [0; 4]),
            [0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b, 0x7e68b68aec7ba23b]
        );
        assert_eq!(
            block([u64::MAX; 2], [u64::MAX; 4]),
            [0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6, 0xa09caebf594f0ba0]
        );
    }

    #[test]
    fn strata_are_a_permutation() {
        let mut strata = strata(3, "a", 101);
        assert_ne!(strata, (0..101).collect::<Vec<_>>());
        strata.sort_unstable();
        assert_eq!(strata, (0..101).collect::<Vec<_>>());
    }
}
