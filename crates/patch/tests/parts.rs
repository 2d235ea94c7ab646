//! Random numbers and shapes for the tests of contact by faces.

use enmm_patch::Vector;

/// Random numbers by xorshift.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// Numbers of a seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        (0..16).fold(0.0, |_, _| random.share());
        random
    }

    /// Between 0 and 1.
    pub fn share(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }
}

/// Whether the long form of a test is asked for, by `ENMM_LONG=1`.
pub fn is_long() -> bool {
    std::env::var("ENMM_LONG").is_ok_and(|value| value == "1")
}

/// The same vector turned by some degrees.
pub fn turned(vector: Vector, degrees: f64) -> Vector {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    vector * cosine + vector.left() * sine
}

/// Points turned by some degrees about another one.
pub fn turned_about(points: &[Vector], degrees: f64, centre: Vector) -> Vec<Vector> {
    points.iter().map(|&point| centre + turned(point - centre, degrees)).collect()
}

/// Points from pairs of coordinates.
pub fn points(pairs: &[[f64; 2]]) -> Vec<Vector> {
    pairs.iter().map(|&[x, y]| Vector::new(x, y)).collect()
}

/// A rectangle between two corners.
pub fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> Vec<Vector> {
    points(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
}

/// Area and centre of a polygon.
pub fn area_and_centre(polygon: &[Vector]) -> (f64, Vector) {
    let origin = polygon[0];
    let (mut area, mut moment) = (0.0, Vector::default());
    for (k, &point) in polygon.iter().enumerate() {
        let (p, q) = (point - origin, polygon[(k + 1) % polygon.len()] - origin);
        area += 0.5 * p.cross(q);
        moment += (p + q) * (p.cross(q) / 6.0);
    }
    (area, origin + moment * (1.0 / area))
}

/// The part of a convex polygon in which `direction·point` is no more than a limit.
pub fn cut(polygon: &[Vector], direction: Vector, limit: f64) -> Vec<Vector> {
    let mut left = Vec::new();
    for (k, &from) in polygon.iter().enumerate() {
        let to = polygon[(k + 1) % polygon.len()];
        let [before, after] = [from, to].map(|point| direction.dot(point) - limit);
        if before <= 0.0 {
            left.push(from);
        }
        if before * after < 0.0 {
            left.push(from + (to - from) * (before / (before - after)));
        }
    }
    left
}
