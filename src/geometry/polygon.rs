//! Measures of one polygon and the overlap of two.
//!
//! Knows closed loops of points without a repeated closing point, counter-clockwise positive; nothing of their origin.

use super::{Point, Vector, cross, orientation};

/// Returns the signed area of a polygon (m²), positive counter-clockwise.
pub fn area(polygon: &[Point]) -> f64 {
    let Some(&base) = polygon.first() else { return 0.0 };
    0.5 * polygon.windows(2).map(|side| cross(side[0] - base, side[1] - base)).sum::<f64>()
}

/// Integrals of 1, x and x⊗x over a region; regions add up.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Moments {
    /// Area (m²).
    pub area: f64,
    /// First moment (m³).
    pub first: Vector,
    /// Second moments xx, yy, xy (m⁴).
    pub second: [f64; 3],
}

impl Moments {
    /// Integrates over a polygon about a position (m) by Green's theorem: ½Σc, Σc(p+q)/6 and Σc(p⊗p+q⊗q+½(p⊗q+q⊗p))/12
    /// over the sides pq with c = p×q. The sums run about the first point: a far origin costs no digits.
    pub fn of(polygon: &[Point], about: Point) -> Self {
        let mut sum = Self { area: 0.0, first: Vector::zeros(), second: [0.0; 3] };
        let Some(&base) = polygon.first() else { return sum };
        for side in polygon.windows(2) {
            let (p, q) = (side[0] - base, side[1] - base);
            let c = cross(p, q);
            sum.area += c / 2.0;
            sum.first += (p + q) * (c / 6.0);
            let (xx, yy) = (p.x * p.x + q.x * q.x + p.x * q.x, p.y * p.y + q.y * q.y + p.y * q.y);
            let xy = p.x * p.y + q.x * q.y + 0.5 * (p.x * q.y + q.x * p.y);
            for (total, part) in sum.second.iter_mut().zip([xx, yy, xy]) {
                *total += part * (c / 12.0);
            }
        }
        sum.shifted(base - about)
    }

    /// Returns the moments when every point is moved by `by` (m).
    pub fn shifted(&self, by: Vector) -> Self {
        let (a, s) = (self.area, self.first);
        let second = [
            self.second[0] + 2.0 * s.x * by.x + a * by.x * by.x,
            self.second[1] + 2.0 * s.y * by.y + a * by.y * by.y,
            self.second[2] + s.x * by.y + s.y * by.x + a * by.x * by.y,
        ];
        Self { area: a, first: s + by * a, second }
    }
}

impl std::ops::Add for Moments {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let second = std::array::from_fn(|k| self.second[k] + other.second[k]);
        Self { area: self.area + other.area, first: self.first + other.first, second }
    }
}

/// Returns the centroid of a polygon (m), the mean of its points when it has no area.
pub fn centroid(polygon: &[Point]) -> Point {
    let Some(&base) = polygon.first() else { return Point::zeros() };
    let moments = Moments::of(polygon, base);
    if moments.area == 0.0 {
        return base + polygon.iter().map(|p| p - base).sum::<Vector>() / polygon.len() as f64;
    }
    base + moments.first / moments.area
}

/// Whether a point lies in a polygon by the even–odd rule with exact signs; the boundary is inside.
pub fn contains(polygon: &[Point], p: Point) -> bool {
    enclose(sides(polygon), p)
}

/// Whether the sides of a polygon and of its holes, in any order, enclose a point by the same rule.
pub fn enclose(sides: impl IntoIterator<Item = (Point, Point)>, p: Point) -> bool {
    let mut inside = false;
    for (a, b) in sides {
        let (low, high) = (a.inf(&b), a.sup(&b));
        if p.y < low.y || p.y > high.y || p.x > high.x {
            continue;
        }
        let side = orientation(a, b, p);
        if side == 0.0 && p.x >= low.x {
            return true;
        }
        let spans = (a.y <= p.y) != (b.y <= p.y);
        if spans && (side > 0.0) == (b.y > a.y) {
            inside = !inside;
        }
    }
    inside
}

/// Returns the sides of a polygon, the closing one last.
pub fn sides(polygon: &[Point]) -> impl Iterator<Item = (Point, Point)> + Clone + '_ {
    (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()]))
}

/// Returns the area common to two simple polygons (m²) of either sense, convex or not.
pub fn overlap_area(p: &[Point], q: &[Point]) -> f64 {
    overlap_pieces(p, q).iter().map(|piece| area(piece)).sum()
}

/// Returns how deep two simple polygons (either sense) overlap (m), 0 when they do not.
///
/// It is the larger of two lengths: the distance from the deepest corner of one inside the other to the boundary of the
/// other, and the minimal width of the widest convex piece of the overlap. Neither exceeds the least translation that
/// parts the polygons; for a corner or a face pushed into a face, and for bars across each other that are convex, the
/// depth is equal to it. Polygons that are not convex are cut into triangles, which narrows the pieces.
pub fn overlap_depth(p: &[Point], q: &[Point]) -> f64 {
    let widths = overlap_pieces(p, q).iter().map(|piece| width(piece)).fold(0.0, f64::max);
    if widths == 0.0 {
        return 0.0;
    }
    widths.max(deepest_corner(p, q)).max(deepest_corner(q, p))
}

/// Returns the distance to the boundary of the point of `p` deepest inside `q` (m), 0 when none is inside.
pub fn deepest_corner(p: &[Point], q: &[Point]) -> f64 {
    let boundary = |corner: Point| sides(q).map(|side| distance(corner, side)).fold(f64::INFINITY, f64::min);
    p.iter().filter(|&&corner| contains(q, corner)).map(|&corner| boundary(corner)).fold(0.0, f64::max)
}

/// Distance of a point from a side (m).
fn distance(p: Point, (a, b): (Point, Point)) -> f64 {
    let (along, to) = (b - a, p - a);
    let at = (along.dot(&to) / along.norm_squared()).clamp(0.0, 1.0);
    let foot = if at.is_nan() { a } else { a + along * at };
    (p - foot).norm()
}

/// Returns the smallest distance between two parallel lines that hold a convex polygon between them (m).
pub fn width(convex: &[Point]) -> f64 {
    let across = |(a, b): (Point, Point)| {
        let length = (b - a).norm();
        let reach = convex.iter().map(|&p| cross(b - a, p - a)).fold(0.0, f64::max);
        if length > 0.0 { reach / length } else { f64::INFINITY }
    };
    let least = sides(convex).map(across).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// Convex pieces of the overlap of two simple polygons: every convex part of one clipped by every one of the other.
fn overlap_pieces(p: &[Point], q: &[Point]) -> Vec<Vec<Point>> {
    let boxes_apart = |a: &[Point], b: &[Point]| {
        let ((low_a, high_a), (low_b, high_b)) = (bounds(a), bounds(b));
        low_a.x >= high_b.x || low_b.x >= high_a.x || low_a.y >= high_b.y || low_b.y >= high_a.y
    };
    if boxes_apart(p, q) {
        return Vec::new();
    }
    let parts_q = convex_parts(q);
    let mut pieces = Vec::new();
    for t in convex_parts(p).iter().filter(|t| !boxes_apart(t, q)) {
        for u in parts_q.iter().filter(|u| !boxes_apart(t, u)) {
            let piece = clip_convex(t, u);
            if piece.len() > 2 {
                pieces.push(piece);
            }
        }
    }
    pieces
}

/// The polygon itself, counter-clockwise, when it is convex, else its triangles.
fn convex_parts(polygon: &[Point]) -> Vec<Vec<Point>> {
    let mut corners = polygon.to_vec();
    if area(polygon) < 0.0 {
        corners.reverse();
    }
    let n = corners.len();
    // A simple polygon whose corners all turn left is convex.
    if (0..n).all(|k| orientation(corners[k], corners[(k + 1) % n], corners[(k + 2) % n]) >= 0.0) {
        return vec![corners];
    }
    triangles(&corners).iter().map(|t| t.to_vec()).collect()
}

/// Returns the lower left and upper right corners of the box round points (m).
pub fn bounds(points: &[Point]) -> (Point, Point) {
    let start = (Point::repeat(f64::INFINITY), Point::repeat(f64::NEG_INFINITY));
    points.iter().fold(start, |(low, high), p| (low.inf(p), high.sup(p)))
}

/// Returns the part of a convex polygon inside another, both counter-clockwise; empty when they are apart.
pub fn clip_convex(subject: &[Point], window: &[Point]) -> Vec<Point> {
    let mut rest = subject.to_vec();
    for (a, b) in sides(window) {
        let before = std::mem::take(&mut rest);
        for (p, q) in sides(&before) {
            let (side_p, side_q) = (cross(b - a, p - a), cross(b - a, q - a));
            if side_p >= 0.0 {
                rest.push(p);
            }
            if (side_p > 0.0 && side_q < 0.0) || (side_p < 0.0 && side_q > 0.0) {
                rest.push(p + (q - p) * (side_p / (side_p - side_q)));
            }
        }
    }
    rest
}

/// Cuts a simple polygon of either sense into counter-clockwise triangles by clipping ears with exact signs.
///
/// The polygon may touch itself in corners. Where it crosses itself the result covers it only roughly.
pub fn triangles(polygon: &[Point]) -> Vec<[Point; 3]> {
    let mut rest = polygon.to_vec();
    if area(polygon) < 0.0 {
        rest.reverse();
    }
    let mut cut = Vec::with_capacity(rest.len());
    let mut at = 0;
    let mut looked = 0;
    while rest.len() >= 3 {
        let n = rest.len();
        let [a, b, c] = [(at + n - 1) % n, at % n, (at + 1) % n].map(|k| rest[k]);
        let turn = orientation(a, b, c);
        // A round without an ear means a polygon that crosses itself: any corner goes, so that the loop ends.
        if turn == 0.0 || looked >= n || (turn > 0.0 && is_ear(&rest, a, b, c)) {
            if turn > 0.0 {
                cut.push([a, b, c]);
            }
            rest.remove(at % n);
            at = (at + n - 1) % n;
            looked = 0;
        } else {
            at = (at + 1) % n;
            looked += 1;
        }
    }
    cut
}

/// Whether no other corner lies in the triangle, nor a side starts into it from a copy of one of its corners.
fn is_ear(polygon: &[Point], a: Point, b: Point, c: Point) -> bool {
    let left = |from: Point, to: Point, p: Point| orientation(from, to, p);
    let n = polygon.len();
    (0..n).all(|k| {
        let p = polygon[k];
        let neighbours = [polygon[(k + n - 1) % n], polygon[(k + 1) % n]];
        let clear =
            |to: Point, from: Point| !neighbours.iter().any(|&q| left(p, to, q) > 0.0 && left(from, p, q) > 0.0);
        if p == a {
            clear(b, c)
        } else if p == b {
            clear(c, a)
        } else if p == c {
            clear(a, b)
        } else {
            left(a, b, p) < 0.0 || left(b, c, p) < 0.0 || left(c, a, p) < 0.0
        }
    })
}
