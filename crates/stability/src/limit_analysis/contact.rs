//! Where two blocks can press on each other: a shared straight piece of their faces, or a point.

use enmm::geometry::{Point, Vector};
use enmm::model::tables::BlockId;

/// A straight interface, or a point where a corner meets a face; forces per metre of depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// First and second block.
    pub blocks: [BlockId; 2],
    /// Both ends (m), the same place for a point.
    pub ends: [Point; 2],
    /// Unit vector from the first block to the second, normal to the face.
    pub normal: Vector,
    /// tan φ.
    pub friction: f64,
    /// Shear strength (N/m) without a normal force.
    pub cohesion: f64,
    /// Tensile strength (N/m).
    pub tension: f64,
    /// tan ψ.
    pub dilation: f64,
    /// Normal and shear stiffness (Pa).
    pub stiffness: [f64; 2],
}

impl Contact {
    /// Whether it is a position and not a length.
    pub fn is_point(&self) -> bool {
        self.ends[0] == self.ends[1]
    }

    /// Where normal forces act: both ends, or the point.
    pub fn ends(&self) -> &[Point] {
        if self.is_point() { &self.ends[..1] } else { &self.ends[..] }
    }

    /// Shear strength (N/m) under a normal force (N/m, compression positive).
    pub fn shear_strength(&self, normal: f64) -> f64 {
        (self.cohesion + self.friction * normal).max(0.0)
    }

    /// The same joint with nothing but friction.
    pub fn bare(self) -> Self {
        Self { cohesion: 0.0, tension: 0.0, ..self }
    }

    /// Slip (m/s) at which its ends part by these velocities (m/s), and by how much each end opens beyond slip times
    /// `dilation`.
    pub fn opening(&self, partings: &[Vector], dilation: f64) -> (f64, Vec<f64>) {
        let slip = partings[0].dot(&self.tangent()).abs();
        (slip, partings.iter().map(|parting| parting.dot(&self.normal) - dilation * slip).collect())
    }

    /// Unit vector along the face, the normal turned by +90°.
    pub fn tangent(&self) -> Vector {
        Vector::new(-self.normal.y, self.normal.x)
    }
}

/// Normal out of rock on the left of a direction.
pub fn outward(direction: Vector) -> Vector {
    Vector::new(direction.y, -direction.x).normalize()
}
