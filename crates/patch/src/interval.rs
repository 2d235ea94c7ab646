//! The part of one body in the cell of a face of another one: force, place, energy, and the closed part of the face
//! with the two rows that carry it.
//!
//! The energy of the overlap is the stiffness times the depth, summed over its area. Its gradient is a force along
//! the normal of the face through the centroid of the area: stiffness times area. All sums over a part of the cell are
//! integrals along its sides, exact by three points on each.

use crate::clip::Polygon;
use crate::{Band, Hardening, Vector};

/// Places and weights of the rule of Gauss with three points on (0, 1).
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 0.277_777_777_777_777_8),
    (0.5, 0.444_444_444_444_444_4),
    (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
];
/// Distance of both points of Gauss from the middle of a length, over that length: 1/√12.
const APART: f64 = 0.288_675_134_594_812_87;
/// Closed length (m) below which a row keeps its force through a step: nothing of a face lies on the other one.
const LENGTH_LEAST: f64 = 1e-14;

/// The part of a body that lies in a cell, over the stiffness of the faces and in the axes of the face.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Patch {
    /// Force (m²) along the normal: the area, where faces do not harden.
    pub force: f64,
    /// Moment of the force about the start of the face (m³).
    pub moment: f64,
    /// Force times depth, summed (m³).
    pub lever: f64,
    /// Energy (m³).
    pub energy: f64,
    /// Length of the face on which the other body lies (m).
    pub closed: f64,
    /// Moment of that length about the start of the face (m²).
    pub closed_moment: f64,
    /// Greatest depth of it (m).
    pub deepest: f64,
}

/// A point of the face that carries a part of the patch: a spring with the stiffness times `weight`, closed by
/// `closure`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Bearing {
    /// Way along the face and depth (m).
    pub at: Vector,
    /// Length (m).
    pub weight: f64,
    /// Closure (m), hardened: the force over stiffness and weight.
    pub closure: f64,
    /// Whether the force changes with the closure in a step.
    pub is_live: bool,
}

/// A part of a face of the body that lies in a cell: both ends in the axes of the face that owns the cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// The face of the body.
    pub face: usize,
    /// Its ends (m).
    pub ends: [Vector; 2],
}

impl Patch {
    /// Place of the force (m): way along the face, depth.
    pub fn centre(&self) -> Vector {
        Vector::new(self.moment / self.force, self.lever / self.force)
    }

    /// Adds what a polygon encloses, given by its sides counterclockwise.
    pub(crate) fn add(&mut self, polygon: &Polygon, hardening: Hardening) {
        for ([from, to], face) in polygon.sides() {
            let back = from.x - to.x;
            for (place, weight) in GAUSS {
                let at = from + (to - from) * place;
                let pressure = hardening.pressure(at.y) * back * weight;
                self.force += pressure;
                self.moment += pressure * at.x;
                self.lever += hardening.lever(at.y) * back * weight;
                self.energy += hardening.energy(at.y) * back * weight;
            }
            if face.is_some() {
                self.closed += back;
                self.closed_moment += 0.5 * back * (from.x + to.x);
            }
            self.deepest = self.deepest.max(from.y);
        }
    }

    /// The two rows that carry the patch, with a share of it: at the points of Gauss of the closed length, which have
    /// its force and its moment. Where those would pull, both at its centre.
    pub fn bearings(&self, share: f64) -> [Bearing; 2] {
        let centre = self.centre();
        let length = self.closed.max(0.0);
        let middle = if length > 0.0 { self.closed_moment / self.closed } else { centre.x };
        let mut places = [middle - APART * length, middle + APART * length];
        let mut first = if places[1] > places[0] { (places[1] - centre.x) / (places[1] - places[0]) } else { 0.5 };
        if !(0.0..=1.0).contains(&first) {
            (places, first) = ([centre.x; 2], 0.5);
        }
        let weight = (share * 0.5 * length).max(LENGTH_LEAST);
        let bearing = |place: f64, part: f64| Bearing {
            at: Vector::new(place, centre.y),
            weight,
            closure: share * self.force * part / weight,
            is_live: length > LENGTH_LEAST,
        };
        [bearing(places[0], first), bearing(places[1], 1.0 - first)]
    }
}

/// Leaves of a polygon in the axes of a face what lies in a band of its cell.
pub(crate) fn keep_in_band(polygon: &mut Polygon, band: &Band) {
    let [top, bottom] = band.depths;
    let [start, end] = band.bounds;
    polygon.keep(Vector::new(0.0, -1.0), -top);
    if bottom.is_finite() {
        polygon.keep(Vector::new(0.0, 1.0), bottom);
    }
    polygon.keep(Vector::new(-1.0, start.slope), -start.at);
    polygon.keep(Vector::new(1.0, -end.slope), end.at);
}

/// The faces of a polygon's outline that are among its sides.
pub(crate) fn pieces(polygon: &Polygon) -> impl Iterator<Item = Piece> + '_ {
    let piece = |(ends, face): ([Vector; 2], Option<u32>)| Some(Piece { face: face? as usize, ends });
    polygon.sides().filter_map(piece).filter(|piece| piece.ends[0] != piece.ends[1])
}
