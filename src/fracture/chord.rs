//! A section through a block: a straight line from one point of its boundary to another, and the part on its left.

use crate::cover::ElementId;
use crate::geometry::{Point, Vector, cross, orientation, polygon, segment};
use crate::state::Model;

use super::masses::{CoverMass, Masses, of_part};
use super::outline::{End, Outline};

/// Distance over the mesh size within which an end is a node that is there already.
const SNAP: f64 = 1e-3;
/// Distance over the length of a section within which a point lies on it.
const ON: f64 = 1e-6;
/// Depth of rock on both sides of a section over its length from which on it is one, and no shallow slice.
const DEPTH: f64 = 1.0 / 3.0;

/// Cosine of the angle between a section and the normal of a face up to which it is square to that.
const SQUARE: f64 = 0.999_999;

/// A section through a block in the reference configuration.
#[derive(Debug, Clone)]
pub struct Chord {
    /// Its ends.
    pub ends: [End; 2],
    /// Where they are (m).
    pub places: [Point; 2],
    /// Whether it is square to the face at one of its ends, as a section of a beam is.
    pub is_square: bool,
    /// Covers of the block, by their places in it, whose mass lies to its left as a whole: from and to.
    whole: Vec<[u32; 2]>,
    /// Covers of which a part of the mass does.
    partial: Vec<(u32, CoverShare)>,
    /// Rock to its left and to its right (m), of a block that is not convex.
    sides: Option<Sides>,
}

/// The part of the mass of a cover on one side of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoverShare {
    /// Its share of the mass.
    pub share: f64,
    /// That share of the way (m) from the star to its centroid, in the reference configuration.
    pub arm: Vector,
}

/// The rock on both sides of a section.
#[derive(Debug, Clone)]
struct Sides {
    /// Rock to the left and to the right (m).
    rock: [Vec<Point>; 2],
    /// Which of both has the smaller box, and that box (m).
    smaller: usize,
    bounds: (Point, Point),
}

impl Chord {
    /// The section from a place of the outline along a direction, if it is one that can break.
    pub fn along(model: &Model, outline: &Outline, start: End, way: Vector) -> Option<Self> {
        let from = place(outline, start);
        let end = met(outline, Some(start), from, way)?;
        Self::between(model, outline, [start, end])
    }

    /// The section between two places of the outline, if it is one that can break: it parts the block into two that are
    /// large and deep enough, and meets no edge that a support holds.
    pub fn between(model: &Model, outline: &Outline, ends: [End; 2]) -> Option<Self> {
        let breaking = model.breaking.as_ref()?;
        let ends = ends.map(|end| snapped(outline, end, SNAP * model.covers.mesh.size));
        let places = ends.map(|end| place(outline, end));
        let length = (places[1] - places[0]).norm();
        let meets_support = ends.iter().any(|&end| is_held(outline, end));
        let is_too_short = ends[0].edge == ends[1].edge || length <= SNAP * model.covers.mesh.size;
        if is_too_short || length > breaking.longest || meets_support {
            return None;
        }
        if !outline.is_convex && !polygon::contains(&outline.points, (places[0] + places[1]) * 0.5) {
            return None;
        }
        let sides = [part(outline, ends, places), part(outline, [ends[1], ends[0]], [places[1], places[0]])];
        let across = left_of(places);
        let depth = |side: &[Point]| side.iter().map(|p| (p - places[0]).dot(&across).abs()).fold(0.0, f64::max);
        let is_part = |side: &Vec<Point>| polygon::area(side) >= breaking.least_part && depth(side) >= DEPTH * length;
        if !sides.iter().all(is_part) {
            return None;
        }
        let sides = (!outline.is_convex).then(|| Sides::new(sides));
        let is_square = is_square(outline, ends, places);
        let mut chord = Self { ends, places, is_square, whole: Vec::new(), partial: Vec::new(), sides };
        chord.weigh(model, outline);
        Some(chord)
    }

    /// Length (m).
    pub fn length(&self) -> f64 {
        (self.places[1] - self.places[0]).norm()
    }

    /// Places in a block of the covers that have mass to its left, with the part of it.
    pub fn covers(&self, masses: &Masses) -> impl Iterator<Item = (usize, CoverShare)> {
        let all = |k: u32| (k as usize, CoverShare { share: 1.0, arm: masses.arms[k as usize] });
        let whole = self.whole.iter().flat_map(move |&[from, to]| (from..to).map(all));
        whole.chain(self.partial.iter().map(|&(k, part)| (k as usize, part)))
    }

    /// Share of an even load on a piece of the boundary that acts on the rock to its left, and the middles (m) of the
    /// parts of the piece on its left and on its right. Of a force at one of its own ends the share is half.
    pub fn share_of(&self, piece: [Point; 2]) -> (f64, [Point; 2]) {
        let [a, b] = piece;
        let across = left_of(self.places);
        let middle = (a + b) * 0.5;
        let [from, to] = piece.map(|p| (p - self.places[0]).dot(&across));
        let on = ON * self.length();
        let crosses = from.min(to) < -on && from.max(to) > on;
        let at = if crosses { a + (b - a) * (from / (from - to)) } else { middle };
        let is_over = |p: Point| {
            let along = (p - self.places[0]).dot(&(self.places[1] - self.places[0])) / self.length();
            (-on..=self.length() + on).contains(&along)
        };
        if crosses && is_over(at) {
            let [left, right] = if from > 0.0 { [a, b] } else { [b, a] };
            return ((left - at).norm() / (b - a).norm(), [left, right].map(|end| (end + at) * 0.5));
        }
        let aside = 0.5 * (from + to);
        if aside.abs() <= on && is_over(middle) {
            return (0.5, [middle; 2]);
        }
        let is_left = match &self.sides {
            None => aside > 0.0,
            Some(sides) => sides.is_left(middle),
        };
        (if is_left { 1.0 } else { 0.0 }, [middle; 2])
    }

    /// Finds how much of the mass of each cover lies to its left, and where.
    fn weigh(&mut self, model: &Model, outline: &Outline) {
        let (covers, masses) = (&model.covers, outline.masses(model));
        let first = covers.covers_of(outline.block).start;
        let mut left = vec![CoverMass::default(); masses.amounts.len()];
        let mut is_cut = vec![false; left.len()];
        let mut part = Vec::new();
        for (e, whole) in ElementId::range(covers.elements_of(outline.block)).zip(&masses.elements) {
            let element = covers.polygon(e);
            let local = covers.element_covers[e].map(|cover| cover.index() - first);
            let mut add = |of_part: &[CoverMass; 3]| local.iter().zip(of_part).for_each(|(k, mass)| left[*k] += *mass);
            match self.side_of(element, covers.element_centroid[e]) {
                Some(false) => {}
                Some(true) => add(whole),
                None => {
                    local.iter().for_each(|&k| is_cut[k] = true);
                    self.each_left_part(element, &mut part, |part| {
                        add(&of_part(model, e, part, polygon::area(part), polygon::centroid(part)));
                    });
                }
            }
        }
        self.sum_up(&left, &masses.amounts, &is_cut);
    }

    /// Whether an element lies to its left; none where it cuts it.
    fn side_of(&self, element: &[Point], centroid: Point) -> Option<bool> {
        let across = left_of(self.places);
        let asides = || element.iter().map(|p| (p - self.places[0]).dot(&across));
        let least = ON * self.length();
        let (low, high) = asides().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), d| (a.min(d), b.max(d)));
        let Some(sides) = &self.sides else {
            return if low >= -least * ON {
                Some(true)
            } else if high <= least * ON {
                Some(false)
            } else {
                None
            };
        };
        if low < 0.0 && high > 0.0 && self.runs_through(element) {
            return None;
        }
        Some(sides.is_left(centroid))
    }

    /// Whether it, and not only its line, runs through a polygon that the line cuts.
    fn runs_through(&self, polygon: &[Point]) -> bool {
        let (across, [from, to]) = (left_of(self.places), self.places);
        let way = (to - from).normalize();
        let crossings = polygon::sides(polygon).filter_map(|(a, b)| {
            let [da, db] = [a, b].map(|p| (p - from).dot(&across));
            ((da < 0.0) != (db < 0.0)).then(|| (a + (b - a) * (da / (da - db)) - from).dot(&way))
        });
        let (start, end) = crossings.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
        end.min(self.length()) - start.max(0.0) > ON * self.length()
    }

    /// Each part to its left of an element that it runs through. The line of a section may cut the element a second
    /// time, beyond a notch, where the section does not run.
    fn each_left_part(&self, element: &[Point], part: &mut Vec<Point>, mut add: impl FnMut(&[Point])) {
        let mut add_part = |piece: &[Point]| {
            let aside = |p: &Point| (p - self.places[0]).dot(&left_of(self.places));
            let crosses = piece.iter().any(|p| aside(p) < 0.0) && piece.iter().any(|p| aside(p) > 0.0);
            match &self.sides {
                Some(sides) if !(crosses && self.runs_through(piece)) => {
                    if sides.is_left(polygon::centroid(piece)) {
                        add(piece);
                    }
                }
                _ => {
                    clip(piece, self.places, part);
                    if polygon::area(part) > 0.0 {
                        add(part);
                    }
                }
            }
        };
        if self.sides.is_none() || is_convex(element) {
            add_part(element);
        } else {
            polygon::triangles(element).iter().for_each(|triangle| add_part(triangle));
        }
    }

    /// Keeps the covers whose mass lies to the left, as a whole or in part, of all that each has (kg/m).
    fn sum_up(&mut self, left: &[CoverMass], all: &[f64], is_cut: &[bool]) {
        for (k, (left, &all)) in left.iter().zip(all).enumerate() {
            if left.amount == 0.0 {
                continue;
            }
            let k32 = k as u32;
            if is_cut[k] {
                self.partial.push((k32, CoverShare { share: left.amount / all, arm: left.moment / all }));
            } else if let Some([_, to]) = self.whole.last_mut().filter(|[_, to]| *to == k32) {
                *to += 1;
            } else {
                self.whole.push([k32, k32 + 1]);
            }
        }
    }
}

impl Sides {
    fn new(rock: [Vec<Point>; 2]) -> Self {
        let bounds = rock.each_ref().map(|side| polygon::bounds(side));
        let [left, right] = bounds.map(|(low, high)| (high - low).product());
        let smaller = usize::from(right < left);
        let (low, high) = bounds[smaller];
        let room = Vector::repeat(ON * (high - low).norm());
        Self { rock, smaller, bounds: (low - room, high + room) }
    }

    /// Whether a point of the block lies in the rock on the left rather than in that on the right.
    fn is_left(&self, p: Point) -> bool {
        let (low, high) = self.bounds;
        if p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y {
            return self.smaller == 1;
        }
        let [left, right] = self.rock.each_ref().map(|side| distance(side, p));
        left <= right
    }
}

/// Where an end is (m).
pub fn place(outline: &Outline, End { edge, along }: End) -> Point {
    let [a, b] = outline.edge(edge);
    if along == 0.0 { a } else { a + (b - a) * along }
}

/// The end at a place (m) of the outline.
pub fn end_at(outline: &Outline, p: Point) -> End {
    let distance = |k: &usize| {
        let [a, b] = outline.edge(*k);
        segment::distance(p, a, b)
    };
    let edge = (0..outline.points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
    let [a, b] = outline.edge(edge);
    End { edge, along: ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0) }
}

/// An end, moved to a point of the outline that is near.
fn snapped(outline: &Outline, end: End, near: f64) -> End {
    let [a, b] = outline.edge(end.edge);
    let length = (b - a).norm();
    if end.along * length <= near {
        End { along: 0.0, ..end }
    } else if (1.0 - end.along) * length <= near {
        End { edge: (end.edge + 1) % outline.points.len(), along: 0.0 }
    } else {
        end
    }
}

/// Whether the line between two ends is square to the face at one of them.
fn is_square(outline: &Outline, ends: [End; 2], [from, to]: [Point; 2]) -> bool {
    let way = (to - from).normalize();
    ends.into_iter().any(|end| outline.normals(end).any(|normal| normal.dot(&way).abs() >= SQUARE))
}

/// Whether a support holds the edge of an end, or one of both that meet there.
fn is_held(outline: &Outline, End { edge, along }: End) -> bool {
    let n = outline.held.len();
    outline.held[edge] || along == 0.0 && outline.held[(edge + n - 1) % n]
}

/// The first point of the outline that a ray from a point meets, which may lie on the outline itself.
pub fn met(outline: &Outline, start: Option<End>, from: Point, way: Vector) -> Option<End> {
    // A ray that passes a corner by round-off meets it.
    let least = ON * outline.extent;
    let mut nearest: Option<(f64, End)> = None;
    for edge in (0..outline.points.len()).filter(|&edge| start.is_none_or(|start| edge != start.edge)) {
        let [a, b] = outline.edge(edge);
        let facing = cross(way, b - a);
        if facing == 0.0 {
            continue;
        }
        let (far, along) = (cross(a - from, b - a) / facing, cross(a - from, way) / facing);
        let over = least / (b - a).norm();
        if far > least && (-over..=1.0 + over).contains(&along) && nearest.is_none_or(|(other, _)| far < other) {
            nearest = Some((far, End { edge, along: along.clamp(0.0, 1.0) }));
        }
    }
    nearest.map(|(_, end)| end)
}

/// Unit vector to the left of the way between two points.
fn left_of([from, to]: [Point; 2]) -> Vector {
    let way = (to - from).normalize();
    Vector::new(-way.y, way.x)
}

/// The rock to the left of the way from one end to the other, and from there along the outline back.
fn part(outline: &Outline, [from, to]: [End; 2], places: [Point; 2]) -> Vec<Point> {
    let mut side = places.to_vec();
    let mut k = to.edge;
    while k != from.edge {
        k = (k + 1) % outline.points.len();
        if outline.turns[k] && !(k == from.edge && from.along == 0.0) {
            side.push(outline.points[k]);
        }
    }
    side
}

/// The part of a polygon to the left of the line through two points.
fn clip(element: &[Point], places: [Point; 2], part: &mut Vec<Point>) {
    let across = left_of(places);
    let aside = |p: Point| (p - places[0]).dot(&across);
    part.clear();
    for (a, b) in polygon::sides(element) {
        let [da, db] = [a, b].map(aside);
        if da >= 0.0 {
            part.push(a);
        }
        if (da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0) {
            part.push(a + (b - a) * (da / (da - db)));
        }
    }
}

/// Whether a polygon turns left at all its corners.
fn is_convex(polygon: &[Point]) -> bool {
    let n = polygon.len();
    (0..n).all(|k| orientation(polygon[k], polygon[(k + 1) % n], polygon[(k + 2) % n]) >= 0.0)
}

/// Distance (m) of a point from a polygon, 0 inside.
fn distance(side: &[Point], p: Point) -> f64 {
    if polygon::contains(side, p) {
        return 0.0;
    }
    polygon::sides(side).map(|(a, b)| segment::distance(p, a, b)).fold(f64::INFINITY, f64::min)
}
