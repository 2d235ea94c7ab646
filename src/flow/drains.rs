//! Drains that cross the joints of a net.

use crate::contact::Facing;
use crate::geometry::{Point, segment};

/// A drain, or a well with a pump.
#[derive(Debug, Clone, PartialEq)]
pub struct Drain {
    /// Name.
    pub name: String,
    /// Its nodes, in their order.
    pub nodes: Vec<u32>,
    /// Height (m) of its mouth.
    pub mouth: f64,
    /// Flow (m²/s) that a pump takes from all nodes together.
    pub pump: Option<f64>,
    /// Whether it acts, by stage.
    pub active: Vec<bool>,
}

/// Pieces of joint, parted where they cross lines farther than a tolerance (m) from both of their ends.
pub fn part(pieces: &[Facing], lines: &[Vec<Point>], tolerance: f64) -> Vec<Facing> {
    let mut parts = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let ends = piece.ends;
        let length = (ends[1] - ends[0]).norm();
        let sides = lines.iter().flat_map(|line| line.windows(2));
        let crossings = sides.filter_map(|side| crossing(ends, [side[0], side[1]], tolerance));
        let mut shares: Vec<f64> = crossings.filter(|share| share.min(1.0 - share) * length > tolerance).collect();
        shares.sort_unstable_by(f64::total_cmp);
        shares.dedup_by(|b, a| (*b - *a) * length <= tolerance);
        let mut rest = *piece;
        for share in shares {
            let point = ends[0] + (ends[1] - ends[0]) * share;
            let spans = piece.spans.map(|[from, to]| from + (to - from) * share);
            let mut first = rest;
            first.ends[1] = point;
            rest.ends[0] = point;
            for (side, span) in spans.into_iter().enumerate() {
                first.spans[side][1] = span;
                rest.spans[side][0] = span;
            }
            parts.push(first);
        }
        parts.push(rest);
    }
    parts
}

/// Whether a point lies on a line, to a tolerance (m).
pub fn is_on(line: &[Point], point: Point, tolerance: f64) -> bool {
    line.windows(2).any(|side| segment::distance(point, side[0], side[1]) <= tolerance)
}

/// Share of the way along a segment at which another one, longer by a tolerance (m) at both ends, crosses it; none of
/// those that are parallel.
fn crossing([a, b]: [Point; 2], [c, d]: [Point; 2], tolerance: f64) -> Option<f64> {
    let (along, across) = (b - a, d - c);
    let area = along.perp(&across);
    // A millionth of a radian: a line beside the joint rather than one across it.
    if area.abs() <= 1e-6 * along.norm() * across.norm() {
        return None;
    }
    let [share, other] = [(c - a).perp(&across) / area, (c - a).perp(&along) / area];
    let beyond = tolerance / across.norm();
    ((0.0..=1.0).contains(&share) && (-beyond..=1.0 + beyond).contains(&other)).then_some(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_crosses_a_segment_once_or_not_at_all() {
        let p = Point::new;
        let segment = [p(0.0, 0.0), p(4.0, 0.0)];
        assert_eq!(crossing(segment, [p(1.0, -1.0), p(1.0, 2.0)], 0.1), Some(0.25));
        assert_eq!(crossing(segment, [p(1.0, 1.0), p(1.0, 2.0)], 0.1), None);
        assert_eq!(crossing(segment, [p(1.0, 0.05), p(1.0, 2.0)], 0.1), Some(0.25));
        assert_eq!(crossing(segment, [p(5.0, -1.0), p(5.0, 2.0)], 0.1), None);
        assert_eq!(crossing(segment, [p(1.0, 0.0), p(2.0, 0.0)], 0.1), None);
        assert!(is_on(&segment, p(2.0, 1e-9), 1e-6) && !is_on(&segment, p(2.0, 0.1), 1e-6));
    }
}
