//! A body as contact sees it: its outline, the axes of its faces and their cells.

use crate::cell::{Cell, cells};
use crate::outline::{Face, Outline};
use crate::{Rule, Vector};

/// A body at its current place.
#[derive(Debug, Clone, Default)]
pub struct Body {
    /// Its outline.
    pub outline: Outline,
    /// Axes of its faces.
    pub faces: Vec<Face>,
    /// Their cells.
    pub cells: Vec<Cell>,
    /// Least and greatest coordinates (m).
    pub bounds: [Vector; 2],
    /// Whether nothing moves it.
    pub is_held: bool,
}

impl Body {
    /// A body with an outline.
    pub fn new(outline: Outline, is_held: bool, rule: &Rule) -> Self {
        let mut body = Self { cells: cells(&outline, rule.reach), outline, is_held, ..Self::default() };
        body.place();
        body
    }

    /// Takes over points that have moved as those of a rigid body: cells stay.
    pub fn move_rigidly(&mut self, points: impl Iterator<Item = Vector>) {
        self.outline.points.clear();
        self.outline.points.extend(points);
        self.place();
    }

    fn place(&mut self) {
        self.faces.clear();
        self.faces.extend((0..self.outline.len()).map(|k| self.outline.face(k)));
        self.bounds = self.outline.bounds();
    }

    /// Whether the boxes round two bodies are no farther apart than a distance (m).
    pub fn is_near(&self, other: &Self, distance: f64) -> bool {
        let reaches = |a: [Vector; 2], b: [Vector; 2]| a[0].x <= b[1].x + distance && a[0].y <= b[1].y + distance;
        reaches(self.bounds, other.bounds) && reaches(other.bounds, self.bounds)
    }

    /// Whether a point lies in the box round the body, widened by a distance (m).
    pub fn is_about(&self, point: Vector, distance: f64) -> bool {
        let [low, high] = self.bounds;
        (low.x - distance..=high.x + distance).contains(&point.x)
            && (low.y - distance..=high.y + distance).contains(&point.y)
    }

    /// Sine of the turn at a point of the outline: above zero at a convex corner.
    pub fn turn(&self, point: usize) -> f64 {
        let before = self.faces[self.outline.previous(point)].tangent;
        before.cross(self.faces[point].tangent)
    }

    /// Whether a point of the outline is a convex corner: of more than a right turn too, where the sine falls.
    pub fn is_corner(&self, point: usize, rule: &Rule) -> bool {
        let before = self.faces[self.outline.previous(point)].tangent;
        let turn = self.turn(point);
        turn > rule.corner_turn || turn > 0.0 && before.dot(self.faces[point].tangent) < 0.0
    }
}
