//! Arcs and splines as polylines that stay within a tolerance of them.

use crate::geometry_file::affine::Affine;

/// Most chords of one curve.
pub const CHORDS_MAX: usize = 100_000;
/// Least number of chords of a whole turn.
const CHORDS_PER_TURN: f64 = 8.0;
/// Most halvings of a piece of a spline.
pub const HALVINGS_MAX: u32 = 24;

/// The points centre + u·cos t + v·sin t between two angles (radians).
#[derive(Debug, Clone, Copy)]
pub struct Arc {
    /// Centre.
    pub centre: [f64; 2],
    /// Half axis at t = 0.
    pub u: [f64; 2],
    /// Half axis conjugate to it.
    pub v: [f64; 2],
    /// First angle and last.
    pub span: [f64; 2],
}

impl Arc {
    /// An arc of a circle, counter-clockwise from one angle to another (degrees).
    pub fn circular(centre: [f64; 2], radius: f64, [start, end]: [f64; 2]) -> Self {
        let turn = (end - start).rem_euclid(360.0);
        let turn = if turn == 0.0 { 360.0 } else { turn };
        let span = [start.to_radians(), (start + turn).to_radians()];
        Self { centre, u: [radius, 0.0], v: [0.0, radius], span }
    }

    /// The arc between two points whose included angle has a quarter with this tangent, positive to the left.
    pub fn bulging(a: [f64; 2], b: [f64; 2], bulge: f64) -> Self {
        let chord = [b[0] - a[0], b[1] - a[1]];
        let off = (1.0 - bulge * bulge) / (4.0 * bulge);
        let centre = [f64::midpoint(a[0], b[0]) - chord[1] * off, f64::midpoint(a[1], b[1]) + chord[0] * off];
        let u = [a[0] - centre[0], a[1] - centre[1]];
        Self { centre, u, v: [-u[1], u[0]], span: [0.0, 4.0 * libm::atan(bulge)] }
    }

    /// Whether it ends where it begins.
    pub fn is_whole(&self) -> bool {
        (self.span[1] - self.span[0]).abs() >= std::f64::consts::TAU * (1.0 - 1e-9)
    }

    /// Corners of the polyline on the mapped arc, both ends among them; none if it needs more than [`CHORDS_MAX`].
    pub fn points(&self, map: &Affine, tolerance: f64) -> Option<Vec<[f64; 2]>> {
        let (centre, u, v) = (map.point(self.centre), map.vector(self.u), map.vector(self.v));
        let half = longest_half_axis(u, v) / 2.0;
        // An arc of half angle h is r·(1 − cos h) from its chord; of an ellipse r is at most the longest half axis.
        let free = if tolerance < half { 4.0 * libm::asin((tolerance / (4.0 * half)).sqrt()) } else { f64::INFINITY };
        let turn = self.span[1] - self.span[0];
        let chords = (turn.abs() / free.min(std::f64::consts::TAU / CHORDS_PER_TURN)).ceil().max(1.0);
        if !half.is_finite() || chords.is_nan() || chords > CHORDS_MAX as f64 {
            return None;
        }
        let at = |k: usize| {
            let (sin, cos) = libm::sincos(self.span[0] + turn * (k as f64 / chords));
            [0, 1].map(|axis| centre[axis] + u[axis] * cos + v[axis] * sin)
        };
        Some((0..=chords as usize).map(at).collect())
    }
}

/// The longest half axis of an ellipse with these conjugate half axes: the greater singular value of both.
fn longest_half_axis(u: [f64; 2], v: [f64; 2]) -> f64 {
    let (uu, vv, uv) = (u[0] * u[0] + u[1] * u[1], v[0] * v[0] + v[1] * v[1], u[0] * v[0] + u[1] * v[1]);
    (f64::midpoint(uu, vv) + libm::hypot((uu - vv) / 2.0, uv)).sqrt()
}

/// A spline by control points, perhaps rational.
#[derive(Debug, Clone, Default)]
pub struct Spline {
    /// Degree of its pieces.
    pub degree: usize,
    /// Knots, ascending: as many as control points, and degree + 1 more.
    pub knots: Vec<f64>,
    /// Control points.
    pub points: Vec<[f64; 2]>,
    /// Weight of each control point.
    pub weights: Vec<f64>,
}

/// A point times its weight, and the weight.
pub type Weighted = [f64; 3];

impl Spline {
    /// Corners of the polyline on the mapped spline, both ends among them; none if it needs more than [`CHORDS_MAX`].
    pub fn corners(&self, map: &Affine, tolerance: f64) -> Option<Vec<[f64; 2]>> {
        let weighted = |(point, &weight): (&[f64; 2], &f64)| {
            let [x, y] = map.point(*point);
            [x * weight, y * weight, weight]
        };
        let control: Vec<Weighted> = self.points.iter().zip(&self.weights).map(weighted).collect();
        let mut corners = Vec::new();
        for span in self.degree..self.points.len() {
            if self.knots[span] < self.knots[span + 1] {
                let piece = self.piece(&control, span);
                if corners.is_empty() {
                    corners.push(flat(&piece[0]));
                }
                halve(&piece, tolerance, HALVINGS_MAX, &mut corners)?;
            }
        }
        Some(corners)
    }

    /// Bézier points of the piece between knot `span` and the next: the polar form of the spline at both knots.
    fn piece(&self, control: &[Weighted], span: usize) -> Vec<Weighted> {
        let (p, knots) = (self.degree, &self.knots);
        let polar = |late: usize| {
            let mut points = control[span - p..=span].to_vec();
            for round in 1..=p {
                let at = if round <= late { knots[span + 1] } else { knots[span] };
                for j in (round..=p).rev() {
                    let (low, high) = (knots[span - p + j], knots[span + 1 + j - round]);
                    let share = (at - low) / (high - low);
                    points[j] = between(&points[j - 1], &points[j], share);
                }
            }
            points[p]
        };
        (0..=p).map(polar).collect()
    }
}

fn between(a: &Weighted, b: &Weighted, share: f64) -> Weighted {
    [0, 1, 2].map(|k| a[k] * (1.0 - share) + b[k] * share)
}

fn flat([x, y, weight]: &Weighted) -> [f64; 2] {
    [x / weight, y / weight]
}

/// Adds the end of a piece, after those of its halves where it leaves its chord: it lies within the hull of its points.
pub fn halve(piece: &[Weighted], tolerance: f64, left: u32, corners: &mut Vec<[f64; 2]>) -> Option<()> {
    let (a, b) = (flat(&piece[0]), flat(piece.last()?));
    if piece.iter().all(|point| distance(flat(point), a, b) <= tolerance) {
        corners.push(b);
        return (corners.len() <= CHORDS_MAX).then_some(());
    }
    if left == 0 {
        return None;
    }
    let (mut first, mut second, mut points) = (vec![piece[0]], vec![*piece.last()?], piece.to_vec());
    while points.len() > 1 {
        points = points.windows(2).map(|pair| between(&pair[0], &pair[1], 0.5)).collect();
        first.push(points[0]);
        second.push(*points.last()?);
    }
    second.reverse();
    halve(&first, tolerance, left - 1, corners)?;
    halve(&second, tolerance, left - 1, corners)
}

/// Distance of a point from a segment.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (ab, ap) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = ab[0] * ab[0] + ab[1] * ab[1];
    let share = if square > 0.0 { ((ap[0] * ab[0] + ap[1] * ab[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    libm::hypot(ap[0] - share * ab[0], ap[1] - share * ab[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Greatest distance of a polyline from points of a curve.
    fn gap(corners: &[[f64; 2]], at: impl Fn(f64) -> [f64; 2]) -> f64 {
        let nearest = |p| corners.windows(2).map(|c| distance(p, c[0], c[1])).fold(f64::INFINITY, f64::min);
        (0..=2000).map(|k| nearest(at(f64::from(k) / 2000.0))).fold(0.0, f64::max)
    }

    #[test]
    fn arcs_and_squeezed_arcs_keep_the_tolerance() {
        let arc = Arc::circular([1.0, 2.0], 5.0, [300.0, 100.0]);
        let map = Affine::rotation(30.0).after(&Affine::scaling([2.0, -0.5]));
        for (map, tolerance) in [(Affine::IDENTITY, 0.1), (map, 0.01), (map, 1e-5)] {
            let corners = arc.points(&map, tolerance).unwrap();
            let found = gap(&corners, |s| {
                let (sin, cos) = libm::sincos(arc.span[0] + s * (arc.span[1] - arc.span[0]));
                map.point([1.0 + 5.0 * cos, 2.0 + 5.0 * sin])
            });
            assert!(found <= tolerance && found > tolerance / 20.0, "{found} of {tolerance}");
        }
        assert_eq!(arc.points(&Affine::IDENTITY, 1e-12), None);
        let bulge = Arc::bulging([0.0, 0.0], [2.0, 0.0], -1.0);
        assert!((bulge.centre, bulge.span[1]) == ([1.0, 0.0], -std::f64::consts::PI));
        let top = bulge.points(&Affine::IDENTITY, 1.0).unwrap();
        assert!(top.iter().all(|p| p[1] >= -1e-15) && top.len() == 5, "clockwise over the chord: {top:?}");
    }

    #[test]
    fn a_rational_spline_of_a_quarter_circle_is_one() {
        let weights = vec![1.0, 0.5f64.sqrt(), 1.0];
        let points = vec![[4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let spline = Spline { degree: 2, knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points, weights };
        let corners = spline.corners(&Affine::IDENTITY, 1e-3).unwrap();
        assert!(corners.iter().all(|p| (libm::hypot(p[0], p[1]) - 4.0).abs() < 1e-12), "{corners:?}");
        let quarter = std::f64::consts::FRAC_PI_2;
        let found = gap(&corners, |s| [4.0 * libm::cos(s * quarter), 4.0 * libm::sin(s * quarter)]);
        assert!(found <= 1e-3 && corners.len() > 8, "{found}, {} corners", corners.len());
    }

    /// A uniform cubic spline without repeated knots, against its basis functions.
    #[test]
    fn a_spline_with_inner_knots_goes_through_its_points() {
        let points = vec![[0.0, 0.0], [1.0, 2.0], [3.0, -1.0], [4.0, 3.0], [6.0, 0.0]];
        let knots = (0..9).map(f64::from).collect();
        let spline = Spline { degree: 3, knots, points: points.clone(), weights: vec![1.0; 5] };
        let corners = spline.corners(&Affine::IDENTITY, 1e-4).unwrap();
        let at = |s: f64| {
            let piece = ((2.0 * s).floor() as usize).min(1);
            let t = 2.0 * s - piece as f64;
            let basis = [
                (1.0 - t).powi(3),
                3.0 * t.powi(3) - 6.0 * t * t + 4.0,
                -3.0 * t.powi(3) + 3.0 * t * t + 3.0 * t + 1.0,
                t.powi(3),
            ];
            [0, 1].map(|axis| (0..4).map(|k| basis[k] / 6.0 * points[piece + k][axis]).sum())
        };
        assert!(gap(&corners, at) <= 1e-4);
        let ends = [corners[0], *corners.last().unwrap()];
        assert!(ends.iter().zip([at(0.0), at(1.0)]).all(|(a, b)| distance(*a, b, b) < 1e-12));
    }
}
