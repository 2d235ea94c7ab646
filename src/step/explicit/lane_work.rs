//! Work on elements that can yield, eight at a time.

use std::ops::Range;

use enmm_lanes::{First, Kernel, LANES, Lanes, Values, dispatch};

use crate::cover::ElementId;
use crate::mechanics::ElementRow;
use crate::state::Model;

/// Work on elements of one rock in a row, in lanes.
pub(super) trait LaneWork {
    /// Does it on some elements, whose places are given.
    fn elements<V: Values>(&mut self, values: V, row: &ElementRow, elements: Range<usize>);
}

/// Does a work on the elements of a range that can yield, eight by eight where they are of one rock. The range begins
/// at a multiple of eight.
pub(super) fn in_lanes(model: &Model, elements: Range<usize>, work: impl LaneWork) {
    dispatch(InLanes { model, elements, work });
}

struct InLanes<'a, W> {
    model: &'a Model,
    elements: Range<usize>,
    work: W,
}

impl<W: LaneWork> Kernel for InLanes<'_, W> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let Range { start, end } = self.elements;
        for first in (start..end).step_by(LANES) {
            match self.model.averaging.row(first) {
                Some(row) if L::IN_REGISTERS => self.work.elements(lanes, row, first..first + LANES),
                _ => alone(self.model, first..(first + LANES).min(end), &mut self.work),
            }
        }
    }
}

/// Does a work on elements one by one. Apart from the lanes, so that the program has it once.
#[inline(never)]
fn alone(model: &Model, elements: Range<usize>, work: &mut impl LaneWork) {
    for e in ElementId::range(elements).filter(|&e| model.strength_of(e).is_some()) {
        let one = e.index()..e.index() + 1;
        work.elements(First, &ElementRow::new(&model.covers, &model.averaging, one.clone()), one);
    }
}
