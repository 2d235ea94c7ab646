//! The points of a body that a face owns: those that lie less deep under it than under the other faces.
//!
//! Every face moves into the body at the same speed. The ends that it shares with its neighbours run along bisectors,
//! so that it grows shorter at a convex corner and longer at a reflex kink. A face that has shrunk to a point is passed
//! over: from that depth on the two beside it are neighbours, and run along their own bisector. So cells fill a body
//! down to the depth up to which they are wanted, they touch without a gap, and on the line between two of them both
//! depths are equal: **the depth under the owner is continuous**, which the force as a gradient rests on. What is not
//! looked for is a reflex kink that moves into a face on the far side of the body: cells end before that, at `reach`.

use crate::outline::Face;
use crate::{Outline, Vector};

/// Least 1 + cos of the turn between two faces that have a bisector: nearly opposite ones meet at once.
const OPPOSED: f64 = 1e-9;

/// An end of a face that moves inwards: at depth y it is at `at + slope·y` along the face.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Bound {
    /// Position at depth zero (m).
    pub at: f64,
    /// Its change per depth.
    pub slope: f64,
}

impl Bound {
    /// Position (m) at a depth (m).
    #[inline]
    pub fn position(&self, depth: f64) -> f64 {
        self.at + self.slope * depth
    }

    /// The bound with a slope that passes through a position at a depth (m).
    fn through(position: f64, depth: f64, slope: f64) -> Self {
        Self { at: position - slope * depth, slope }
    }
}

/// A part of a cell between two depths, in which the same two bounds limit it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Depths (m) between which it lies.
    pub depths: [f64; 2],
    /// Bounds at the start and at the end of the face.
    pub bounds: [Bound; 2],
}

/// The points that a face owns, by growing depth.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cell {
    /// Bands without a gap between them.
    pub bands: Vec<Band>,
}

impl Cell {
    /// Whether it owns a point at a way along the face and a depth (m).
    pub fn owns(&self, local: Vector) -> bool {
        let within = |band: &Band| {
            let [start, end] = band.bounds.map(|bound| bound.position(local.y));
            (band.depths[0]..=band.depths[1]).contains(&local.y) && start <= local.x && local.x <= end
        };
        self.bands.iter().any(within)
    }
}

/// A face on its way inwards.
struct Front {
    previous: usize,
    next: usize,
    bounds: [Bound; 2],
    since: f64,
    is_active: bool,
}

/// Cells of all faces of an outline, down to a depth (m) that may be infinite in a convex one.
pub fn cells(outline: &Outline, reach: f64) -> Vec<Cell> {
    let faces: Vec<Face> = (0..outline.len()).map(|k| outline.face(k)).collect();
    let mut cells = vec![Cell::default(); faces.len()];
    let mut fronts: Vec<Front> = (0..faces.len()).map(|k| front(outline, &faces, k)).collect();
    while let Some((gone, depth)) = next_gone(&fronts, reach) {
        let (p, n) = (fronts[gone].previous, fronts[gone].next);
        for k in [p, gone, n] {
            let Front { bounds, since, .. } = fronts[k];
            if depth > since {
                cells[k].bands.push(Band { depths: [since, depth], bounds });
            }
            fronts[k].since = depth;
        }
        fronts[gone].is_active = false;
        // A face vanishes only where the outline turns to the left on the whole. Beyond half a turn nothing is left.
        let slope = half_turn(&faces[p], &faces[n]).filter(|&slope| p != n && slope > 0.0);
        let Some(slope) = slope else {
            (fronts[p].is_active, fronts[n].is_active) = (false, false);
            (fronts[p].next, fronts[n].previous) = (n, p);
            continue;
        };
        let at = fronts[p].bounds[1].position(depth);
        fronts[p].bounds[1] = Bound::through(at, depth, -slope);
        let at = fronts[n].bounds[0].position(depth);
        fronts[n].bounds[0] = Bound::through(at, depth, slope);
        (fronts[p].next, fronts[n].previous) = (n, p);
    }
    for (cell, front) in cells.iter_mut().zip(&fronts) {
        if front.is_active && reach > front.since {
            cell.bands.push(Band { depths: [front.since, reach], bounds: front.bounds });
        }
    }
    cells
}

fn front(outline: &Outline, faces: &[Face], k: usize) -> Front {
    let (previous, next) = (outline.previous(k), outline.next(k));
    let slope = |a: usize, b: usize| half_turn(&faces[a], &faces[b]).unwrap_or(1.0 / OPPOSED);
    let start = Bound { at: 0.0, slope: slope(previous, k) };
    let end = Bound { at: faces[k].length, slope: -slope(k, next) };
    Front { previous, next, bounds: [start, end], since: 0.0, is_active: true }
}

/// Tangent of half the turn from one face to the next: positive at a convex corner. None where they are opposed.
fn half_turn(first: &Face, second: &Face) -> Option<f64> {
    let cosine = 1.0 + first.tangent.dot(second.tangent);
    (cosine > OPPOSED).then(|| first.tangent.cross(second.tangent) / cosine)
}

/// The active face that vanishes next, and at which depth (m).
fn next_gone(fronts: &[Front], reach: f64) -> Option<(usize, f64)> {
    let vanishing = |(k, front): (usize, &Front)| {
        let [start, end] = front.bounds;
        let rate = start.slope - end.slope;
        let depth = (end.at - start.at) / rate;
        (front.is_active && rate > 0.0 && depth < reach).then_some((k, depth.max(front.since)))
    };
    fronts.iter().enumerate().filter_map(vanishing).min_by(|a, b| a.1.total_cmp(&b.1))
}
