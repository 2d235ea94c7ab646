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
}

impl Contact {
    /// Whether it is a position and not a length.
    pub fn is_point(&self) -> bool {
        self.ends[0] == self.ends[1]
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
