//! Outlines of blocks that can break, in the reference configuration.

use std::sync::OnceLock;

use crate::contact::EdgeId;
use crate::cover::BlockId;
use crate::geometry::{Point, Vector, orientation, polygon, segment};
use crate::state::Model;

use super::masses::Masses;

/// Distance over the mesh size within which a support holds an edge.
const HELD: f64 = 1e-6;
/// Distance over the mesh size within which a point lies on a straight face.
const STRAIGHT: f64 = 1e-9;

/// A block that can break.
#[derive(Debug, Clone)]
pub struct Outline {
    /// The block.
    pub block: BlockId,
    /// Rock of the case that decides: the one with the least tensile strength.
    pub rock: u16,
    /// Its boundary points in their order, counter-clockwise.
    pub edges: Vec<EdgeId>,
    /// Their places (m).
    pub points: Vec<Point>,
    /// Whether the boundary turns at each point; where a straight face crosses the mesh it does not.
    pub turns: Vec<bool>,
    /// Whether a support holds each edge.
    pub held: Vec<bool>,
    /// Whether it is convex.
    pub is_convex: bool,
    /// Longest distance (m) between two of its points, by its box.
    pub extent: f64,
    masses: OnceLock<Masses>,
}

/// A place on an outline, where a section may end: an edge, and the share of the way along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Place of the edge in the outline.
    pub edge: usize,
    /// Share of the way.
    pub along: f64,
}

impl Outline {
    /// Masses of the block, found once.
    pub fn masses(&self, model: &Model) -> &Masses {
        self.masses.get_or_init(|| Masses::of(model, self.block))
    }

    /// That of a block which is one loop without a crack, and all of whose rock can break.
    pub fn new(model: &Model, block: BlockId, edges: &[EdgeId], supports: &[Point]) -> Option<Self> {
        let boundary = &model.boundary;
        let loops = edges.iter().filter(|&&k| boundary.after(k) <= k).count();
        if loops != 1 || edges.iter().any(|&k| boundary.partial[k]) {
            return None;
        }
        let breaking = model.breaking.as_ref()?;
        let mut rock = None::<u16>;
        for e in model.covers.elements_of(block) {
            let own = model.element_rock[e];
            let strength = |rock: u16| breaking.rocks[rock as usize].as_ref().map(|rock| rock.strength.tension);
            let tension = strength(own)?;
            if rock.is_none_or(|rock| strength(rock).is_some_and(|least| tension < least)) {
                rock = Some(own);
            }
        }
        let points: Vec<Point> = edges.iter().map(|&k| boundary.reference[k]).collect();
        let n = points.len();
        let near = HELD * model.covers.mesh.size;
        let is_held = |k: usize| {
            let [a, b] = [points[k], points[(k + 1) % n]];
            supports.iter().any(|at| segment::distance(*at, a, b) <= near)
        };
        let turns_left = |k: usize| orientation(points[k], points[(k + 1) % n], points[(k + 2) % n]) >= 0.0;
        let straight = STRAIGHT * model.covers.mesh.size;
        let turns = |k: usize| segment::distance(points[k], points[(k + n - 1) % n], points[(k + 1) % n]) > straight;
        let (low, high) = polygon::bounds(&points);
        Some(Self {
            block,
            rock: rock?,
            turns: (0..n).map(turns).collect(),
            held: (0..n).map(is_held).collect(),
            is_convex: (0..n).all(turns_left),
            extent: (high - low).norm(),
            edges: edges.to_vec(),
            points,
            masses: OnceLock::new(),
        })
    }

    /// The shorter side of its box (m).
    pub fn least_extent(&self) -> f64 {
        let (low, high) = polygon::bounds(&self.points);
        (high - low).min()
    }

    /// Both ends of an edge (m).
    pub fn edge(&self, k: usize) -> [Point; 2] {
        [self.points[k], self.points[(k + 1) % self.points.len()]]
    }

    /// Places from which sections are drawn: nodes, and the middles between them.
    pub fn starts(&self, model: &Model) -> Vec<End> {
        let boundary = &model.boundary;
        let is_node = |k: usize| boundary.nodes.point[boundary.node_before[self.edges[k]]] == self.edges[k];
        let nodes: Vec<usize> = (0..self.edges.len()).filter(|&k| is_node(k)).collect();
        let mut starts = Vec::with_capacity(2 * nodes.len());
        for (k, &node) in nodes.iter().enumerate() {
            let next = nodes[(k + 1) % nodes.len()];
            starts.push(End { edge: node, along: 0.0 });
            starts.push(self.middle(node, next));
        }
        starts
    }

    /// The middle of the way along the boundary from one point to another.
    fn middle(&self, from: usize, to: usize) -> End {
        let n = self.edges.len();
        let count = (to + n - from - 1) % n + 1;
        let lengths: Vec<f64> = (0..count).map(|k| self.length((from + k) % n)).collect();
        let mut rest = 0.5 * lengths.iter().sum::<f64>();
        for (k, length) in lengths.iter().enumerate() {
            if rest <= *length {
                return End { edge: (from + k) % n, along: rest / length };
            }
            rest -= length;
        }
        End { edge: from, along: 0.5 }
    }

    fn length(&self, k: usize) -> f64 {
        let [a, b] = self.edge(k);
        (b - a).norm()
    }

    /// A place farther along the boundary by a length (m), which may be less than zero.
    pub fn shifted(&self, from: End, by: f64) -> End {
        let n = self.edges.len();
        let mut at = from.along * self.length(from.edge) + by;
        let mut edge = from.edge;
        for _ in 0..n {
            let length = self.length(edge);
            if at < 0.0 {
                edge = (edge + n - 1) % n;
                at += self.length(edge);
            } else if at > length {
                at -= length;
                edge = (edge + 1) % n;
            } else {
                return End { edge, along: at / length };
            }
        }
        from
    }

    /// Inward unit normals of the faces that meet at a place: of a corner both.
    pub fn normals(&self, at: End) -> impl Iterator<Item = Vector> {
        let n = self.edges.len();
        let normal = |k: usize| {
            let [a, b] = self.edge(k);
            let way = (b - a).normalize();
            Vector::new(-way.y, way.x)
        };
        let own = normal(at.edge);
        let before = (at.along == 0.0).then(|| normal((at.edge + n - 1) % n)).filter(|other| own.dot(other) < 0.999);
        [Some(own), before].into_iter().flatten()
    }
}
