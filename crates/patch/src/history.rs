//! Memory of rows from step to step, and which row of before a row goes on from.

use std::collections::BTreeMap;

use crate::{Body, Part, Row};

/// Name of a row from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key {
    /// The body that is viewed.
    pub viewed: usize,
    /// Its face.
    pub face: usize,
    /// The body that comes in.
    pub viewer: usize,
    /// The patch or the corner.
    pub part: Part,
}

/// Forces at the end of the last step. They are kept as forces, point by point: a mean over a patch would let a block
/// at rest creep, because the point beside the edge that opens slips and takes the shear of the other one with it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Kept {
    /// Normal forces of both rows (N/m).
    pub normal: [f64; 2],
    /// Their shear forces (N/m).
    pub shear: [f64; 2],
}

/// Memory of all rows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    kept: BTreeMap<Key, Kept>,
}

impl History {
    /// Takes over the rows of a step: what they keep is that of the same key, or of the row that they go on from.
    pub fn take_over(&mut self, rows: &[Row], bodies: &[Body]) {
        let mut next = BTreeMap::new();
        for row in rows {
            let known = self.kept.get(&row.key).or_else(|| self.inherited(&row.key, bodies));
            next.entry(row.key).or_insert_with(|| known.copied().unwrap_or_default());
        }
        self.kept = next;
    }

    /// Memory that the row of a new key goes on from: a patch from that on the face before or behind it on the
    /// same straight side, a corner from its row on another face or another body.
    fn inherited(&self, key: &Key, bodies: &[Body]) -> Option<&Kept> {
        if let Part::Corner(_) = key.part {
            let is_its = |(old, _): &(&Key, &Kept)| (old.viewer, old.part) == (key.viewer, key.part);
            return self.kept.iter().find(is_its).map(|(_, kept)| kept);
        }
        let body = &bodies[key.viewed];
        let (before, behind) = (body.outline.previous(key.face), body.outline.next(key.face));
        let is_straight = |point: usize| body.turn(point).abs() < STRAIGHT;
        let beside = [(behind, behind), (before, key.face)].into_iter().filter(|(_, point)| is_straight(*point));
        beside.map(|(face, _)| Key { face, ..*key }).find_map(|old| self.kept.get(&old))
    }

    /// Memory of a row.
    pub fn of(&self, key: &Key) -> Kept {
        self.kept.get(key).copied().unwrap_or_default()
    }

    /// Sets what a row keeps: normal and shear force (N/m) of one of its two points.
    pub fn set(&mut self, row: &Row, normal: f64, shear: f64) {
        let kept = self.kept.entry(row.key).or_default();
        kept.normal[row.point_of_two] = normal;
        kept.shear[row.point_of_two] = shear;
    }
}

/// Sine of the turn up to which two faces are one straight side.
const STRAIGHT: f64 = 1e-6;
