//! Mass matrix: equal-thirds lumped mass of the covers with the rigid-exact correction of free blocks (Eqs. 2–4).

use std::sync::Arc;

use crate::cover::{BlockId, CoverId, Covers};
use crate::geometry::{Point, Vector};

use super::Elasticity;

/// Masses of covers and blocks, which turn forces into accelerations.
///
/// A free block has the rigid-exact metric; a block with any fixed cover or support has the plain lumped one, in which
/// the block terms vanish (`inverse_total` = `spin` = 0).
#[doc(alias = "lumped mass")]
#[doc(alias = "consistent mass")]
#[doc(alias = "rigid-exact metric")]
#[derive(Debug, Clone, Default)]
pub struct MassMatrix {
    /// Lumped mass m of each cover (kg/m).
    pub mass: Arc<[f64]>,
    /// Row-sum mass ∫ρw of each cover (kg/m): the mass that gravity acts on.
    pub row_sum: Arc<[f64]>,
    /// Mass of a cover for the centroid of its block: row-sum in a free block, lumped in a fixed one.
    pub inertial: Vec<f64>,
    /// 1/m along x and y, 0 where fixed.
    pub inverse: Vec<Vector>,
    /// Mass of each block (kg/m).
    pub total: Vec<f64>,
    /// 1/M of a free block, 0 of a fixed one.
    pub inverse_total: Vec<f64>,
    /// S = Σμ²/m of a free block, and (s − 1)·M more of one that is s times lighter.
    pub square: Vec<f64>,
    /// Polar inertia about the centroid in the metric (kg·m²/m): exact in a free block, lumped in a fixed one.
    pub polar: Vec<f64>,
    /// Polar inertia of the lumped masses about their own centroid (kg·m²/m).
    pub polar_lumped: Vec<f64>,
    /// The C of Eq. 3 (1/(kg·m)), not an angular velocity; 0 of a fixed block. As built it is 1/J − 1/J_D; every step
    /// writes that of the current positions, [`BlockMotion::spin`](super::BlockMotion::spin).
    pub spin: Vec<f64>,
    /// Mass scaling: free blocks are lighter by this factor as rigid bodies; their weights are not.
    pub lightness: f64,
    /// Whether no cover of the block can move.
    pub fixed: Vec<bool>,
}

impl MassMatrix {
    /// Masses of all blocks as if free.
    pub fn free(covers: &Covers, rocks: &[Elasticity], element_rock: &[u16]) -> Self {
        let (mut lumped, mut row_sum) = (vec![0.0; covers.cover_count()], vec![0.0; covers.cover_count()]);
        for e in covers.elements() {
            let mass = rocks[element_rock[e] as usize].density * covers.element_area[e];
            let weights = covers.weights(e, covers.element_centroid[e]);
            for (k, &cover) in covers.element_covers[e].iter().enumerate() {
                lumped[cover] += mass / 3.0;
                row_sum[cover] += mass * weights[k];
            }
        }
        let inertial = row_sum.clone();
        let inverse = lumped.iter().map(|m| Vector::repeat(1.0 / m)).collect();
        let (mass, row_sum) = (lumped.into(), row_sum.into());
        let mut mass_matrix = Self { mass, row_sum, inertial, inverse, lightness: 1.0, ..Self::default() };
        for block in covers.blocks() {
            mass_matrix.push_block(covers, rocks, element_rock, block);
        }
        mass_matrix
    }

    fn push_block(&mut self, covers: &Covers, rocks: &[Elasticity], element_rock: &[u16], block: BlockId) {
        let range = covers.covers_of(block);
        let density = |e: usize| rocks[element_rock[e] as usize].density;
        let total: f64 = self.row_sum[range.clone()].iter().sum();
        let elements = covers.elements_of(block);
        let centre: Point =
            elements.clone().map(|e| covers.element_centroid[e] * (density(e) * covers.element_area[e])).sum::<Point>()
                / total;
        let polar: f64 = elements
            .map(|e| {
                let arm = (covers.element_centroid[e] - centre).norm_squared();
                density(e) * (covers.element_polar[e] + covers.element_area[e] * arm)
            })
            .sum();
        let lumped_centre: Point = range.clone().map(|i| covers.star_position[i] * self.mass[i]).sum::<Point>() / total;
        let polar_lumped: f64 =
            range.clone().map(|i| self.mass[i] * (covers.star_position[i] - lumped_centre).norm_squared()).sum();
        self.total.push(total);
        self.inverse_total.push(1.0 / total);
        self.square.push(range.map(|i| self.row_sum[i] * self.row_sum[i] / self.mass[i]).sum());
        self.polar.push(polar);
        self.polar_lumped.push(polar_lumped);
        self.spin.push(1.0 / polar - 1.0 / polar_lumped);
        self.fixed.push(false);
    }

    /// Gives a block the plain lumped metric, which every block with a fixed cover or support needs.
    pub fn hold_block(&mut self, covers: &Covers, block: BlockId) {
        if !self.is_free(block) {
            return;
        }
        for i in covers.covers_of(block) {
            self.inertial[i] = self.mass[i];
        }
        self.inverse_total[block] = 0.0;
        self.square[block] = 0.0;
        self.spin[block] = 0.0;
        self.polar[block] = self.polar_lumped[block];
    }

    /// Fixes a cover along the axes whose flag is set.
    pub fn hold_cover(&mut self, cover: CoverId, axes: [bool; 2]) {
        for (axis, held) in axes.into_iter().enumerate() {
            if held {
                self.inverse[cover][axis] = 0.0;
            }
        }
    }

    /// Makes free blocks lighter as rigid bodies by a factor (Eqs. 73–75); the masses of covers, which limit the step,
    /// stay.
    pub fn lighten(&mut self, lightness: f64) {
        self.lightness = lightness;
        for block in BlockId::all(self.total.len()).filter(|&b| self.inverse_total[b] > 0.0) {
            self.square[block] += (lightness - 1.0) * self.total[block];
            self.polar[block] /= lightness;
        }
    }

    /// Mass (kg/m) of a block under a force through its centroid.
    pub fn rigid_mass(&self, block: BlockId) -> f64 {
        if self.is_free(block) { self.total[block] / self.lightness } else { self.total[block] }
    }

    /// Marks the blocks that cannot move at all.
    pub fn mark_fixed(&mut self, covers: &Covers) {
        for block in covers.blocks() {
            self.fixed[block] = covers.covers_of(block).all(|i| self.inverse[i] == Vector::zeros());
        }
    }

    /// Whether a block has the rigid-exact metric.
    pub fn is_free(&self, block: BlockId) -> bool {
        self.inverse_total[block] > 0.0
    }
}
