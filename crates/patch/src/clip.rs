//! Polygons cut by straight lines.

use crate::Vector;

/// A point of a polygon that is cut, with the face of the outline along which the polygon goes on from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    pub at: Vector,
    /// None where the polygon goes on along a line that has cut it.
    pub face: Option<u32>,
}

/// A polygon, and a buffer for its next cut.
#[derive(Debug, Clone, Default)]
pub(crate) struct Polygon {
    pub corners: Vec<Corner>,
    buffer: Vec<Corner>,
}

impl Polygon {
    /// Takes over some points in their order.
    pub fn set(&mut self, points: impl Iterator<Item = Vector>) {
        self.corners.clear();
        self.corners.extend((0..).zip(points).map(|(k, at)| Corner { at, face: Some(k) }));
    }

    /// Keeps the part in which `limit - direction·point` is no less than zero. Of an outline that is not convex what is
    /// left may touch itself along the line: sums over it stay right.
    pub fn keep(&mut self, direction: Vector, limit: f64) {
        self.buffer.clear();
        let Some(mut from) = self.corners.last().copied() else { return };
        let mut before = direction.dot(from.at) - limit;
        for &to in &self.corners {
            let after = direction.dot(to.at) - limit;
            let crossing = || from.at + (to.at - from.at) * (before / (before - after));
            if before <= 0.0 && after > 0.0 {
                self.buffer.push(Corner { at: crossing(), face: None });
            } else if before > 0.0 && after <= 0.0 {
                self.buffer.push(Corner { at: crossing(), face: from.face });
            }
            if after <= 0.0 {
                self.buffer.push(to);
            }
            (from, before) = (to, after);
        }
        std::mem::swap(&mut self.corners, &mut self.buffer);
    }

    /// Its sides: both ends, and the face of the outline on which each lies.
    pub fn sides(&self) -> impl Iterator<Item = ([Vector; 2], Option<u32>)> + '_ {
        let ends = self.corners.iter().zip(self.corners.iter().cycle().skip(1));
        ends.map(|(from, to)| ([from.at, to.at], from.face))
    }
}
