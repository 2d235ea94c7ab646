//! Pieces of joint whose faces have moved away from each other, so far that no water stands between them.

use crate::geometry::{Point, Vector};

/// Motion of the faces of a piece beyond which it has parted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parting {
    /// Slip along it (m).
    pub slip: f64,
    /// Opening across it (m).
    pub opening: f64,
}

impl Parting {
    /// Whether the faces have parted whose ends are now at these places (m), by the motion of their middles along and
    /// across the first one. It does not depend on the way there: faces that come back hold water again.
    pub fn has_come(&self, [own, other]: [[Point; 2]; 2]) -> bool {
        let along = (own[1] - own[0]) / (own[1] - own[0]).norm().max(f64::MIN_POSITIVE);
        let outward = Vector::new(along.y, -along.x);
        let apart = (other[0] - own[0] + (other[1] - own[1])) * 0.5;
        apart.dot(&outward) > self.opening || apart.dot(&along).abs() > self.slip
    }
}
