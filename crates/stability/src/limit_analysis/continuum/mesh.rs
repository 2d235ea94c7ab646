//! A mesh of triangles over a drawing, by Delaunay triangulation whose sides and triangles are split until they are
//! small and well shaped (Ruppert 1995).

use std::collections::BTreeMap;

use enmm::geometry::{Point, orientation};
use enmm::model::tables::BlockId;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::drawing::Drawing;

/// Ratio of circumradius to shortest side from which a triangle is badly shaped: angles below 24.6°.
const SHAPE: f64 = 1.2;
/// Length of a side over that in its surroundings from which it is split.
const LONG: f64 = 1.3;
/// Length below which a side is not split for the shape of triangles, over that in its surroundings.
const SHORT: f64 = 0.2;
/// Least distance between the points that one pass adds, over the circumradius.
const APART: f64 = 0.7;
/// Passes after which the mesh is taken as it is: bad shapes cost accuracy and no truth.
const PASSES: usize = 60;

/// Angle (rad) of a triangle in a fan from which it is parted: 18°.
const NARROW: f64 = 0.314;
/// Times that the triangles of a fan are parted.
const FANS: usize = 3;

/// The part of a side between two neighbouring points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Its ends in the sense of the side.
    pub ends: [usize; 2],
    /// The side.
    pub side: usize,
}

/// A triangle, counter-clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// Its corners.
    pub corners: [usize; 3],
    /// Block that it is part of.
    pub block: BlockId,
    /// The line along the edge from each corner to the next.
    pub lines: [Option<usize>; 3],
    /// The triangle across the edge from each corner to the next.
    pub across: [Option<usize>; 3],
}

/// Triangles over a drawing.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Points (m).
    pub points: Vec<Point>,
    /// Parts of sides.
    pub lines: Vec<Line>,
    /// Triangles of rock.
    pub triangles: Vec<Triangle>,
}

/// Points or sides are too close to each other, here, to count as two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Close(pub Point);

/// Both ends of the edge from corner `k` on, the lesser first.
fn edge(corners: &[usize; 3], k: usize) -> [usize; 2] {
    let (a, b) = (corners[k], corners[(k + 1) % 3]);
    [a.min(b), a.max(b)]
}

impl Mesh {
    /// Triangles no larger than `area_at` (m²) at their centroids.
    ///
    /// # Errors
    /// A drawing with points too close to tell apart.
    pub fn new(drawing: &Drawing, area_at: impl Fn(Point) -> f64) -> Result<Self, Close> {
        let lines = drawing.sides.iter().enumerate().map(|(side, s)| Line { ends: s.ends, side }).collect();
        let mut mesh = Self { points: drawing.points.clone(), lines, triangles: Vec::new() };
        let length_at = |p: Point| 1.52 * area_at(p).sqrt();
        while mesh.split_where(|_, [a, b]| (b - a).norm() > LONG * length_at((a + b) / 2.0)) {}
        for _ in 0..PASSES {
            mesh.triangulate(drawing)?;
            let entered = mesh.entered();
            let is_split =
                |k: usize, [a, b]: [Point; 2]| entered[k] && (b - a).norm() > SHORT * length_at((a + b) / 2.0);
            if !mesh.split_where(is_split) && !mesh.insert(&area_at) {
                break;
            }
        }
        mesh.triangulate(drawing)?;
        Ok(mesh)
    }

    /// Parts the triangles about some points of the drawing into narrow ones, so that stress can turn about them, and
    /// the triangles behind those with them.
    pub fn fan(&mut self, about: &[usize]) {
        for _ in 0..FANS {
            let mut middles = BTreeMap::new();
            for triangle in &self.triangles {
                for k in (0..3).filter(|&k| about.contains(&triangle.corners[k])) {
                    let [v, a, b] = [0, 1, 2].map(|i| self.points[triangle.corners[(k + i) % 3]]);
                    if libm::atan2((a - v).perp(&(b - v)), (a - v).dot(&(b - v))) > NARROW {
                        let far = edge(&triangle.corners, (k + 1) % 3);
                        middles.entry(far).or_insert_with(|| {
                            self.points.push((a + b) / 2.0);
                            self.points.len() - 1
                        });
                    }
                }
            }
            self.split_edges(&middles);
        }
    }

    /// Splits edges at points, with the lines along them and the triangles on both sides.
    fn split_edges(&mut self, middles: &BTreeMap<[usize; 2], usize>) {
        for k in 0..self.lines.len() {
            let line = self.lines[k];
            let [a, b] = line.ends;
            if let Some(&at) = middles.get(&[a.min(b), a.max(b)]) {
                self.lines[k].ends[1] = at;
                self.lines.push(Line { ends: [at, b], ..line });
            }
        }
        let mut open: Vec<Triangle> = std::mem::take(&mut self.triangles);
        open.reverse();
        while let Some(triangle) = open.pop() {
            let corners = triangle.corners;
            match (0..3).find_map(|k| Some((k, *middles.get(&edge(&corners, k))?))) {
                Some((k, at)) => {
                    let apex = corners[(k + 2) % 3];
                    open.push(Triangle { corners: [apex, at, corners[(k + 1) % 3]], ..triangle });
                    open.push(Triangle { corners: [apex, corners[k], at], ..triangle });
                }
                None => self.triangles.push(triangle),
            }
        }
        self.connect();
    }

    /// Finds for every edge of every triangle the line along it and the triangle across it.
    fn connect(&mut self) {
        let lines: BTreeMap<[usize; 2], usize> =
            self.lines.iter().enumerate().map(|(k, line)| (edge(&[line.ends[0], line.ends[1], 0], 0), k)).collect();
        let mut starts = BTreeMap::new();
        for (t, triangle) in self.triangles.iter().enumerate() {
            (0..3).for_each(|k| _ = starts.insert([triangle.corners[k], triangle.corners[(k + 1) % 3]], t));
        }
        for triangle in &mut self.triangles {
            let corners = triangle.corners;
            triangle.lines = [0, 1, 2].map(|k| lines.get(&edge(&corners, k)).copied());
            triangle.across = [0, 1, 2].map(|k| starts.get(&[corners[(k + 1) % 3], corners[k]]).copied());
        }
    }

    /// The same with every triangle parted into three at its centroid.
    pub fn parted(mut self) -> Self {
        let whole = std::mem::take(&mut self.triangles);
        for (t, triangle) in whole.iter().enumerate() {
            let centroid = triangle.corners.iter().map(|&k| self.points[k]).sum::<Point>() / 3.0;
            self.points.push(centroid);
            for k in 0..3 {
                let across = triangle.across[k].map(|other| {
                    let start = triangle.corners[(k + 1) % 3];
                    3 * other + (0..3).find(|&edge| whole[other].corners[edge] == start).unwrap_or_default()
                });
                self.triangles.push(Triangle {
                    corners: [triangle.corners[k], triangle.corners[(k + 1) % 3], self.points.len() - 1],
                    block: triangle.block,
                    lines: [triangle.lines[k], None, None],
                    across: [across, Some(3 * t + (k + 1) % 3), Some(3 * t + (k + 2) % 3)],
                });
            }
        }
        self
    }

    /// Ends of a line (m).
    pub fn ends(&self, line: &Line) -> [Point; 2] {
        line.ends.map(|k| self.points[k])
    }

    /// Corners of a triangle (m).
    pub fn corners(&self, t: usize) -> [Point; 3] {
        self.triangles[t].corners.map(|k| self.points[k])
    }

    /// Area (m²) of a triangle.
    pub fn area(&self, t: usize) -> f64 {
        let [a, b, c] = self.corners(t);
        0.5 * (b - a).perp(&(c - a))
    }

    /// Centroid (m) of a triangle.
    pub fn centroid(&self, t: usize) -> Point {
        let [a, b, c] = self.corners(t);
        (a + b + c) / 3.0
    }

    /// Splits lines with these ends (m) in the middle; whether there were any.
    fn split_where(&mut self, splits: impl Fn(usize, [Point; 2]) -> bool) -> bool {
        let count = self.lines.len();
        for k in 0..count {
            let line = self.lines[k];
            let [a, b] = self.ends(&line);
            if splits(k, [a, b]) {
                self.points.push((a + b) / 2.0);
                let at = self.points.len() - 1;
                self.lines[k].ends[1] = at;
                self.lines.push(Line { ends: [at, line.ends[1]], ..line });
            }
        }
        self.lines.len() > count
    }

    /// Lines in whose circle the corner of a triangle beside them lies.
    fn entered(&self) -> Vec<bool> {
        let mut entered = vec![false; self.lines.len()];
        for triangle in &self.triangles {
            for k in 0..3 {
                if let Some(line) = triangle.lines[k] {
                    let apex = self.points[triangle.corners[(k + 2) % 3]];
                    entered[line] |= self.is_within(&self.lines[line], apex);
                }
            }
        }
        entered
    }

    /// Whether a point lies in the circle over a line.
    fn is_within(&self, line: &Line, p: Point) -> bool {
        let [a, b] = self.ends(line);
        (a - p).dot(&(b - p)) < -1e-9 * (b - a).norm_squared()
    }

    /// Adds the centres of circles round large and bad triangles, or splits the lines that they would enter; whether
    /// there was anything to do.
    fn insert(&mut self, area_at: &impl Fn(Point) -> f64) -> bool {
        let mut bad: Vec<(f64, Point, f64)> =
            (0..self.triangles.len()).filter_map(|t| self.centre_of_bad(t, area_at)).collect();
        bad.sort_by(|a, b| b.0.total_cmp(&a.0));
        let count = self.points.len();
        let mut enters = vec![false; self.lines.len()];
        for (_, centre, radius) in bad {
            let mut is_free = true;
            for (k, line) in self.lines.iter().enumerate().filter(|(_, line)| self.is_within(line, centre)) {
                let [a, b] = self.ends(line);
                enters[k] |= (b - a).norm() > SHORT * 1.52 * area_at((a + b) / 2.0).sqrt();
                is_free = false;
            }
            let near = |p: &Point| (p - centre).norm() < APART * radius;
            if is_free && !self.points[count..].iter().any(near) {
                self.points.push(centre);
            }
        }
        self.split_where(|k, _| enters[k]) || self.points.len() > count
    }

    /// How bad a triangle is, with the centre and the radius of the circle round it; none for a good one.
    fn centre_of_bad(&self, t: usize, area_at: &impl Fn(Point) -> f64) -> Option<(f64, Point, f64)> {
        let [a, b, c] = self.corners(t);
        let (u, v) = (b - a, c - a);
        let area = 0.5 * u.perp(&v);
        let most = area_at((a + b + c) / 3.0);
        let centre = a
            + (v.norm_squared() * enmm::geometry::Vector::new(u.y, -u.x)
                - u.norm_squared() * enmm::geometry::Vector::new(v.y, -v.x))
                * (-0.25 / area);
        let radius = (centre - a).norm();
        let shortest = [u.norm(), v.norm(), (c - b).norm()].into_iter().fold(f64::INFINITY, f64::min);
        let is_large = area > most;
        let is_bad = radius > SHAPE * shortest && shortest > SHORT * 1.52 * most.sqrt();
        let badness = (area / most).max(if is_bad { radius / shortest / SHAPE } else { 0.0 });
        (is_large || is_bad).then_some((badness, centre, radius))
    }

    /// Builds the triangles of rock from the points and lines.
    fn triangulate(&mut self, drawing: &Drawing) -> Result<(), Close> {
        let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
        let mut handles = Vec::with_capacity(self.points.len());
        for p in &self.points {
            let before = cdt.num_vertices();
            let handle = cdt.insert(Point2::new(p.x, p.y)).map_err(|_| Close(*p))?;
            if cdt.num_vertices() == before {
                return Err(Close(*p));
            }
            handles.push(handle);
        }
        let mut line_of = BTreeMap::new();
        for (k, line) in self.lines.iter().enumerate() {
            let [a, b] = line.ends;
            let [p, q] = [a, b].map(|k| handles[k]);
            if !cdt.can_add_constraint(p, q) {
                return Err(Close(self.points[a]));
            }
            cdt.add_constraint(p, q);
            line_of.insert([a.min(b), a.max(b)], k);
        }
        let faces: Vec<_> = cdt.inner_faces().collect();
        let index = |face: spade::handles::FaceHandle<'_, spade::handles::PossiblyOuterTag, _, _, _, _>| {
            face.as_inner().map(|face| face.index() - 1)
        };
        let corners: Vec<[usize; 3]> = faces.iter().map(|face| face.vertices().map(|v| v.index())).collect();
        let across: Vec<[Option<usize>; 3]> =
            faces.iter().map(|face| face.adjacent_edges().map(|edge| index(edge.rev().face()))).collect();
        let lines: Vec<[Option<usize>; 3]> =
            corners.iter().map(|c| [0, 1, 2].map(|k| line_of.get(&edge(c, k)).copied())).collect();
        let blocks = self.blocks(drawing, &corners, &lines, &across);
        debug_assert!(corners.iter().all(|c| {
            let [a, b, c] = c.map(|k| self.points[k]);
            orientation(a, b, c) > 0.0
        }));
        let mut places = 0..;
        let place: Vec<Option<usize>> = blocks.iter().map(|block| block.and_then(|_| places.next())).collect();
        let triangle = |face: usize| {
            let across = across[face].map(|next| next.and_then(|next| place[next]));
            Some(Triangle { corners: corners[face], block: blocks[face]?, lines: lines[face], across })
        };
        self.triangles = (0..corners.len()).filter_map(triangle).collect();
        Ok(())
    }

    /// Block of each face: what the sides say, and what passes across edges that are none.
    fn blocks(
        &self,
        drawing: &Drawing,
        corners: &[[usize; 3]],
        lines: &[[Option<usize>; 3]],
        across: &[[Option<usize>; 3]],
    ) -> Vec<Option<BlockId>> {
        let part = |line: usize| &drawing.sides[self.lines[line].side].marks;
        let mut blocks = vec![None; corners.len()];
        let mut open: Vec<usize> = Vec::new();
        for face in 0..corners.len() {
            for k in 0..3 {
                let Some(line) = lines[face][k].filter(|&line| !part(line).is_seam) else { continue };
                let is_left = self.lines[line].ends[0] == corners[face][k];
                let block = if is_left { part(line).left } else { part(line).right };
                if block.is_some() && blocks[face].is_none() {
                    blocks[face] = block;
                    open.push(face);
                }
            }
        }
        while let Some(face) = open.pop() {
            for k in 0..3 {
                let passes = lines[face][k].is_none_or(|line| part(line).is_seam);
                let Some(next) = across[face][k].filter(|&next| passes && blocks[next].is_none()) else { continue };
                blocks[next] = blocks[face];
                open.push(next);
            }
        }
        blocks
    }
}
