//! The straight sides of the rock with what acts on them: outline, joints, cracks, and the borders of rocks.

use std::collections::BTreeMap;

use enmm::geometry::{Point, segment};
use enmm::model::Simulation;
use enmm::model::tables::{BlockId, BoundaryPiece, Outlines};

use super::loads::Loads;
use super::marks::Marks;
use crate::limit_analysis::model::Strengths;

/// A straight side between two points.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    /// Its ends among the points of the drawing.
    pub ends: [usize; 2],
    /// Properties that are the same all along it.
    pub marks: Marks,
}

/// Points and the sides between them, which meet at their ends only.
#[derive(Debug, Clone, Default)]
pub struct Drawing {
    /// Points (m).
    pub points: Vec<Point>,
    /// Sides.
    pub sides: Vec<Side>,
    /// Distance (m) within which points coincide.
    pub tolerance: f64,
}

impl Drawing {
    /// The blocks that are there, as the model has cut them.
    pub fn new(simulation: &Simulation, outlines: &Outlines, strengths: &Strengths, loads: &Loads) -> Self {
        let tolerance = 2.0 * simulation.built().noding.tolerance;
        let reader = Reader { simulation, strengths, loads, tolerance };
        let mut drawing = Self { tolerance, ..Self::default() };
        let mut known = BTreeMap::new();
        for piece in &outlines.pieces {
            if let Some(marks) = reader.marks(piece) {
                let ends = [piece.a, piece.b].map(|p| drawing.point(&mut known, p));
                drawing.sides.push(Side { ends, marks });
            }
        }
        drawing.join();
        drawing.kinks(loads);
        drawing.seams(simulation);
        drawing
    }

    fn point(&mut self, known: &mut BTreeMap<[u64; 2], usize>, p: Point) -> usize {
        // Zero has two signs.
        let key = [p.x, p.y].map(|x| (x + 0.0).to_bits());
        *known.entry(key).or_insert_with(|| {
            self.points.push(p);
            self.points.len() - 1
        })
    }

    /// Ends of a side (m).
    pub fn ends(&self, side: &Side) -> [Point; 2] {
        side.ends.map(|k| self.points[k])
    }

    /// Joins sides that go on straight and alike: the model's own mesh has cut them.
    fn join(&mut self) {
        let mut between: Vec<Vec<Point>> = vec![Vec::new(); self.sides.len()];
        let mut around: Vec<Vec<usize>> = vec![Vec::new(); self.points.len()];
        for (k, side) in self.sides.iter().enumerate() {
            side.ends.iter().for_each(|&end| around[end].push(k));
        }
        for at in 0..self.points.len() {
            let &[s, t] = &around[at][..] else { continue };
            let [s, t] = if self.sides[s].ends[1] == at { [s, t] } else { [t, s] };
            if s == t || self.sides[s].ends[1] != at || !self.goes_on([s, t], at, &between) {
                continue;
            }
            let end = self.sides[t].ends[1];
            self.sides[s].ends[1] = end;
            let more = std::mem::take(&mut between[t]);
            between[s].push(self.points[at]);
            between[s].extend(more);
            around[at].clear();
            around[end].iter_mut().filter(|k| **k == t).for_each(|k| *k = s);
            self.sides[t].ends = [usize::MAX; 2];
        }
        self.sides.retain(|side| side.ends[0] != usize::MAX);
        self.drop_unused_points();
    }

    fn goes_on(&self, [s, t]: [usize; 2], at: usize, between: &[Vec<Point>]) -> bool {
        let (first, second) = (&self.sides[s], &self.sides[t]);
        let [a, m, b] = [first.ends[0], at, second.ends[1]].map(|k| self.points[k]);
        let ahead = first.marks == second.marks && second.ends[0] == at && first.ends[0] != second.ends[1];
        let middle = between[s].iter().chain(&between[t]);
        ahead
            && (m - a).dot(&(b - m)) > 0.0
            && std::iter::once(&m).chain(middle).all(|&p| segment::distance(p, a, b) <= self.tolerance)
    }

    fn drop_unused_points(&mut self) {
        let mut place = vec![None; self.points.len()];
        let mut points = Vec::new();
        for side in &mut self.sides {
            for end in &mut side.ends {
                *end = *place[*end].get_or_insert_with(|| {
                    points.push(self.points[*end]);
                    points.len() - 1
                });
            }
        }
        self.points = points;
    }

    /// Cuts wet sides where the pressure bends, so that it is linear along each.
    fn kinks(&mut self, loads: &Loads) {
        for k in 0..self.sides.len() {
            if self.sides[k].marks.is_wet {
                let [a, b] = self.ends(&self.sides[k]);
                let kinks = loads.kinks(a, b).into_iter().map(|s| a + (b - a) * s).collect();
                self.cut(k, kinks);
            }
        }
    }

    /// Cuts a side at points along it, in this order; those at an end are left out.
    fn cut(&mut self, k: usize, points: Vec<Point>) {
        for p in points {
            let at = self.place(p);
            self.cut_at(k, at);
        }
    }

    /// The point at a position, or a new one.
    fn place(&mut self, p: Point) -> usize {
        let near = self.points.iter().position(|q| (q - p).norm() <= self.tolerance);
        near.unwrap_or_else(|| {
            self.points.push(p);
            self.points.len() - 1
        })
    }

    /// Cuts a side at one of the points; what lies before it becomes a side of its own.
    fn cut_at(&mut self, k: usize, at: usize) {
        let side = self.sides[k].clone();
        if !side.ends.contains(&at) {
            self.sides.push(Side { ends: [side.ends[0], at], ..side });
            self.sides[k].ends[0] = at;
        }
    }

    /// Adds the borders of the regions of rocks, cut where they meet other sides.
    fn seams(&mut self, simulation: &Simulation) {
        for region in simulation.case().rocks.values().filter_map(|rock| rock.region.as_ref()) {
            let points: Vec<Point> = region.iter().map(|p| Point::from(*p)).collect();
            for (k, &a) in points.iter().enumerate() {
                let b = points[(k + 1) % points.len()];
                if (b - a).norm() > self.tolerance {
                    self.seam(a, b);
                }
            }
        }
    }

    fn seam(&mut self, a: Point, b: Point) {
        let ends = [a, b].map(|p| self.place(p));
        for &end in &ends {
            self.cut_others(end);
        }
        let along = b - a;
        let mut stops: Vec<(f64, usize)> = Vec::new();
        for k in 0..self.sides.len() {
            let [p, q] = self.ends(&self.sides[k]);
            let Some(at) = crossing([a, b], [p, q], self.tolerance) else { continue };
            let at = self.place(at);
            self.cut_at(k, at);
        }
        for (k, p) in self.points.iter().enumerate() {
            if segment::distance(*p, a, b) <= self.tolerance {
                stops.push(((p - a).dot(&along), k));
            }
        }
        stops.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for pair in stops.windows(2) {
            let ends = [pair[0].1, pair[1].1];
            let known = |side: &Side| side.ends == ends || side.ends == [ends[1], ends[0]];
            if !self.sides.iter().any(known) {
                self.sides.push(Side { ends, marks: Marks { is_seam: true, ..Marks::default() } });
            }
        }
    }

    /// Cuts all sides that pass through a point.
    fn cut_others(&mut self, at: usize) {
        for k in 0..self.sides.len() {
            let [p, q] = self.ends(&self.sides[k]);
            if segment::distance(self.points[at], p, q) <= self.tolerance {
                self.cut_at(k, at);
            }
        }
    }
}

/// Where two segments cross, if they do so within both and at an angle.
fn crossing([a, b]: [Point; 2], [p, q]: [Point; 2], tolerance: f64) -> Option<Point> {
    let (u, v) = (b - a, q - p);
    let cross = u.perp(&v);
    if cross.abs() <= 1e-9 * u.norm() * v.norm() {
        return None;
    }
    let s = (p - a).perp(&v) / cross;
    let t = (p - a).perp(&u) / cross;
    let within = |s: f64, length: f64| s * length > -tolerance && (s - 1.0) * length < tolerance;
    (within(s, u.norm()) && within(t, v.norm())).then(|| p + v * t)
}

/// Reads what acts on the pieces of the boundary.
struct Reader<'a> {
    simulation: &'a Simulation,
    strengths: &'a Strengths<'a>,
    loads: &'a Loads,
    tolerance: f64,
}

impl Reader<'_> {
    /// None for a piece of a block that is gone, and for one that is read from its other side.
    fn marks(&self, piece: &BoundaryPiece) -> Option<Marks> {
        let block = &self.simulation.model().covers.element_block;
        let there = |b: &BlockId| !self.strengths.is_gone(*b);
        let left = Some(block[piece.element]).filter(there)?;
        let right = piece.opposite.map(|element| block[element]).filter(there);
        let order = |p: Point| (p.x, p.y);
        if right.is_some() && order(piece.a) > order(piece.b) {
            return None;
        }
        let law = right.map(|_| self.strengths.law(piece.trace));
        let is_outer = piece.opposite.is_none();
        Some(Marks {
            left: Some(left),
            right,
            law,
            held: if is_outer { self.held(piece) } else { [false; 2] },
            loads: self.loads.on(piece, |edge| self.lies_on(piece, edge)),
            is_wet: self.loads.reach(piece, self.tolerance),
            is_seam: false,
        })
    }

    fn held(&self, piece: &BoundaryPiece) -> [bool; 2] {
        use enmm::model::case::Axes;
        let active = &self.simulation.state().fix_active;
        let mut held = [false; 2];
        for (k, fix) in self.simulation.case().fixes.iter().enumerate() {
            if active[k] && fix.edge.is_some_and(|edge| self.lies_on(piece, edge)) {
                held[0] |= fix.axes != Axes::Y;
                held[1] |= fix.axes != Axes::X;
            }
        }
        held
    }

    fn lies_on(&self, piece: &BoundaryPiece, edge: [[f64; 2]; 2]) -> bool {
        let [a, b] = edge.map(Point::from);
        [piece.a, piece.b].iter().all(|&p| segment::distance(p, a, b) <= self.tolerance)
    }
}
