//! Edges at their current places, once a step for all nodes that judge them.

use rayon::prelude::*;

use crate::contact::Boundary;
use crate::geometry::{Point, Vector};

use super::right_of;

/// Edges that a thread takes at least.
const GRAIN: usize = 2048;

/// An edge at its current place.
#[derive(Debug, Clone, Copy)]
pub struct EdgeFrame {
    start: Point,
    tangent: Vector,
    length: f64,
}

/// Where a point is over an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Over {
    /// Distance along the edge from its start (m).
    pub along: f64,
    /// Gap along the outward normal (m).
    pub gap: f64,
    /// Distance along the edge beyond its nearer end (m); 0 within.
    pub beyond: f64,
}

impl Over {
    /// Distance from the edge (m).
    pub fn distance(&self) -> f64 {
        if self.beyond > 0.0 { self.beyond.hypot(self.gap) } else { self.gap.abs() }
    }

    /// Whether the distance from the edge is less than `distance` (m).
    pub fn is_nearer_than(&self, distance: f64) -> bool {
        self.beyond.max(self.gap.abs()) < distance && self.distance() < distance
    }
}

impl EdgeFrame {
    fn new(a: Point, b: Point) -> Self {
        let length = (b - a).norm();
        Self { start: a, tangent: (b - a) / length, length }
    }

    /// Unit tangent.
    pub(super) fn tangent(&self) -> Vector {
        self.tangent
    }

    /// Length (m).
    pub(super) fn length(&self) -> f64 {
        self.length
    }

    pub(super) fn over(&self, p: Point) -> Over {
        let from = p - self.start;
        let along = from.dot(&self.tangent);
        let beyond = (-along).max(along - self.length).max(0.0);
        Over { along, gap: from.dot(&right_of(self.tangent)), beyond }
    }
}

/// Frames of all edges, where `place` are the current places of the boundary points.
pub fn edge_frames(boundary: &Boundary, place: &[Point], serial: bool, frames: &mut Vec<EdgeFrame>) {
    let frame = |(a, next): (&Point, &u32)| EdgeFrame::new(*a, place[*next as usize]);
    if serial {
        frames.clear();
        frames.extend(place.iter().zip(&boundary.next).map(frame));
    } else {
        let pairs = place.par_iter().zip(&boundary.next).with_min_len(GRAIN);
        pairs.map(frame).collect_into_vec(frames);
    }
}
