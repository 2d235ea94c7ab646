//! Maps of the plane: from a drawing to the section, and from blocks of a drawing to the places where they stand.

use enmm::model::case::{Flip, Transform};

/// A linear map and a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Affine {
    rows: [[f64; 2]; 2],
    shift: [f64; 2],
}

impl Affine {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self { rows: [[1.0, 0.0], [0.0, 1.0]], shift: [0.0; 2] };

    /// The map of a case, with the metres in a unit of the drawing where it gives no `scale`.
    pub fn of_case(transform: Option<&Transform>, unit: f64) -> Self {
        let Some(transform) = transform else { return Self::scaling([unit, unit]) };
        let scale = transform.scale.unwrap_or(unit);
        let [x, y] = match transform.flip {
            None => [1.0, 1.0],
            Some(Flip::X) => [-1.0, 1.0],
            Some(Flip::Y) => [1.0, -1.0],
            Some(Flip::Xy) => [-1.0, -1.0],
        };
        Self { shift: transform.shift, ..Self::scaling([x * scale, y * scale]) }
    }

    /// Multiplies x and y.
    pub fn scaling([x, y]: [f64; 2]) -> Self {
        Self { rows: [[x, 0.0], [0.0, y]], ..Self::IDENTITY }
    }

    /// Adds to x and y.
    pub fn shift(shift: [f64; 2]) -> Self {
        Self { shift, ..Self::IDENTITY }
    }

    /// Turns counter-clockwise; whole right angles are exact.
    pub fn rotation(degrees: f64) -> Self {
        let (sin, cos) = sin_cos_deg(degrees);
        Self { rows: [[cos, -sin], [sin, cos]], ..Self::IDENTITY }
    }

    /// This map after another.
    pub fn after(&self, first: &Self) -> Self {
        let column = |k: usize| self.vector([first.rows[0][k], first.rows[1][k]]);
        let (a, b) = (column(0), column(1));
        Self { rows: [[a[0], b[0]], [a[1], b[1]]], shift: self.point(first.shift) }
    }

    /// Maps a point; the identity keeps its bits.
    pub fn point(&self, point: [f64; 2]) -> [f64; 2] {
        if *self == Self::IDENTITY {
            return point;
        }
        let [x, y] = self.vector(point);
        [x + self.shift[0], y + self.shift[1]]
    }

    /// Maps a difference of points.
    pub fn vector(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        // A coordinate that is no number stays in its own place.
        let product = |factor: f64, value: f64| if factor == 0.0 { 0.0 } else { factor * value };
        self.rows.map(|[a, b]| product(a, x) + product(b, y))
    }

    /// Whether two directions fall together, so that nothing keeps an area.
    pub fn is_flat(&self) -> bool {
        self.rows[0][0] * self.rows[1][1] == self.rows[0][1] * self.rows[1][0]
    }
}

/// Sine and cosine of an angle in degrees, exact at whole right angles.
pub fn sin_cos_deg(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => libm::sincos(other.to_radians()),
    }
}
