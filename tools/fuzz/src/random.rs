//! Random numbers that are a function of seed, part and number of the input, and of nothing else: every input can be
//! made again without those before it.

/// The stream of one input.
pub struct Random {
    key: u64,
    count: u64,
}

impl Random {
    /// The stream of input `index` of a part.
    pub fn new(seed: u64, part: &str, index: u64) -> Self {
        let key = part.bytes().fold(mix(seed), |key, byte| mix(key ^ u64::from(byte)));
        Self { key: mix(key ^ mix(index)), count: 0 }
    }

    /// 64 bits.
    pub fn word(&mut self) -> u64 {
        self.count += 1;
        mix(self.key ^ mix(self.count))
    }

    /// A number below `n`; 0 of none.
    pub fn below(&mut self, n: usize) -> usize {
        (self.word() % n.max(1) as u64) as usize
    }

    /// True in so many of a hundred cases.
    pub fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    /// A number from `low` on, below `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.word() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// One of several.
    pub fn pick<T: Copy>(&mut self, choice: &[T]) -> T {
        choice[self.below(choice.len())]
    }

    /// A number of the kind that breaks things.
    pub fn wild(&mut self) -> f64 {
        const SIZES: [f64; 17] =
            [0.0, -0.0, 1.0, -1.0, 0.5, 1e-300, 5e-324, 1e-12, 1e-6, 1e3, 1e6, 1e12, -1e12, 1e15, -1e15, 1e150, 1e300];
        const ENDS: [f64; 5] = [f64::MAX, f64::MIN, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        match self.below(5) {
            0 => f64::from_bits(self.word()),
            1 => self.between(-10.0, 10.0),
            _ => self.pick(&[&SIZES[..], &ENDS].concat()),
        }
    }
}

/// The finaliser of SplitMix64.
fn mix(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_repeat_and_differ() {
        let words = |seed, part, index| {
            let mut random = Random::new(seed, part, index);
            [random.word(), random.word(), random.word()]
        };
        assert_eq!(words(1, "cases", 7), words(1, "cases", 7));
        for other in [words(2, "cases", 7), words(1, "calls", 7), words(1, "cases", 8)] {
            assert!(words(1, "cases", 7).iter().all(|word| !other.contains(word)));
        }
        let mut random = Random::new(1, "", 0);
        assert!((0..1000).all(|_| (2.0..3.0).contains(&random.between(2.0, 3.0)) && random.below(5) < 5));
    }
}
