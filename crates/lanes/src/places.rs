//! Where eight lanes find their pairs in a list.

use super::{LANES, Pair};

/// Indices of eight pairs of a list that is long enough, as is checked once for all eight.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Places {
    /// Twice the indices: places of the values x.
    values: [u32; LANES],
    /// The greatest index.
    greatest: u32,
}

impl Places {
    /// Places by their indices.
    ///
    /// # Panics
    /// When an index is not below 2³¹.
    pub fn new(indices: &[u32; LANES]) -> Self {
        let mut places = Self::default();
        for (lane, &index) in indices.iter().enumerate() {
            places.set(lane, index);
        }
        places
    }

    /// The index `first` and those that follow in equal steps.
    pub const fn in_steps(first: u32, step: u32) -> Self {
        let mut values = [0; LANES];
        let (mut lane, mut greatest) = (0, first);
        while lane < LANES {
            greatest = first + step * lane as u32;
            values[lane] = 2 * greatest;
            lane += 1;
        }
        Self { values, greatest }
    }

    /// Gives a lane another index.
    ///
    /// # Panics
    /// When the index is not below 2³¹, or the lane not below [`LANES`].
    #[inline(always)]
    pub fn set(&mut self, lane: usize, index: u32) {
        assert!(index < 1 << 31, "place {index} of a list");
        self.values[lane] = 2 * index;
        self.greatest = self.greatest.max(index);
    }

    /// Index of a lane.
    #[inline(always)]
    pub fn index(&self, lane: usize) -> u32 {
        self.values[lane] / 2
    }

    /// Addresses of the pairs.
    ///
    /// # Panics
    /// When one of them is outside the list.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub(crate) fn of(&self, pairs: &[Pair]) -> [*const f64; LANES] {
        assert!((self.greatest as usize) < pairs.len(), "place {} of {}", self.greatest, pairs.len());
        let first = pairs.as_ptr().cast::<f64>();
        let mut addresses = [first; LANES];
        for (address, &value) in addresses.iter_mut().zip(&self.values) {
            *address = first.wrapping_add(value as usize);
        }
        addresses
    }

    /// Addresses of the pairs, for writing.
    ///
    /// # Panics
    /// When one of them is outside the list.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub(crate) fn of_mut(&self, pairs: &mut [Pair]) -> [*mut f64; LANES] {
        assert!((self.greatest as usize) < pairs.len(), "place {} of {}", self.greatest, pairs.len());
        let first = pairs.as_mut_ptr().cast::<f64>();
        let mut addresses = [first; LANES];
        for (address, &value) in addresses.iter_mut().zip(&self.values) {
            *address = first.wrapping_add(value as usize);
        }
        addresses
    }
}
