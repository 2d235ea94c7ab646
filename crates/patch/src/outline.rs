//! The outline of a body: a closed chain of straight faces.

use crate::Vector;

/// Closed chain of straight faces round a body, counterclockwise: face `k` leads from point `k` to the next one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outline {
    /// Ends of the faces (m).
    pub points: Vec<Vector>,
}

/// A face with its own axes: `s` runs along it, `y` into the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// Where it begins (m).
    pub start: Vector,
    /// Unit vector along it.
    pub tangent: Vector,
    /// Its length (m).
    pub length: f64,
}

impl Face {
    /// The face from one point to another one.
    pub fn between(start: Vector, end: Vector) -> Self {
        let along = end - start;
        let length = along.norm();
        Self { start, tangent: along * (1.0 / length), length }
    }

    /// Unit normal that points out of the body.
    #[inline]
    pub fn normal(&self) -> Vector {
        -self.tangent.left()
    }

    /// Way along the face and depth under it (m) of a point.
    #[inline]
    pub fn local(&self, point: Vector) -> Vector {
        let arm = point - self.start;
        Vector::new(arm.dot(self.tangent), arm.dot(self.tangent.left()))
    }

    /// The point with a way along the face and a depth under it (m).
    #[inline]
    pub fn global(&self, local: Vector) -> Vector {
        self.start + self.tangent * local.x + self.tangent.left() * local.y
    }
}

impl Outline {
    /// The outline through some points, counterclockwise.
    pub fn new(points: Vec<Vector>) -> Self {
        Self { points }
    }

    /// Number of its faces.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether it has no face.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The face behind face `k`.
    #[inline]
    pub fn next(&self, k: usize) -> usize {
        if k + 1 == self.points.len() { 0 } else { k + 1 }
    }

    /// The face before face `k`.
    #[inline]
    pub fn previous(&self, k: usize) -> usize {
        if k == 0 { self.points.len() - 1 } else { k - 1 }
    }

    /// Face `k` with its axes.
    #[inline]
    pub fn face(&self, k: usize) -> Face {
        Face::between(self.points[k], self.points[self.next(k)])
    }

    /// Least and greatest coordinates (m).
    pub fn bounds(&self) -> [Vector; 2] {
        let far = Vector::new(f64::INFINITY, f64::INFINITY);
        self.points.iter().fold([far, -far], |[low, high], p| {
            [Vector::new(low.x.min(p.x), low.y.min(p.y)), Vector::new(high.x.max(p.x), high.y.max(p.y))]
        })
    }

    /// Area (m²).
    pub fn area(&self) -> f64 {
        let origin = self.points[0];
        let half = |k: usize| 0.5 * (self.points[k] - origin).cross(self.points[self.next(k)] - origin);
        (0..self.len()).map(half).sum()
    }
}
