//! Straight segments.

use super::Point;

/// Returns the distance (m) from a point to the segment between `a` and `b`.
pub fn distance(p: Point, a: Point, b: Point) -> f64 {
    let d = b - a;
    let along = ((p - a).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (p - a - d * along).norm()
}

/// Returns the point of the segment between `a` and `b`, which are apart, that is nearest to another.
pub fn foot(p: Point, a: Point, b: Point) -> Point {
    a + (b - a) * ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_ends_at_the_ends() {
        let (a, b) = (Point::new(0.0, 0.0), Point::new(2.0, 0.0));
        for (p, expected) in [((1.0, 3.0), 3.0), ((-3.0, 4.0), 5.0), ((5.0, 0.0), 3.0)] {
            assert_eq!(distance(Point::new(p.0, p.1), a, b), expected);
        }
    }
}
