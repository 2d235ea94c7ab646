//! Looks at the stress of rock that has not yielded, up to eight elements at once.

use std::ops::Range;

use enmm_lanes::{Kernel, LANES, Lanes};

use crate::cover::{Covers, ElementId};
use crate::geometry::Vector;

use super::{Elasticity, ElementRow, PreStress};

/// Elastic stress and strain energy of elements, eight at once.
pub struct ElasticElements<'a, S> {
    /// Covers and elements.
    pub covers: &'a Covers,
    /// Rocks.
    pub rocks: &'a [Elasticity],
    /// Rock of each element.
    pub element_rock: &'a [u16],
    /// In-situ stress of each element (Pa); empty when there is none.
    pub pre_stress: &'a [PreStress],
    /// Displacements of all covers (m).
    pub displacement: &'a [Vector],
    /// Elements that are looked at.
    pub elements: Range<usize>,
    /// Takes stress xx, yy, xy (Pa, global axes) and energy (J per m² of reference area) of each, in their order.
    pub see: S,
}

impl<S: FnMut(ElementId, [f64; 3], f64)> Kernel for ElasticElements<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let Range { start, end } = self.elements;
        for first in (start..end).step_by(LANES) {
            let eight = first..(first + LANES).min(end);
            let ([xx, yy, xy], energy) = self.eight(lanes, eight.clone());
            for (lane, e) in ElementId::range(eight).enumerate() {
                (self.see)(e, [xx[lane], yy[lane], xy[lane]], energy[lane]);
            }
        }
    }
}

impl<S> ElasticElements<'_, S> {
    /// Stress and energy of at most eight elements.
    #[inline(always)]
    fn eight<L: Lanes>(&self, lanes: L, elements: Range<usize>) -> ([[f64; LANES]; 3], [f64; LANES]) {
        let Self { covers, rocks, element_rock, pre_stress, .. } = *self;
        let row = ElementRow::of_elastic(covers, elements.clone());
        let at = row.deformation(lanes, self.displacement, &covers.gradients);
        let (mut constants, mut pre) = ([[0.0; LANES]; 2], [[0.0; LANES]; 3]);
        for (lane, rock) in element_rock[elements.clone()].iter().enumerate() {
            [constants[0][lane], constants[1][lane]] = rocks[*rock as usize].constants();
        }
        for (lane, stress) in pre_stress.get(elements).unwrap_or_default().iter().enumerate() {
            (0..3).for_each(|k| pre[k][lane] = stress[k]);
        }
        let (constants, pre) = (constants.map(|values| lanes.load(&values)), pre.map(|values| lanes.load(&values)));
        let store = |values| {
            let mut out = [0.0; LANES];
            lanes.store(values, &mut out);
            out
        };
        (at.stress(&constants, &pre).map(store), store(at.energy(&constants, &pre)))
    }
}
