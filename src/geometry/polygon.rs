//! Measures of one polygon and the overlap of two.
//!
//! Knows closed loops of points, counter-clockwise positive; nothing of where they come from.

use super::{Point, cross};

/// Returns the signed area of a polygon (m²), positive counter-clockwise.
pub fn area(polygon: &[Point]) -> f64 {
    let Some(&base) = polygon.first() else { return 0.0 };
    0.5 * polygon.windows(2).map(|side| cross(side[0] - base, side[1] - base)).sum::<f64>()
}
