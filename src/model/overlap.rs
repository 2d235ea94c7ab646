//! An audit of overlaps that knows nothing of contacts: only the polygons of the blocks at their current places.

use rayon::prelude::*;

use crate::contact::{Boundary, EdgeId, VertexEdge};
use crate::cover::BlockId;
use crate::geometry::{Point, Vector, orientation, polygon, segment};

use super::Simulation;

/// Opening (m) from which a crack is a way in.
const ROOM: f64 = 1e-3;
/// Overlap over the mesh size that no contact presses blocks to.
pub const DEEP: f64 = 0.01;
/// Closure of springs by which an overlap is explained: faces bend between two contacts.
const EXPLAINED: f64 = 1.2;

/// Deepest overlap (m) of two blocks in the last step, and which.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Overlap {
    /// Depth (m).
    pub depth: f64,
    /// Depth (m) of the deepest node. Contacts hold nodes; between two of them, a mesh size apart, faces may bend into
    /// each other.
    pub at_nodes: f64,
    /// Blocks.
    pub blocks: [BlockId; 2],
}

impl Overlap {
    /// How much (m) of it no spring explains, anywhere and at the nodes: what is more than 1.2 times the closure of the
    /// most deeply pressed contact between the two blocks, which is force over stiffness, and what that contact was
    /// first seen with.
    pub fn unheld(&self, simulation: &Simulation) -> [f64; 2] {
        let boundary = &simulation.model().boundary;
        let is_between = |c: &&VertexEdge| self.blocks.iter().all(|block| c.blocks(boundary).contains(block));
        let pressed = |c: &VertexEdge| (c.history.normal_force / c.stiffness[0]).max(c.loaded_penetration());
        let closure = |c: &VertexEdge| pressed(c) + c.history.offset;
        let contacts = simulation.workspace().contacts.iter().filter(is_between);
        let held = EXPLAINED * contacts.map(closure).fold(0.0, f64::max);
        [self.depth - held, self.at_nodes - held]
    }
}

/// The blocks of a model, cut into triangles once.
#[derive(Debug, Clone)]
pub struct Audit {
    /// Boundary points of each block.
    points: Vec<Vec<EdgeId>>,
    /// Those of them that are nodes.
    nodes: Vec<Vec<EdgeId>>,
    /// Triangles of boundary points of each block that is not cracked.
    triangles: Vec<Vec<[EdgeId; 3]>>,
    cracked: Vec<bool>,
}

/// A block at its current place.
struct Placed {
    points: Vec<Point>,
    nodes: Vec<Point>,
    triangles: Vec<[Point; 3]>,
    low: Point,
    high: Point,
}

impl Audit {
    /// Cuts the blocks of a model.
    pub fn new(simulation: &Simulation) -> Self {
        let (boundary, blocks) = (&simulation.model().boundary, simulation.model().covers.block_count());
        let (mut points, mut cracked) = (vec![Vec::new(); blocks], vec![false; blocks]);
        for k in boundary.edges() {
            let block = boundary.block[k];
            points[block].push(k);
            cracked[block] |= boundary.partial[k];
        }
        let is_node = |k: &EdgeId| boundary.node_point[boundary.node_before[*k]] == *k;
        let nodes = points.iter().map(|points| points.iter().copied().filter(is_node).collect()).collect();
        let triangles = (0..blocks).map(|b| if cracked[b] { Vec::new() } else { cut(boundary, &points[b]) }).collect();
        Self { points, nodes, triangles, cracked }
    }

    /// Deepest overlap among all pairs of blocks that are near each other, at their places now.
    pub fn deepest(&self, simulation: &Simulation) -> Overlap {
        let overlaps = self.overlaps(simulation).into_par_iter();
        overlaps.max_by(|a, b| a.depth.total_cmp(&b.depth).then(b.blocks.cmp(&a.blocks))).unwrap_or_default()
    }

    /// Pairs of blocks that have passed into each other by more than [`DEEP`] of the mesh size, deepest first, at their
    /// places now; those that are `known` to have done so are looked at in any case.
    pub fn passed(&self, simulation: &Simulation, known: &[[BlockId; 2]]) -> Vec<Overlap> {
        let limit = DEEP * simulation.model().covers.mesh.size;
        let place = simulation.positions();
        let suspects = distinct(suspects(simulation, &place, limit).into_iter().chain(known.iter().copied()));
        if suspects.is_empty() {
            return Vec::new();
        }
        let mut passed = self.overlaps_of(simulation, &suspects, &place);
        passed.retain(|overlap| overlap.depth > limit);
        passed.sort_by(|a, b| b.depth.total_cmp(&a.depth).then(a.blocks.cmp(&b.blocks)));
        passed
    }

    /// Deepest overlap (m), and how much of one no spring explains at most, anywhere and at the nodes.
    pub fn worst(&self, simulation: &Simulation) -> [f64; 3] {
        let worst = |overlap: Overlap| {
            let [unheld, at_nodes] = overlap.unheld(simulation);
            [overlap.depth, unheld, at_nodes]
        };
        let deep = self.overlaps(simulation).into_par_iter().filter(|overlap| overlap.depth > 0.0);
        deep.map(worst).reduce(|| [0.0; 3], |a, b| std::array::from_fn(|k| a[k].max(b[k])))
    }

    /// Overlaps of all pairs of blocks that are near each other, at the places of the last step.
    pub fn overlaps(&self, simulation: &Simulation) -> Vec<Overlap> {
        let (boundary, frames) = (&simulation.model().boundary, &simulation.workspace().frames);
        let place: Vec<Point> = boundary.edges().map(|point| frames.position(point)).collect();
        let near = simulation.state().neighbours.pairs.iter();
        let pairs = near.map(|c| [boundary.node_point[c.node], c.edge].map(|k| boundary.block[k]));
        self.overlaps_of(simulation, &distinct(pairs), &place)
    }

    /// Overlaps of pairs of blocks whose boundary points have these places.
    fn overlaps_of(&self, simulation: &Simulation, pairs: &[[BlockId; 2]], place: &[Point]) -> Vec<Overlap> {
        let boundary = &simulation.model().boundary;
        let placed: Vec<Placed> = (0..self.points.len()).map(|b| self.placed(b, place)).collect();
        let overlap = |&blocks: &[BlockId; 2]| {
            let [p, q] = blocks;
            let (depth, at_nodes) = if placed[p].is_apart(placed[q].low, placed[q].high) {
                (0.0, 0.0)
            } else if self.cracked[p] || self.cracked[q] {
                let depth = |of: &[Vec<EdgeId>]| {
                    let depth = |p: BlockId, q: BlockId| corner_depth(boundary, place, &of[p], &self.points[q]);
                    depth(p, q).max(depth(q, p))
                };
                (depth(&self.points), depth(&self.nodes))
            } else {
                let at_nodes = |p: &Placed, q: &Placed| deepest_corner(&p.nodes, q);
                let [p, q] = [&placed[p], &placed[q]];
                (pair_depth(p, q), at_nodes(p, q).max(at_nodes(q, p)))
            };
            Overlap { depth, at_nodes, blocks }
        };
        pairs.par_iter().map(overlap).collect()
    }

    fn placed(&self, block: usize, place: &[Point]) -> Placed {
        let at = |points: &[EdgeId]| -> Vec<Point> { points.iter().map(|&k| place[k]).collect() };
        let (points, nodes) = (at(&self.points[block]), at(&self.nodes[block]));
        let triangles = self.triangles[block].iter().map(|t| t.map(|k| place[k])).collect();
        let (low, high) = polygon::bounds(&points);
        Placed { points, nodes, triangles, low, high }
    }
}

impl Placed {
    fn is_apart(&self, low: Point, high: Point) -> bool {
        self.low.x >= high.x || low.x >= self.high.x || self.low.y >= high.y || low.y >= self.high.y
    }
}

/// Pairs of different blocks, each once, in order.
fn distinct(pairs: impl Iterator<Item = [BlockId; 2]>) -> Vec<[BlockId; 2]> {
    let mut pairs: Vec<_> = pairs.filter(|[a, b]| a != b).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Pairs of blocks of which a node lies behind the nearest edge of the other by more than a limit (m).
fn suspects(simulation: &Simulation, place: &[Point], limit: f64) -> Vec<[BlockId; 2]> {
    let boundary = &simulation.model().boundary;
    let ends = |edge: EdgeId| [place[edge], place[boundary.after(edge)]];
    let runs = simulation.state().neighbours.pairs.chunk_by(|a, b| (a.node, a.side) == (b.node, b.side));
    let behind = runs.filter_map(|run| {
        let node = boundary.node_point[run[0].node];
        let distance = |edge: EdgeId| segment::distance(place[node], ends(edge)[0], ends(edge)[1]);
        let edge = run.iter().map(|pair| pair.edge).min_by(|&a, &b| distance(a).total_cmp(&distance(b)))?;
        let [a, b] = ends(edge);
        let is_behind = orientation(a, b, place[node]) > 0.0 && distance(edge) > limit;
        is_behind.then(|| [node, edge].map(|k| boundary.block[k]))
    });
    distinct(behind)
}

/// Triangles of a block, as indices of its boundary points.
fn cut(boundary: &Boundary, points: &[EdgeId]) -> Vec<[EdgeId; 3]> {
    let polygon: Vec<Point> = points.iter().map(|&k| boundary.reference[k]).collect();
    let index = |p: Point| points[polygon.iter().position(|q| *q == p).expect("triangles have corners of the block")];
    polygon::triangles(&polygon).iter().map(|t| t.map(index)).collect()
}

/// Deepest overlap among all pairs of blocks that are near each other, at their places now.
pub fn deepest_overlap(simulation: &Simulation) -> Overlap {
    Audit::new(simulation).deepest(simulation)
}

/// Overlap (m) of two blocks: the width of its widest piece, or how deep a corner lies in it.
fn pair_depth(p: &Placed, q: &Placed) -> f64 {
    let neighbours = |own: &Placed, other: &Placed| -> Vec<[Point; 3]> {
        let boxed = own.triangles.iter().filter(|t| {
            let (low, high) = polygon::bounds(&t[..]);
            !other.is_apart(low, high)
        });
        boxed.copied().collect()
    };
    let (own, others) = (neighbours(p, q), neighbours(q, p));
    let pieces = own.iter().flat_map(|t| others.iter().map(move |u| polygon::clip_convex(t, u)));
    let widest = pieces.filter(|piece| piece.len() > 2).map(|piece| polygon::width(&piece)).fold(0.0, f64::max);
    if widest == 0.0 { 0.0 } else { widest.max(deepest_corner(&p.points, q)).max(deepest_corner(&q.points, p)) }
}

/// Distance (m) to the boundary of the point of one block that is deepest inside another.
fn deepest_corner(points: &[Point], q: &Placed) -> f64 {
    let neighbours: Vec<Point> = points.iter().filter(|x| !q.is_apart(**x, **x)).copied().collect();
    polygon::deepest_corner(&neighbours, &q.points)
}

/// Distance (m) of the deepest point of `p` in `q` from the boundary of `q`, closed cracks left out.
fn corner_depth(boundary: &Boundary, place: &[Point], p: &[EdgeId], q: &[EdgeId]) -> f64 {
    let polygon: Vec<Point> = q.iter().map(|&k| place[k]).collect();
    let ends = |e: EdgeId| (place[e], place[boundary.after(e)]);
    // A crack's wall is a way in where the crack stands open by as much as the point lies behind it.
    let is_way_in = |e: EdgeId, x: Point| {
        let (a, b) = ends(e);
        let along = b - a;
        let foot = a + along * ((x - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let outward = Vector::new(along.y, -along.x).normalize();
        !boundary.partial[e] || !polygon::contains(&polygon, foot + outward * (foot - x).norm().max(ROOM))
    };
    let depth = |x: Point| {
        let mut near: Vec<(f64, EdgeId)> = q.iter().map(|&e| (segment::distance(x, ends(e).0, ends(e).1), e)).collect();
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        near.iter().find(|&&(_, e)| is_way_in(e, x)).map_or(f64::INFINITY, |(distance, _)| *distance)
    };
    let (low, high) = polygon::bounds(&polygon);
    let is_boxed = |x: &Point| x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y;
    let inside = p.iter().map(|&k| place[k]).filter(is_boxed).filter(|&x| polygon::contains(&polygon, x));
    inside.map(depth).fold(0.0, f64::max)
}
