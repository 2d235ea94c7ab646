//! Straight segments.

use super::Point;

/// Returns the distance (m) from a point to the segment between `a` and `b`.
pub fn distance(p: Point, a: Point, b: Point) -> f64 {
    (p - a - (b - a) * share(p, a, b)).norm()
}

/// Returns the point of the segment between `a` and `b` that is nearest to another.
pub fn foot(p: Point, a: Point, b: Point) -> Point {
    a + (b - a) * share(p, a, b)
}

/// The share of the way from `a` to `b` at which a point is nearest; 0 where they are one point.
fn share(p: Point, a: Point, b: Point) -> f64 {
    let along = b - a;
    ((p - a).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
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

    #[test]
    fn a_segment_without_length_is_a_point() {
        let (a, p) = (Point::new(1.0, 2.0), Point::new(4.0, 6.0));
        assert_eq!((foot(p, a, a), foot(a, a, a), distance(p, a, a)), (a, a, 5.0));
    }
}
