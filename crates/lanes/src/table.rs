//! A small table of pairs that lanes gather from and scatter to without checks: a slot is always inside.

use super::{LANES, Pair};

/// Slots of a table.
pub const SLOTS: usize = 4096;

/// Place in a [`Table`]; always below [`SLOTS`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Slot(u16);

impl Slot {
    /// The slot of an index.
    ///
    /// # Panics
    /// When the index is not below [`SLOTS`].
    pub fn new(index: usize) -> Self {
        assert!(index < SLOTS, "slot {index} of {SLOTS}");
        Self(index as u16)
    }

    /// Index of the slot.
    #[inline(always)]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// All pairs of a table, where eight values in a row from every fourth slot on share a line of the cache.
#[derive(Debug, Clone)]
#[repr(align(64))]
struct Pairs([Pair; SLOTS + LANES]);

/// Pairs in slots, with room for a run of lanes behind the last slot.
#[derive(Debug, Clone)]
pub struct Table {
    pairs: Box<Pairs>,
}

impl Default for Table {
    fn default() -> Self {
        Self { pairs: Box::new(Pairs([Pair::zeros(); SLOTS + LANES])) }
    }
}

impl Table {
    /// The first `count` pairs.
    #[inline(always)]
    pub fn first(&self, count: usize) -> &[Pair] {
        &self.pairs.0[..count]
    }

    /// The first `count` pairs.
    #[inline(always)]
    pub fn first_mut(&mut self, count: usize) -> &mut [Pair] {
        &mut self.pairs.0[..count]
    }

    /// The pair of a slot.
    #[inline(always)]
    pub fn at(&self, slot: Slot) -> &Pair {
        // SAFETY: a slot is below SLOTS, which is below the length.
        unsafe { self.pairs.0.get_unchecked(slot.index()) }
    }

    /// The pair of a slot.
    #[inline(always)]
    pub fn at_mut(&mut self, slot: Slot) -> &mut Pair {
        // SAFETY: a slot is below SLOTS, which is below the length.
        unsafe { self.pairs.0.get_unchecked_mut(slot.index()) }
    }

    /// Addresses of the two values of each slot.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub(crate) fn addresses(&self, slots: &[Slot; LANES]) -> [*const f64; LANES] {
        let mut addresses = [std::ptr::null(); LANES];
        for (address, &slot) in addresses.iter_mut().zip(slots) {
            *address = std::ptr::from_ref(self.at(slot)).cast();
        }
        addresses
    }

    /// Address of the two values of a slot.
    #[inline(always)]
    pub(crate) fn values_mut(&mut self, slot: Slot) -> *mut f64 {
        std::ptr::from_mut(self.at_mut(slot)).cast()
    }

    /// Eight pairs from a slot on.
    #[inline(always)]
    pub(crate) fn run(&self, first: Slot) -> &[Pair; LANES] {
        // SAFETY: a slot is below SLOTS, and LANES pairs stand behind the last one; arrays align as their elements.
        unsafe { &*self.pairs.0.as_ptr().add(first.index()).cast() }
    }

    /// Eight pairs from a slot on.
    #[inline(always)]
    pub(crate) fn run_mut(&mut self, first: Slot) -> &mut [Pair; LANES] {
        // SAFETY: as for `run`; the table is borrowed alone.
        unsafe { &mut *self.pairs.0.as_mut_ptr().add(first.index()).cast() }
    }

    /// Eight pairs after a slot.
    #[inline(always)]
    pub(crate) fn run_beside(&self, first: Slot) -> &[Pair; LANES] {
        // SAFETY: as for `run`: the pair of the slot is followed by LANES pairs.
        unsafe { &*self.pairs.0.as_ptr().add(first.index() + 1).cast() }
    }

    /// Adds to the pair that a run of eight from the slot on ends before.
    #[inline(always)]
    pub fn add_beside(&mut self, first: Slot, pair: Pair) {
        // SAFETY: as for `run_beside`; the table is borrowed alone.
        unsafe { *self.pairs.0.get_unchecked_mut(first.index() + LANES) += pair }
    }

    /// Eights that together hold the first `count` pairs.
    #[inline(always)]
    pub(crate) fn first_eights_mut(&mut self, count: usize) -> &mut [[Pair; LANES]] {
        &mut self.pairs.0.as_chunks_mut().0[..count.div_ceil(LANES)]
    }
}
