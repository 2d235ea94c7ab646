//! Rock that yields, up to eight elements at once: where lanes find their covers, patches and plastic strains.

use std::ops::Range;

use enmm_lanes::{Places, Values, as_pairs};

use crate::cover::{Covers, ElementId};
use crate::geometry::Vector;

use super::averaging::Averaging;
use super::{Deformation, PlasticStrain};

/// Elements of one rock in a row, at most eight.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ElementRow {
    covers: [Places; 3],
    /// Those with the second set of gradients, as bits.
    second: u8,
    patches: PatchPlaces,
}

impl ElementRow {
    /// The elements of a range.
    #[inline(always)]
    pub fn new(covers: &Covers, averaging: &Averaging, elements: Range<usize>) -> Self {
        let mut row = Self::of_elastic(covers, elements.clone());
        ElementId::range(elements).enumerate().for_each(|(lane, e)| row.patches.set(lane, e, averaging));
        row
    }

    /// The elements of a range, whose patches nobody needs.
    #[inline(always)]
    pub fn of_elastic(covers: &Covers, elements: Range<usize>) -> Self {
        let mut row = Self::default();
        for (lane, e) in ElementId::range(elements).enumerate() {
            row.covers.iter_mut().zip(covers.element_covers[e]).for_each(|(at, id)| at.set(lane, id.number()));
            row.second |= covers.element_triangle[e].set << lane;
        }
        row
    }

    /// Pairs of a list at the three covers.
    #[inline(always)]
    pub fn of_covers<V: Values>(&self, values: V, list: &[Vector]) -> [[V::F; 2]; 3] {
        let [a, b, c] = &self.covers;
        [values.gather_from(list, a), values.gather_from(list, b), values.gather_from(list, c)]
    }

    /// Gradients (1/m) of the three weights.
    #[inline(always)]
    pub fn gradients<V: Values>(&self, values: V, [up, down]: &[[Vector; 3]; 2]) -> [[V::F; 2]; 3] {
        let mut gradients = [[values.splat(0.0); 2]; 3];
        for (k, gradient) in gradients.iter_mut().enumerate() {
            for (axis, value) in gradient.iter_mut().enumerate() {
                *value = values.select(self.second, values.splat(down[k][axis]), values.splat(up[k][axis]));
            }
        }
        gradients
    }

    /// Deformation under displacements of all covers (m).
    #[inline(always)]
    pub fn deformation<V: Values>(&self, values: V, u: &[Vector], g: &[[Vector; 3]; 2]) -> Deformation<V::F> {
        Deformation::of_covers(values, &self.of_covers(values, u), &self.gradients(values, g))
    }

    /// Means over the patches of each of pairs that all patches have, or its own in no patch.
    #[inline(always)]
    pub fn averaged<V: Values>(&self, values: V, of_patches: &[[f64; 2]], own: [V::F; 2]) -> [V::F; 2] {
        let PatchPlaces { outside, .. } = self.patches;
        let means = self.patches.means(values, of_patches);
        [values.select(outside, own[0], means[0]), values.select(outside, own[1], means[1])]
    }

    /// Pairs of the elements, of a list of theirs.
    #[inline(always)]
    pub fn own<V: Values>(values: V, list: &[[f64; 2]]) -> [V::F; 2] {
        const EACH: Places = Places::in_steps(0, 1);
        values.gather_from(as_pairs(list), &EACH)
    }

    /// Plastic strain xx, yy, xy, zz of the elements, of a list of theirs.
    #[inline(always)]
    pub fn plastic<V: Values>(values: V, list: &[PlasticStrain]) -> [V::F; 4] {
        const EACH: PlasticPlaces = PlasticPlaces(Places::in_steps(0, 2));
        EACH.of(values, list)
    }
}

/// Where up to eight elements find their patches.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PatchPlaces {
    at: [Places; 3],
    /// Elements in no patch, as bits.
    pub outside: u8,
}

impl PatchPlaces {
    /// Gives a lane an element.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, element: ElementId, averaging: &Averaging) {
        match averaging.patches_of(element) {
            Some(patches) => self.at.iter_mut().zip(patches).for_each(|(at, id)| at.set(lane, id.number())),
            None => self.outside |= 1 << lane,
        }
    }

    /// Means over three patches each of pairs that all patches have; zero when there is no patch.
    #[inline(always)]
    pub fn means<V: Values>(&self, values: V, of_patches: &[[f64; 2]]) -> [V::F; 2] {
        if of_patches.is_empty() {
            return [values.splat(0.0); 2];
        }
        let (pairs, [a, b, c]) = (as_pairs(of_patches), &self.at);
        let (a, b, c) = (values.gather_from(pairs, a), values.gather_from(pairs, b), values.gather_from(pairs, c));
        let three = values.splat(3.0);
        [(a[0] + b[0] + c[0]) / three, (a[1] + b[1] + c[1]) / three]
    }
}

/// Where up to eight elements find their plastic strain.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PlasticPlaces(Places);

impl PlasticPlaces {
    /// Gives a lane an element.
    pub fn set(&mut self, lane: usize, element: ElementId) {
        self.0.set(lane, 2 * element.number());
    }

    /// Plastic strain xx, yy, xy, zz of the lanes.
    #[inline(always)]
    pub fn of<V: Values>(&self, values: V, list: &[PlasticStrain]) -> [V::F; 4] {
        let pairs = as_pairs(list.as_flattened().as_chunks().0);
        let ([xx, yy], [xy, zz]) = (values.gather_from(pairs, &self.0), values.gather_from(&pairs[1..], &self.0));
        [xx, yy, xy, zz]
    }
}
