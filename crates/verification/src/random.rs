//! Numbers that look random, for problems and tests: a linear congruential generator (D. E. Knuth, *The Art of Computer
//! Programming*, volume 2; the constants are those of MMIX), whose numbers no library can change.

/// A generator; the same start gives the same numbers.
pub struct Random(u64);

impl Random {
    /// Starts from a seed, after which seeds that differ by one have nothing in common.
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        (0..4).for_each(|_| {
            random.word();
        });
        random
    }

    /// Starts from a word as it is.
    pub fn from_word(word: u64) -> Self {
        Self(word)
    }

    /// 64 bits, of which the upper ones look most random.
    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0
    }

    /// A number from 0 on, below 1.
    pub fn unit(&mut self) -> f64 {
        (self.word() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number from `low` on, below `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A whole number from 0 on, below `bound`.
    pub fn below(&mut self, bound: u32) -> u32 {
        (self.unit() * f64::from(bound)) as u32
    }
}
