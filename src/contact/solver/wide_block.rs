//! A block of each of eight block pairs, side by side.

use enmm_lanes::{First, LANES, Values};

/// A number of each lane.
pub type F64x8 = [f64; LANES];

/// One block of each block pair under impulses (Eq. 17), and what it answers with.
pub struct WideBlock<L: Values> {
    /// P (N·s/m).
    pub impulse: [L::F; 2],
    /// Z/M (m/s).
    pub weighted: [L::F; 2],
    /// L (N·m·s/m).
    pub moment: L::F,
    /// Sequence number at which it last moved by more than what has settled.
    pub moved: L::F,
    /// (1 + S/M)/M (m/kg).
    pub common: L::F,
    /// C.
    pub spin: L::F,
    /// 1 for a block that keeps impulses.
    pub unit: L::F,
    /// Centroid (m).
    pub centre: [L::F; 2],
}

impl<L: Values> WideBlock<L> {
    /// The first lane.
    #[inline(always)]
    pub fn first(&self, lanes: L) -> WideBlock<First> {
        WideBlock {
            impulse: [first(lanes, self.impulse[0]), first(lanes, self.impulse[1])],
            weighted: [first(lanes, self.weighted[0]), first(lanes, self.weighted[1])],
            moment: first(lanes, self.moment),
            moved: first(lanes, self.moved),
            common: first(lanes, self.common),
            spin: first(lanes, self.spin),
            unit: first(lanes, self.unit),
            centre: [first(lanes, self.centre[0]), first(lanes, self.centre[1])],
        }
    }
}

/// The first of some numbers.
#[inline(always)]
pub fn first<L: Values>(lanes: L, numbers: L::F) -> <First as Values>::F {
    let mut values = [0.0; LANES];
    lanes.store(numbers, &mut values);
    First.load(&values)
}

/// Puts the first of some numbers.
#[inline(always)]
pub fn put_first<L: Values>(lanes: L, numbers: &mut L::F, first: <First as Values>::F) {
    let mut values = [0.0; LANES];
    lanes.store(*numbers, &mut values);
    First.store(first, &mut values);
    *numbers = lanes.load(&values);
}
