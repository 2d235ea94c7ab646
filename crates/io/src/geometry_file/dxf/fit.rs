//! Splines that a drawing gives by points on them alone: the cubic through these with continuous curvature. Its
//! parameter is the length of the chords, and where no direction is given at an end the curvature is 0 there, as CAD
//! programs draw such splines.

use super::curve::{CHORDS_MAX, HALVINGS_MAX, halve};
use crate::geometry_file::affine::Affine;

/// Points by which a closed spline goes on beyond both ends: what happens there fades by 2 − √3 with each point.
const ROUND: usize = 24;

/// A spline by points on it.
#[derive(Debug, Clone, Default)]
pub struct FitSpline {
    /// The points, no two of which follow each other at one place.
    pub points: Vec<[f64; 2]>,
    /// Directions at both ends.
    pub tangents: [Option<[f64; 2]>; 2],
    /// Whether it ends where it begins.
    pub closed: bool,
}

impl FitSpline {
    /// Corners of the polyline on the mapped spline, both ends among them; none if it needs more than [`CHORDS_MAX`].
    pub fn corners(&self, map: &Affine, tolerance: f64) -> Option<Vec<[f64; 2]>> {
        let mut points: Vec<[f64; 2]> = self.points.iter().map(|point| map.point(*point)).collect();
        let mut tangents = self.tangents.map(|tangent| tangent.map(|direction| map.vector(direction)));
        let mut shown = 0..points.len().checked_sub(1)?;
        if self.closed {
            if points.first() == points.last() {
                points.pop();
            }
            let count = points.len();
            let around = |k: usize| points[(k + count * ROUND - ROUND) % count];
            shown = ROUND..ROUND + count;
            points = (0..=count + 2 * ROUND).map(around).collect();
            tangents = [None; 2];
        }
        let slopes = slopes(&points, tangents);
        let mut corners = vec![points[shown.start]];
        for k in shown {
            let third = length(points[k], points[k + 1]) / 3.0;
            let [a, b, c, d] = [points[k], moved(points[k], slopes[k], third), points[k + 1], slopes[k + 1]];
            let piece = [a, b, moved(c, d, -third), c].map(|[x, y]| [x, y, 1.0]);
            halve(&piece, tolerance, HALVINGS_MAX, &mut corners)?;
        }
        (corners.len() <= CHORDS_MAX).then_some(corners)
    }
}

fn length(a: [f64; 2], b: [f64; 2]) -> f64 {
    libm::hypot(b[0] - a[0], b[1] - a[1])
}

fn moved(point: [f64; 2], direction: [f64; 2], by: f64) -> [f64; 2] {
    [0, 1].map(|axis| point[axis] + by * direction[axis])
}

/// Derivatives by the length of the chords at all points: those for which curvature is continuous (a tridiagonal
/// system).
fn slopes(points: &[[f64; 2]], tangents: [Option<[f64; 2]>; 2]) -> Vec<[f64; 2]> {
    let last = points.len() - 1;
    let chord: Vec<f64> = points.windows(2).map(|pair| length(pair[0], pair[1])).collect();
    let rise = |k: usize, axis: usize| (points[k + 1][axis] - points[k][axis]) / chord[k];
    let unit = |[x, y]: [f64; 2]| Some([x, y].map(|value| value / libm::hypot(x, y))).filter(|[x, _]| x.is_finite());
    // Each row: share of the slope before, of its own, of the one after, and the right side.
    let row = |k: usize| -> ([f64; 3], [f64; 2]) {
        let (end, at) = (if k == 0 { 0 } else { 1 }, k.min(last - 1));
        if k == 0 || k == last {
            return match tangents[end].and_then(unit) {
                Some(direction) => ([0.0, 1.0, 0.0], direction),
                None if k == 0 => ([0.0, 2.0, 1.0], [0, 1].map(|axis| 3.0 * rise(at, axis))),
                None => ([1.0, 2.0, 0.0], [0, 1].map(|axis| 3.0 * rise(at, axis))),
            };
        }
        let (before, after) = (chord[k - 1], chord[k]);
        let right = [0, 1].map(|axis| 3.0 * (after * rise(k - 1, axis) + before * rise(k, axis)));
        ([after, 2.0 * (before + after), before], right)
    };
    let mut swept: Vec<(f64, [f64; 2])> = Vec::with_capacity(points.len());
    for k in 0..=last {
        let ([low, own, high], right) = row(k);
        let (share, before) = swept.last().copied().unwrap_or_default();
        let pivot = own - low * share;
        swept.push((high / pivot, [0, 1].map(|axis| (right[axis] - low * before[axis]) / pivot)));
    }
    let mut next = [0.0; 2];
    let mut slopes: Vec<[f64; 2]> = swept
        .into_iter()
        .rev()
        .map(|(share, value)| {
            next = [0, 1].map(|axis| value[axis] - share * next[axis]);
            next
        })
        .collect();
    slopes.reverse();
    slopes
}
