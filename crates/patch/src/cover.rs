//! Which stretch of a face is no way out.
//!
//! Where a third body lies on a face, within a ledge and ten degrees, that stretch is *covered*. A body that has come
//! in is not pushed out through a covered stretch, **if it also comes in through the face beside it, near the corner
//! that both share, or through the face of the third body that goes on level there**: there is the way out, and that
//! face's cell reaches on to the covered side itself instead of to the bisector. So a block that is pressed over the
//! closed joint of a floor lies on both of its blocks, and neither pushes it along. The rule is one of geometry: it
//! knows no history and no springs. Only the height of a ledge comes in, which stays a way out.

use crate::clip::Polygon;
use crate::{Band, Body, Bound, Cell, Face, Rule, Vector};

/// A stretch of a face on which another body lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cover {
    /// That body.
    pub body: usize,
    /// Where the stretch begins and ends (m along the face).
    pub stretch: [f64; 2],
}

/// Covers of all faces of all bodies.
#[derive(Debug, Clone, Default)]
pub struct Covers {
    faces: Vec<Vec<Vec<Cover>>>,
}

impl Covers {
    /// Finds the covers of all faces.
    pub fn find(&mut self, bodies: &[Body], rule: &Rule) {
        self.faces.resize_with(bodies.len(), Vec::new);
        for (faces, body) in self.faces.iter_mut().zip(bodies) {
            faces.iter_mut().for_each(Vec::clear);
            faces.resize_with(body.outline.len(), Vec::new);
        }
        for (under, faces) in bodies.iter().zip(&mut self.faces) {
            let others = bodies.iter().enumerate().filter(|(_, over)| !std::ptr::eq(*over, under));
            for (index, over) in others.filter(|(_, over)| under.is_near(over, rule.ledge)) {
                for (face, covers) in faces.iter_mut().enumerate() {
                    let axes = under.faces[face];
                    for &other in &over.faces {
                        let stretch = covered(&axes, &other, rule);
                        covers.extend(stretch.map(|stretch| Cover { body: index, stretch }));
                    }
                }
            }
        }
    }

    /// Covers of a face.
    pub fn of(&self, body: usize, face: usize) -> &[Cover] {
        &self.faces[body][face]
    }

    /// Whether there is none at all.
    fn is_bare(&self, body: usize, face: usize) -> bool {
        self.faces.get(body).is_none_or(|faces| faces[face].is_empty())
    }
}

/// The stretch of a face along which another one lies, nowhere farther from it than a ledge, above it or below.
fn covered(face: &Face, other: &Face, rule: &Rule) -> Option<[f64; 2]> {
    if face.tangent.dot(other.tangent) > -rule.flush {
        return None;
    }
    let [low, high] = [other.start + other.tangent * other.length, other.start].map(|end| face.local(end));
    let ends = [low.x.max(0.0), high.x.min(face.length)];
    let depth = |s: f64| low.y + (high.y - low.y) * (s - low.x) / (high.x - low.x);
    (ends[0] < ends[1] && ends.iter().all(|&s| depth(s).abs() <= rule.ledge)).then_some(ends)
}

/// The face of a body that begins or ends at a point and is level with a normal there; whether it ends.
pub(crate) fn level_face(body: &Body, point: Vector, normal: Vector, rule: &Rule) -> Option<(usize, bool)> {
    let is_there = |k: &usize| (body.outline.points[*k] - point).norm() <= 2.0 * rule.ledge;
    let is_level = |(face, _): &(usize, bool)| body.faces[*face].normal().dot(normal) > rule.level;
    let at = (0..body.outline.len()).filter(is_there);
    at.flat_map(|k| [(k, false), (body.outline.previous(k), true)]).find(is_level)
}

/// How one body sees the face of another one: the parts of the cell that are open to it.
#[derive(Debug, Clone, Default)]
pub struct Access {
    /// Depths (m) at which the side beside the start and the end of the face is closed.
    closed: [Vec<[f64; 2]>; 2],
    /// Change along the face per depth of those sides.
    sides: [f64; 2],
    /// Whether the viewer lies on them itself, along more than a ledge: its corners may leave there.
    lies: [bool; 2],
    /// Stretches of the face that are open; all of it, and what lies beside it, where there is none.
    open: Vec<[f64; 2]>,
    is_parted: bool,
    polygon: Polygon,
}

/// A face of a body, and the body that comes in.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// All bodies.
    pub bodies: &'a [Body],
    /// Their covers.
    pub covers: &'a Covers,
    /// Constants.
    pub rule: &'a Rule,
    /// The body that is viewed.
    pub viewed: usize,
    /// Its face.
    pub face: usize,
    /// The body that comes in.
    pub viewer: usize,
}

impl View<'_> {
    fn body(&self) -> &Body {
        &self.bodies[self.viewed]
    }

    /// Whether the viewer comes in through a face near its start or end, or through the face of a third body that
    /// covers the side there and goes on level.
    fn comes_through(&self, face: usize, at_end: bool, side: usize, polygon: &mut Polygon) -> bool {
        if self.crosses(self.viewed, face, at_end, polygon) {
            return true;
        }
        let body = self.body();
        let (axes, normal) = (body.faces[face], body.faces[face].normal());
        let corner = if at_end { axes.global(Vector::new(axes.length, 0.0)) } else { axes.start };
        let third = self.covers.of(self.viewed, side).iter().filter(|cover| cover.body != self.viewer);
        third.into_iter().any(|cover| {
            let level = level_face(&self.bodies[cover.body], corner, normal, self.rule);
            level.is_some_and(|(face, at_end)| self.crosses(cover.body, face, at_end, polygon))
        })
    }

    /// Whether the viewer is inside a face of a body near its start or end, and reaches out there.
    fn crosses(&self, body: usize, face: usize, at_end: bool, polygon: &mut Polygon) -> bool {
        let axes = self.bodies[body].faces[face];
        let Rule { beside, ledge, .. } = *self.rule;
        polygon.set(self.bodies[self.viewer].outline.points.iter().map(|&p| axes.local(p)));
        polygon.keep(Vector::new(0.0, 1.0), beside);
        let [from, to] =
            if at_end { [(axes.length - beside).max(0.0), axes.length] } else { [0.0, beside.min(axes.length)] };
        polygon.keep(Vector::new(-1.0, 0.0), -from);
        polygon.keep(Vector::new(1.0, 0.0), to);
        let depths = polygon.corners.iter().map(|corner| corner.at.y);
        let [low, high] = depths.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| [low.min(y), high.max(y)]);
        polygon.corners.len() > 2 && low < -ledge && high > 0.0
    }

    /// Finds which parts of the cell are open.
    pub fn access(&self, access: &mut Access) {
        let outline = &self.body().outline;
        let Access { closed, sides, lies, open, is_parted, polygon } = access;
        for (end, closed) in closed.iter_mut().enumerate() {
            closed.clear();
            let side = if end == 1 { outline.next(self.face) } else { outline.previous(self.face) };
            if self.covers.is_bare(self.viewed, side) {
                continue;
            }
            if let Some(slope) = self.slope_of_side(end == 1, side) {
                (sides[end], lies[end]) = (slope, self.lies_on(side) > self.rule.ledge);
                self.close_end(end == 1, side, closed);
                if !closed.is_empty() && !self.comes_through(self.face, end == 1, side, polygon) {
                    closed.clear();
                }
            }
        }
        open.clear();
        *is_parted = !self.covers.is_bare(self.viewed, self.face) && self.leaves_beside(polygon);
        if *is_parted {
            self.part(open);
        }
    }

    /// Length (m) of a face on which the viewer lies itself.
    fn lies_on(&self, face: usize) -> f64 {
        let covers = self.covers.of(self.viewed, face).iter();
        let own = covers.filter(|cover| cover.body == self.viewer);
        own.map(|cover| cover.stretch[1] - cover.stretch[0]).fold(0.0, f64::max)
    }

    /// Change along the face per depth of the side beside its start or end: the body ends there. None of a side that
    /// goes on along the face.
    fn slope_of_side(&self, at_end: bool, side: usize) -> Option<f64> {
        let [own, beside] = [self.face, side].map(|face| self.body().faces[face].tangent);
        let turn = if at_end { own.cross(beside) } else { beside.cross(own) };
        let cotangent = -own.dot(beside) / turn;
        (own.dot(beside) < self.rule.flush && turn > 0.0).then_some(if at_end { -cotangent } else { cotangent })
    }

    /// Depths under the face at which third bodies cover the side beside its start or end.
    fn close_end(&self, at_end: bool, side: usize, closed: &mut Vec<[f64; 2]>) {
        let [own, beside] = [self.face, side].map(|face| self.body().faces[face]);
        let sine = own.tangent.cross(beside.tangent).abs();
        let third = self.covers.of(self.viewed, side).iter().filter(|cover| cover.body != self.viewer);
        closed.extend(third.map(|Cover { stretch: [from, to], .. }| {
            let from_corner = if at_end { [*from, *to] } else { [beside.length - to, beside.length - from] };
            from_corner.map(|way| way * sine)
        }));
    }

    /// Whether the viewer leaves a covered face through one beside it: it does not lie on it, but comes in there.
    fn leaves_beside(&self, polygon: &mut Polygon) -> bool {
        let outline = &self.body().outline;
        self.lies_on(self.face) == 0.0
            && (self.comes_through(outline.next(self.face), false, self.face, polygon)
                || self.comes_through(outline.previous(self.face), true, self.face, polygon))
    }

    /// Leaves of the face the parts beside the covers on it. Beyond its ends all belongs to the cover there.
    fn part(&self, open: &mut Vec<[f64; 2]>) {
        let length = self.body().faces[self.face].length;
        open.push([f64::NEG_INFINITY, f64::INFINITY]);
        for Cover { stretch: [from, to], .. } in self.covers.of(self.viewed, self.face) {
            let from = if *from <= 0.0 { f64::NEG_INFINITY } else { *from };
            let to = if *to >= length { f64::INFINITY } else { *to };
            let parts: Vec<[f64; 2]> = open.drain(..).flat_map(|[a, b]| [[a, b.min(from)], [a.max(to), b]]).collect();
            open.extend(parts.into_iter().filter(|[a, b]| a < b));
        }
    }
}

/// A part of a cell that is open, in which the same bounds and the same closed sides limit it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenBand {
    /// Its bounds.
    pub band: Band,
    /// Whether the side beside its start and its end is closed, and to corners as well.
    pub closed: [bool; 2],
    /// The bounds of the cell without a cover.
    pub bare: [Bound; 2],
    /// Where on the face it begins and ends (m); infinite where only the bounds limit it.
    pub stretch: [f64; 2],
}

impl Access {
    /// Calls a function with each open part of a cell, of a face of some length (m), down to a depth (m).
    pub fn each_band(&self, cell: &Cell, length: f64, deepest: f64, mut with: impl FnMut(OpenBand)) {
        let whole = [[f64::NEG_INFINITY, f64::INFINITY]];
        let open: &[[f64; 2]] = if self.is_parted { &self.open } else { &whole };
        for band in cell.bands.iter().filter(|band| band.depths[0] < deepest) {
            let mut from = band.depths[0];
            while from < band.depths[1] {
                let to = self.levels().filter(|&level| level > from).fold(band.depths[1], f64::min);
                let closed = [0, 1].map(|end| self.closed[end].iter().any(|[a, b]| *a <= from && to <= *b));
                let bounds = [0, 1].map(|end| {
                    let side = Bound { at: if end == 0 { 0.0 } else { length }, slope: self.sides[end] };
                    if closed[end] { side } else { band.bounds[end] }
                });
                let bare = band.bounds;
                let band = Band { depths: [from, to], bounds };
                let to_corners = [0, 1].map(|end| closed[end] && !self.lies[end]);
                let with_stretch = |stretch| OpenBand { band, bare, closed: to_corners, stretch };
                open.iter().for_each(|&stretch| with(with_stretch(stretch)));
                from = to;
            }
        }
    }

    /// Depths (m) at which a closed side begins or ends.
    fn levels(&self) -> impl Iterator<Item = f64> + '_ {
        self.closed.iter().flatten().flatten().copied()
    }
}
