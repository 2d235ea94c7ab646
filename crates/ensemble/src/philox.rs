//! Random numbers of variables by the number of the sample, from a counter-based generator.

use enmm_case::philox::{block, unit};
use sha2::{Digest, Sha256};

/// Key of the random numbers of a variable: the seed, and the first eight bytes of SHA-256 of its name, big-endian.
fn key_of(seed: u64, name: &str) -> [u64; 2] {
    let digest = Sha256::digest(name.as_bytes());
    [seed, digest.iter().take(8).fold(0, |label, byte| label << 8 | u64::from(*byte))]
}

/// The random number from 0 to 1 of a variable for sample `k`.
pub fn uniform(seed: u64, name: &str, k: u64) -> f64 {
    unit(block(key_of(seed, name), [k + 1, 0, 0, 0])[0])
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

    #[test]
    fn strata_are_a_permutation() {
        let mut strata = strata(3, "a", 101);
        assert_ne!(strata, (0..101).collect::<Vec<_>>());
        strata.sort_unstable();
        assert_eq!(strata, (0..101).collect::<Vec<_>>());
    }
}
