//! Two material points that act on each other: a node and an edge, or the ends of a bolt. Contacts and bolts share it.

use crate::cover::{self, BlockId, CoverId, Weights};
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;

/// Two material points of two blocks (or of one), as the open–close iteration needs them (Eq. 17).
#[doc(alias = "Jacobian")]
#[doc(alias = "anchors")]
#[derive(Debug, Clone, Copy, Default)]
pub struct Pair {
    /// Blocks of both points.
    pub blocks: [BlockId; 2],
    /// Covers of both points.
    pub covers: [[CoverId; 3]; 2],
    /// Weights of those covers at the points' current positions.
    pub weights: [Weights; 2],
    /// Arms from the blocks' centroids to the points (m).
    pub arms: [Vector; 2],
    /// z = Σwμ/m of both blocks.
    pub z: [f64; 2],
}

impl Pair {
    /// A cover field at the first point relative to the second.
    #[inline(always)]
    pub fn difference(&self, field: &[Vector]) -> Vector {
        cover::sample(&self.covers[0], &self.weights[0], field)
            - cover::sample(&self.covers[1], &self.weights[1], field)
    }

    /// Sets z; returns the inverse effective mass (m/kg) of both bodies along each axis (Eq. 4).
    #[inline(always)]
    pub fn weigh<const N: usize>(&mut self, mass_matrix: &MassMatrix, axes: [Vector; N]) -> [f64; N] {
        let mut compliance = [0.0; N];
        for body in 0..2 {
            let block = self.blocks[body];
            let share = mass_matrix.inverse_total[block];
            let mut own = Vector::zeros();
            let mut z = 0.0;
            for (&i, w) in self.covers[body].iter().zip(self.weights[body]) {
                let inverse = mass_matrix.inverse[i];
                own += inverse * (w * w);
                z += w * mass_matrix.inertial[i] * inverse.x;
            }
            self.z[body] = z;
            let common = share * (1.0 - 2.0 * z + mass_matrix.square[block] * share);
            for (compliance, axis) in compliance.iter_mut().zip(&axes) {
                let lever = self.arms[body].perp(axis);
                *compliance += own.x * axis.x * axis.x
                    + own.y * axis.y * axis.y
                    + common
                    + mass_matrix.spin[block] * lever * lever;
            }
        }
        compliance
    }
}
