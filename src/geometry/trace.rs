//! Joint traces cut by others and divided by regions.

use super::polygon::{contains, sides};
use super::{Point, cross};

/// Where a segment crosses the sides of a polygon, as shares of its length, ascending, with its ends 0 and 1.
pub(super) fn crossings(region: &[Point], a: Point, b: Point) -> Vec<f64> {
    let along = b - a;
    let mut cuts = vec![0.0, 1.0];
    for (c, d) in sides(region) {
        let (side_c, side_d) = (cross(along, c - a), cross(along, d - a));
        if (side_c <= 0.0) != (side_d <= 0.0) {
            let crossing = c + (d - c) * (side_c / (side_c - side_d));
            cuts.push((crossing - a).dot(&along) / along.norm_squared());
        }
    }
    cuts.retain(|cut| (0.0..=1.0).contains(cut));
    cuts.sort_unstable_by(f64::total_cmp);
    cuts
}

/// Divides a polyline at the border of a polygon into pieces, from its start to its end, each with whether it lies
/// inside. A polyline that the border does not cross comes back as it is.
pub fn divide(line: &[Point], region: &[Point]) -> Vec<(Vec<Point>, bool)> {
    let mut pieces: Vec<(Vec<Point>, bool)> = Vec::new();
    for pair in line.windows(2).filter(|pair| pair[0] != pair[1]) {
        let (a, along) = (pair[0], pair[1] - pair[0]);
        for cut in crossings(region, a, pair[1]).windows(2).filter(|cut| cut[0] < cut[1]) {
            let inside = contains(region, a + along * (0.5 * (cut[0] + cut[1])));
            let [from, to] = [cut[0], cut[1]].map(|share| if share == 1.0 { pair[1] } else { a + along * share });
            match pieces.last_mut().filter(|(_, was)| *was == inside) {
                Some((points, _)) => {
                    // A border that is touched divides nothing.
                    if cut[0] > 0.0 {
                        points.pop();
                    }
                    points.push(to);
                }
                None => pieces.push((vec![from, to], inside)),
            }
        }
    }
    pieces
}

/// The part of a trace about its middle that ends where it meets the first of `others` on both sides.
pub fn end_on<'a>([a, b]: [Point; 2], others: impl Iterator<Item = &'a [Point]>) -> [Point; 2] {
    let along = b - a;
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for pair in others.flat_map(|line| line.windows(2)) {
        let (c, d) = (pair[0], pair[1]);
        let (side_c, side_d) = (cross(along, c - a), cross(along, d - a));
        let (side_a, side_b) = (cross(d - c, a - c), cross(d - c, b - c));
        if (side_c <= 0.0) == (side_d <= 0.0) || side_a == side_b {
            continue;
        }
        let share = side_a / (side_a - side_b);
        if share <= 0.5 {
            from = from.max(share);
        } else {
            to = to.min(share);
        }
    }
    let at = |share: f64, end: Point| if share == 0.0 || share == 1.0 { end } else { a + along * share };
    [at(from, a), at(to, b)]
}
