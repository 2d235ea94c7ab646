//! Supports: springs that fix a material point along one direction, and dashpots of quiet boundaries. The open–close
//! iteration solves them together with the contacts (Eqs. 23, 47).

use crate::cover::{self, BlockId, CoverId, Weights};
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;

/// Whether a support resists displacement or velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Resistance {
    /// Displacement.
    Spring,
    /// Velocity: part of a quiet boundary, by its index.
    Dashpot(u32),
}

/// A spring or dashpot between a material point and the ground.
#[doc(alias = "boundary spring")]
#[doc(alias = "dashpot")]
#[doc(alias = "Lysmer-Kuhlemeyer")]
#[derive(Debug, Clone, PartialEq)]
pub struct Support {
    /// Fixity that it belongs to: those of the case, then those of quiet boundaries.
    pub fix: u32,
    /// Block.
    pub block: BlockId,
    /// Covers of the point.
    pub covers: [CoverId; 3],
    /// Their weights at the point.
    pub weights: Weights,
    /// Unit direction of the support.
    pub direction: Vector,
    /// Spring or dashpot.
    pub resistance: Resistance,
    /// Stiffness of a spring (N/m per metre), viscosity of a dashpot (N·s/m per metre).
    pub stiffness: f64,
    /// Force (N/m) at zero displacement, from in-situ stress.
    pub preload: f64,
}

/// A support during one step.
#[derive(Debug, Clone, Copy)]
pub struct SupportRow {
    /// Index of the support.
    pub support: u32,
    /// Displacement along the direction (m).
    pub displacement: f64,
    /// Force (N/m) if the velocity at the end of the step is zero.
    pub target: f64,
    /// Loss of force per velocity at the end of the step (N·s/m per metre).
    pub viscosity: f64,
    /// Predicted velocity along it (m/s).
    pub approach: f64,
    /// Inverse effective mass (m/kg).
    pub compliance: f64,
    /// Force on the rock along the direction (N/m).
    pub force: f64,
}

impl Support {
    /// Whether it is a dashpot.
    pub fn is_dashpot(&self) -> bool {
        match self.resistance {
            Resistance::Spring => false,
            Resistance::Dashpot(_) => true,
        }
    }

    /// Sum of a cover field at the point, along the direction.
    pub fn sample(&self, field: &[Vector]) -> f64 {
        cover::sample(&self.covers, &self.weights, field).dot(&self.direction)
    }

    /// Inverse effective mass of the point along the direction (m/kg); its block has the plain lumped metric.
    pub fn compliance(&self, mass_matrix: &MassMatrix) -> f64 {
        let square = self.direction.component_mul(&self.direction);
        self.covers.iter().zip(self.weights).map(|(&i, w)| mass_matrix.inverse[i].dot(&square) * w * w).sum()
    }

    /// Adds an impulse (N·s/m) along the direction to the velocity increments of the covers.
    pub fn push(&self, impulse: f64, mass_matrix: &MassMatrix, increment: &mut [Vector]) {
        for (&i, w) in self.covers.iter().zip(self.weights) {
            increment[i] += mass_matrix.inverse[i].component_mul(&self.direction) * (w * impulse);
        }
    }
}
