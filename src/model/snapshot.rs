//! One instant of a slope as outputs see it: polygons with fields, without covers, weights or time stepping.

use crate::geometry::{Point, Vector};

/// Polygons stored end to end: polygon `k` has the points `start[k]..start[k + 1]`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Polygons {
    /// First point of each polygon, and the number of points at the end.
    pub start: Vec<u32>,
    /// Corner points (m), counter-clockwise; a hole is joined to its outer loop by a bridge.
    pub points: Vec<Point>,
}

impl Polygons {
    /// Number of polygons.
    pub fn len(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Whether there is no polygon.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Range of the points of polygon `k`.
    pub fn range(&self, k: usize) -> std::ops::Range<usize> {
        self.start[k] as usize..self.start[k + 1] as usize
    }

    /// Points of polygon `k`.
    pub fn get(&self, k: usize) -> &[Point] {
        &self.points[self.range(k)]
    }
}

/// One instant, current positions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Snapshot {
    /// Simulated time (s).
    pub time: f64,
    /// Manifold elements at their current position.
    pub elements: Polygons,
    /// Displacement (m) of each point of `elements`.
    pub displacement: Vec<Vector>,
    /// Velocity (m/s) of each point of `elements`.
    pub velocity: Vec<Vector>,
    /// Cauchy stress xx, yy, xy (Pa, tension positive) of each element.
    pub stress: Vec<[f64; 3]>,
    /// Stress out of the plane (Pa, tension positive) of each element: 0 in plane stress.
    pub stress_zz: Vec<f64>,
    /// Plastic strain √(⅔ εp:εp) of each element; empty when no rock yields.
    pub plastic_strain: Vec<f64>,
    /// Block of each element.
    pub block: Vec<u32>,
    /// Rock of each element.
    pub rock: Vec<u32>,
    /// Outline of each block at its current position: all its boundary loops, outer first.
    pub boundaries: Vec<Boundary>,
    /// Names of the joint laws.
    pub joint_laws: Vec<String>,
    /// Names of the rocks.
    pub rocks: Vec<String>,
}

/// Boundary loops of one block.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Boundary {
    /// Block id.
    pub block: u32,
    /// Whether the block is held.
    pub fixed: bool,
    /// Centroid displacement (m).
    pub displacement: Vector,
    /// Loops (outer counter-clockwise, holes clockwise).
    pub loops: Polygons,
    /// Where each point of `loops` was before the block moved (m).
    pub reference: Vec<Point>,
}
