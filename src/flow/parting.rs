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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_part_by_slip_or_by_opening_and_come_back() {
        let parting = Parting { slip: 0.5, opening: 0.05 };
        let face = |x: f64, y: f64| [Point::new(x, y), Point::new(x + 3.0, y + 4.0)];
        // Outward of the first face is (0.8, -0.6), along it (0.6, 0.8).
        let moved = |along: f64, across: f64| face(0.6 * along + 0.8 * across, 0.8 * along - 0.6 * across);
        let has_come = |along, across| parting.has_come([face(0.0, 0.0), moved(along, across)]);
        assert!(!has_come(0.0, 0.0) && !has_come(0.49, 0.049) && !has_come(-0.49, -3.0));
        assert!(has_come(0.51, 0.0) && has_come(-0.51, 0.0) && has_come(0.0, 0.051));
    }
}
