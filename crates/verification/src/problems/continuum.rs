//! Helpers for continuum problems: quarter models of holes and discs, tractions of a known field on their far
//! edges, and stresses at points.

use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;

/// Stress xx, yy, xy (Pa, tension positive) at a place.
pub type Field<'a> = &'a dyn Fn(Point) -> [f64; 3];

/// Pieces of a far edge that carry the mean traction of the known field each.
const PIECES: usize = 16;
/// Reach of the fit of stresses over the mesh size.
const REACH: f64 = 3.5;
/// Way of the load in the time in which a hole is opened, over the side of the model.
const TRANSITS: f64 = 6.0;

/// A list of points as a case writes it.
pub fn list(points: &[[f64; 2]]) -> String {
    let points: Vec<String> = points.iter().map(|[x, y]| format!("[{x:?}, {y:?}]")).collect();
    format!("[{}]", points.join(", "))
}

/// Points on a quarter circle about the origin, from the y axis to the x axis, at most half a mesh size apart.
pub fn quarter_circle(radius: f64, mesh: f64) -> Vec<[f64; 2]> {
    let count = (std::f64::consts::FRAC_PI_2 * radius / (0.5 * mesh)).ceil().max(8.0) as usize;
    let point = |k: usize| match k {
        0 => [0.0, radius],
        k if k == count => [radius, 0.0],
        k => {
            let (s, c) = (std::f64::consts::FRAC_PI_2 * (1.0 - k as f64 / count as f64)).sin_cos();
            [radius * c, radius * s]
        }
    };
    (0..=count).map(point).collect()
}

/// A quarter of a square plate with a round hole at the origin; both axes are planes of symmetry.
pub struct QuarterPlate {
    /// Radius of the hole (m).
    pub radius: f64,
    /// Half the side of the plate (m).
    pub half: f64,
    /// Mesh size (m).
    pub mesh: f64,
}

impl QuarterPlate {
    /// `[domain]`, `[mesh]` and the symmetry of the case; the lattice is turned so that no row lies on an axis.
    pub fn text(&self) -> String {
        let (r, b) = (self.radius, self.half);
        let part = |k: usize| b * k as f64 / PIECES as f64;
        let mut outline: Vec<[f64; 2]> = (0..=PIECES).map(|k| [b, part(k)]).collect();
        outline.extend((0..PIECES).rev().map(|k| [part(k), b]));
        outline.extend(quarter_circle(r, self.mesh));
        format!(
            "[domain]\noutline = {}\n[mesh]\nsize = {:e}\nangle_deg = 15.0\n[gravity]\ny = 0.0\n\
             [[fix]]\nedge = [[{r:?}, 0.0], [{b:?}, 0.0]]\naxes = \"y\"\n\
             [[fix]]\nedge = [[0.0, {r:?}], [0.0, {b:?}]]\naxes = \"x\"\n",
            list(&outline),
            self.mesh
        )
    }

    /// The stages of a hole that is opened: from the stress `before` to the one `after` in a slow dynamic stage, so
    /// that no shock runs out, then to rest; with the loads on far edges and wall that go with both fields.
    ///
    /// The plate deforms as if it went on for ever, since its far edges carry the tractions of the infinite one.
    pub fn opened(&self, before: Field, after: Field, speed: f64) -> String {
        let ramp = TRANSITS * self.half / speed;
        let table = smooth_rise(ramp);
        let far = |k: usize| self.half * k as f64 / PIECES as f64;
        let right: Vec<[f64; 2]> = (0..=PIECES).map(|k| [self.half, far(k)]).collect();
        let top: Vec<[f64; 2]> = (0..=PIECES).rev().map(|k| [far(k), self.half]).collect();
        let wall = quarter_circle(self.radius, self.mesh);
        let loads = [right, top, wall].map(|line| line_tractions(&line, before, after, &table)).concat();
        format!(
            "{loads}[[stage]]\nname = \"open\"\nkind = \"dynamic\"\ndamping = 1.0\nduration = {:e}\n\
             [[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = {:e}\n",
            1.2 * ramp,
            50.0 * ramp
        )
    }
}

/// 3x² − 2x³ as a table over `ramp` (s).
pub fn smooth_rise(ramp: f64) -> String {
    let row = |k: u32| {
        let x = f64::from(k) / 16.0;
        [x * ramp, x * x * (3.0 - 2.0 * x)]
    };
    list(&(0..=16).map(row).collect::<Vec<_>>())
}

/// Loads on the pieces of a line that has the rock on its left: the mean of a field's traction on each, by Simpson's
/// rule, and the change to another field with a table.
fn line_tractions(line: &[[f64; 2]], before: Field, after: Field, table: &str) -> String {
    let piece = |ends: &[[f64; 2]]| {
        let [p, q] = [0, 1].map(|k| Point::from(ends[k]));
        let along = (q - p).normalize();
        let traction = |field: Field, p: Point| {
            let [xx, yy, xy] = field(p);
            Vector::new(xx * along.y - xy * along.x, xy * along.y - yy * along.x)
        };
        let mean =
            |field: Field| (traction(field, p) + traction(field, (p + q) * 0.5) * 4.0 + traction(field, q)) / 6.0;
        let (first, change) = (mean(before), mean(after) - mean(before));
        let load = |t: Vector| {
            format!("[[load]]\nkind = \"traction\"\nedge = {}\ntraction = [{:e}, {:e}]\n", list(ends), t.x, t.y)
        };
        format!("{}{}table = {table}\n", load(first), load(change))
    };
    line.windows(2).map(piece).collect()
}

/// Stress xx, yy, xy (Pa) at a point: a parabola in x and y through the stresses at the centroids of the elements
/// within
/// three and a half mesh sizes by least squares, weighted by area and nearness, and extrapolated where the point is
/// on a boundary.
pub fn stress_at(simulation: &Simulation, point: Point) -> [f64; 3] {
    let (slope, state) = (simulation.model(), simulation.state());
    let covers = &slope.covers;
    let reach = REACH * covers.mesh.size;
    let (mut matrix, mut right) = ([[0.0; 6]; 6], [[0.0; 6]; 3]);
    for e in covers.elements() {
        let d = (covers.element_centroid[e] - point) / reach;
        let nearness = 1.0 - d.norm_squared();
        if nearness <= 0.0 || state.removed[covers.element_block[e]] {
            continue;
        }
        let weight = covers.element_area[e] * nearness * nearness;
        let terms = [1.0, d.x, d.y, d.x * d.x, d.x * d.y, d.y * d.y];
        let stress = slope.stress(state, e);
        for i in 0..6 {
            (0..6).for_each(|j| matrix[i][j] += weight * terms[i] * terms[j]);
            (0..3).for_each(|k| right[k][i] += weight * terms[i] * stress[k]);
        }
    }
    right.map(|b| first_unknown(matrix, b))
}

/// First unknown of a symmetric positive definite system, by elimination from the last on.
fn first_unknown(mut a: [[f64; 6]; 6], mut b: [f64; 6]) -> f64 {
    for k in (1..6).rev() {
        for i in 0..k {
            let share = a[i][k] / a[k][k];
            (0..k).for_each(|j| a[i][j] -= share * a[k][j]);
            b[i] -= share * b[k];
        }
    }
    b[0] / a[0][0]
}

/// Radial, hoop and shear stress at a place of a stress xx, yy, xy.
pub fn polar(p: Point, [xx, yy, xy]: [f64; 3]) -> [f64; 3] {
    let (c, s) = (p.x / p.norm(), p.y / p.norm());
    let cross = 2.0 * s * c * xy;
    [c * c * xx + s * s * yy + cross, s * s * xx + c * c * yy - cross, s * c * (yy - xx) + (c * c - s * s) * xy]
}

/// Stress xx, yy, xy at a place of radial, hoop and shear stress.
pub fn cartesian(p: Point, [rr, tt, rt]: [f64; 3]) -> [f64; 3] {
    let (c, s) = (p.x / p.norm(), p.y / p.norm());
    let cross = 2.0 * s * c * rt;
    [c * c * rr + s * s * tt - cross, s * s * rr + c * c * tt + cross, s * c * (rr - tt) + (c * c - s * s) * rt]
}

/// Root mean square over the rock nearer than `reach` (m) to the origin of the difference between the stresses of the
/// elements and a known field, by area.
pub fn stress_error(simulation: &Simulation, reach: f64, field: Field) -> f64 {
    let (slope, state) = (simulation.model(), simulation.state());
    let covers = &slope.covers;
    let (mut sum, mut area) = (0.0, 0.0);
    for e in covers.elements().filter(|&e| covers.element_centroid[e].norm() < reach) {
        let (found, exact) = (slope.stress(state, e), field(covers.element_centroid[e]));
        let square: f64 = (0..3).map(|k| (found[k] - exact[k]).powi(2)).sum();
        sum += covers.element_area[e] * square;
        area += covers.element_area[e];
    }
    (sum / area).sqrt()
}

/// Order at which an error falls when the mesh size falls by `ratio` > 1.
pub fn order(coarse: f64, fine: f64, ratio: f64) -> f64 {
    (coarse / fine).ln() / ratio.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polar_and_cartesian_are_inverse() {
        let p = Point::new(0.3, 1.1);
        let back = cartesian(p, polar(p, [1.0, 2.0, 3.0]));
        assert!(back.iter().zip([1.0, 2.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-14), "{back:?}");
    }

    #[test]
    fn elimination_finds_the_first_unknown() {
        let x = [3.0, -1.0, 2.0, 0.5, 4.0, 1.0];
        let a: [[f64; 6]; 6] =
            std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 9.0 } else { 1.0 / (i + j) as f64 }));
        let b = a.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum());
        assert!((first_unknown(a, b) - 3.0).abs() < 1e-12);
    }
}
