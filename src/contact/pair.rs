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
}

impl Pair {
    /// A cover field at the first point relative to the second.
    #[inline(always)]
    pub fn difference(&self, field: &[Vector]) -> Vector {
        cover::sample(&self.covers[0], &self.weights[0], field)
            - cover::sample(&self.covers[1], &self.weights[1], field)
    }

    /// z = Σwμ/m of point `k`.
    #[inline(always)]
    pub fn z(&self, k: usize, mass_matrix: &MassMatrix) -> f64 {
        let of = |(&i, w): (&CoverId, f64)| w * mass_matrix.inertial[i] * mass_matrix.inverse[i].x;
        self.covers[k].iter().zip(self.weights[k]).map(of).sum()
    }

    /// Inverse effective mass (m/kg) of both bodies along an axis (Eq. 4); `arms` (m) lead from the centroids of the
    /// blocks to the points.
    pub fn compliance(&self, mass_matrix: &MassMatrix, arms: &[Vector; 2], axis: Vector) -> f64 {
        let of_body = |k: usize| {
            let (block, lever) = (self.blocks[k], arms[k].perp(&axis));
            let share = mass_matrix.inverse_total[block];
            let of_cover = |(&i, w): (&CoverId, f64)| mass_matrix.inverse[i] * (w * w);
            let own: Vector = self.covers[k].iter().zip(self.weights[k]).map(of_cover).sum();
            let common = share * (1.0 - 2.0 * self.z(k, mass_matrix) + mass_matrix.square[block] * share);
            own.dot(&axis.component_mul(&axis)) + common + mass_matrix.spin[block] * lever * lever
        };
        of_body(0) + of_body(1)
    }
}
