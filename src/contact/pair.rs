//! Two material points that act on each other: a node and an edge, or the ends of a bolt. Contacts and bolts share it.

use enmm_lanes::Arithmetic;

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
            let block = self.blocks[k];
            let of_cover = |(&i, w): (&CoverId, f64)| mass_matrix.inverse[i] * (w * w);
            let own: Vector = self.covers[k].iter().zip(self.weights[k]).map(of_cover).sum();
            let mass_share = self.z(k, mass_matrix) * mass_matrix.inverse_total[block];
            let common = common_share(mass_matrix, block) - (mass_share + mass_share);
            compliance_of_body(own.into(), common, mass_matrix.spin[block], axis.into(), arms[k].perp(&axis))
        };
        of_body(0) + of_body(1)
    }
}

/// Inverse effective mass (m/kg) of one body along an axis (Eq. 4): from Σw²/m of its covers by axis, the share
/// (1 − 2z + S/M)/M and C of its block, and the lever (m) of the axis about the centroid.
#[inline(always)]
pub fn compliance_of_body<T: Arithmetic>([a, b]: [T; 2], common: T, spin: T, [x, y]: [T; 2], lever: T) -> T {
    a * x * x + b * y * y + common + spin * lever * lever
}

/// Velocity (m/s) that all impulses on a block give one of its points, but for those on its own covers (Eq. 17): from
/// P, Z/M and CL of the block, the share (1 − z + S/M)/M of the point and its arm turned by 90° (m).
#[inline(always)]
pub fn velocity_of_body<T: Arithmetic>(p: [T; 2], weighted: [T; 2], turn: T, share: T, lever: [T; 2]) -> [T; 2] {
    [p[0] * share - weighted[0] + lever[0] * turn, p[1] * share - weighted[1] + lever[1] * turn]
}

/// (1 + S/M)/M of a block (m/kg), 0 of a held one.
#[inline(always)]
pub fn common_share(mass_matrix: &MassMatrix, block: BlockId) -> f64 {
    let inverse = mass_matrix.inverse_total[block];
    (1.0 + mass_matrix.square[block] * inverse) * inverse
}
