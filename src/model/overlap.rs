//! An audit of overlaps. Depths are those of the polygons of the blocks at their places in a step, and know nothing of
//! contacts. Every [`EVERY`] steps a simulation looks for pairs that lie deeper in each other than [`DEEP`] of the mesh
//! size, or than the contacts between them explain; these become events.

use rayon::prelude::*;

use crate::contact::{Boundary, EdgeId, NearPair, VertexEdge};
use crate::cover::BlockId;
use crate::geometry::{Point, Vector, orientation, polygon, segment};
use crate::state::Suspect;

use super::Simulation;

/// Opening (m) from which a crack is a way in.
const ROOM: f64 = 1e-3;
/// Internal steps, counted from the start of the run, from one audit to the next. Where it looks does not depend on
/// communication steps, reports, threads or a resumed run.
pub const EVERY: u64 = 50;
/// Overlap over the mesh size that no contact of sound stiffness presses blocks to.
pub const DEEP: f64 = 0.01;
/// Depth over the mesh size by which a node may lie deeper than contacts explain: a ledge that a tip passes carries
/// nothing up to 1e-3 and all from 2e-3 on.
pub const UNHELD: f64 = 0.002;
/// Pairs that have overlapped and are looked at in every audit, however far in each other they are.
const FOLLOWED: usize = 16;
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
    /// most deeply pressed contact between the two blocks, which is force over stiffness. What that contact was first
    /// seen with has no force, and so explains nothing.
    pub fn unheld(&self, simulation: &Simulation) -> [f64; 2] {
        let boundary = &simulation.model().boundary;
        let is_between = |c: &&VertexEdge| self.blocks.iter().all(|block| c.blocks(boundary).contains(block));
        let contacts = simulation.workspace().contacts.iter().filter(is_between);
        let held = EXPLAINED * contacts.map(closure).fold(0.0, f64::max);
        [self.depth - held, self.at_nodes - held]
    }
}

/// Closure (m) of a contact: force over stiffness, or the penetration that springs resist.
fn closure(contact: &VertexEdge) -> f64 {
    (contact.history.normal_force / contact.stiffness[0]).max(contact.loaded_penetration())
}

/// The blocks of a model, the simple ones cut into triangles once.
#[derive(Debug, Clone)]
pub struct Audit {
    /// Boundary points of each block.
    points: Vec<Vec<EdgeId>>,
    /// Those of them that are nodes.
    nodes: Vec<Vec<EdgeId>>,
    /// Triangles of boundary points of each block that is simple.
    triangles: Vec<Vec<[EdgeId; 3]>>,
    /// Whether each block is one loop without a crack.
    simple: Vec<bool>,
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
        let mut points = vec![Vec::new(); blocks];
        boundary.edges().for_each(|k| points[boundary.block[k]].push(k));
        let is_simple = |points: &Vec<EdgeId>| {
            let loops = points.iter().filter(|&&k| boundary.after(k) <= k).count();
            loops == 1 && points.iter().all(|&k| !boundary.partial[k])
        };
        let simple: Vec<bool> = points.iter().map(is_simple).collect();
        let is_node = |k: &EdgeId| boundary.nodes.point[boundary.node_before[*k]] == *k;
        let nodes = points.iter().map(|points| points.iter().copied().filter(is_node).collect()).collect();
        let triangles = (0..blocks).map(|b| if simple[b] { cut(boundary, &points[b]) } else { Vec::new() }).collect();
        Self { points, nodes, triangles, simple }
    }

    /// Deepest overlap among all pairs of blocks that are near each other, at the places of the last step.
    pub fn deepest(&self, simulation: &Simulation) -> Overlap {
        let overlaps = self.overlaps(simulation).into_par_iter();
        overlaps.max_by(|a, b| a.depth.total_cmp(&b.depth).then(b.blocks.cmp(&a.blocks))).unwrap_or_default()
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
        let boundary = &simulation.model().boundary;
        let near = simulation.state().neighbours.pairs.iter();
        let blocks = near.map(|c| [boundary.nodes.point[c.node], c.edge].map(|k| boundary.block[k]));
        let mut pairs: Vec<_> = blocks.filter(|[a, b]| a != b).map(in_order).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs.par_iter().map(|&blocks| self.overlap(simulation, blocks)).collect()
    }

    /// Overlap of two blocks at the places of the last step.
    fn overlap(&self, simulation: &Simulation, blocks: [BlockId; 2]) -> Overlap {
        let (boundary, frames) = (&simulation.model().boundary, &simulation.workspace().frames);
        let place = |k: EdgeId| frames.position(k);
        let [p, q] = blocks;
        let placed = blocks.map(|block| self.placed(block.index(), &place));
        let (depth, at_nodes) = if placed[0].is_apart(placed[1].low, placed[1].high) {
            (0.0, 0.0)
        } else if !(self.simple[p] && self.simple[q]) {
            let depth = |of: &[Vec<EdgeId>]| {
                let depth = |p: BlockId, q: BlockId| corner_depth(boundary, &place, &of[p], &self.points[q]);
                depth(p, q).max(depth(q, p))
            };
            (depth(&self.points), depth(&self.nodes))
        } else {
            let at_nodes = |p: &Placed, q: &Placed| deepest_corner(&p.nodes, q);
            let [p, q] = &placed;
            (pair_depth(p, q), at_nodes(p, q).max(at_nodes(q, p)))
        };
        Overlap { depth, at_nodes, blocks }
    }

    fn placed(&self, block: usize, place: &impl Fn(EdgeId) -> Point) -> Placed {
        let at = |points: &[EdgeId]| -> Vec<Point> { points.iter().map(|&k| place(k)).collect() };
        let (points, nodes) = (at(&self.points[block]), at(&self.nodes[block]));
        let triangles = self.triangles[block].iter().map(|t| t.map(place)).collect();
        let (low, high) = polygon::bounds(&points);
        Placed { points, nodes, triangles, low, high }
    }
}

impl Placed {
    fn is_apart(&self, low: Point, high: Point) -> bool {
        self.low.x >= high.x || low.x >= self.high.x || self.low.y >= high.y || low.y >= self.high.y
    }
}

fn in_order([a, b]: [BlockId; 2]) -> [BlockId; 2] {
    [a.min(b), a.max(b)]
}

/// Pairs of blocks that lie deeper in each other in the last step than they should, and pairs of which that is known.
/// Nearly always no node is where none should be: then only near pairs are looked at, and nothing is allocated.
pub(super) fn find(simulation: &Simulation, suspects: &mut Vec<Suspect>) -> Vec<Overlap> {
    let size = simulation.model().covers.mesh.size;
    let is_deep = |depth: f64, unheld: f64| depth > DEEP * size || unheld > UNHELD * size;
    suspect(simulation, suspects, UNHELD * size);
    let events = &simulation.state().events;
    suspects.retain(|Suspect { blocks, depth, closure }| match events.overlapped.binary_search(blocks) {
        Ok(known) => known >= FOLLOWED && *depth > events.overlap_max,
        Err(_) => is_deep(*depth, depth - EXPLAINED * closure),
    });
    let removed = &simulation.state().removed;
    let followed = events.overlapped.iter().take(FOLLOWED).filter(|pair| !pair.iter().any(|&block| removed[block]));
    let pairs = followed.copied().chain(suspects.iter().map(|suspect| suspect.blocks));
    let overlaps = pairs.map(|blocks| simulation.overlap_audit().overlap(simulation, blocks));
    overlaps.filter(|overlap| is_deep(overlap.depth, overlap.unheld(simulation)[1])).collect()
}

/// The edge before another of the same loop.
fn before(boundary: &Boundary, edge: EdgeId) -> EdgeId {
    // Edges of a loop have rising numbers, so only the first one has to go round.
    let mut last = EdgeId::new(edge.index().saturating_sub(1));
    if boundary.after(last) != edge {
        last = edge;
        while boundary.after(last) != edge {
            last = boundary.after(last);
        }
    }
    last
}

/// Finds pairs of blocks of which a node lies in the other, by its nearest edge deeper than `least` (m), and the
/// closure of the contacts between them.
fn suspect(simulation: &Simulation, suspects: &mut Vec<Suspect>, least: f64) {
    let (boundary, frames) = (&simulation.model().boundary, &simulation.workspace().frames);
    let ends = |edge: EdgeId| [edge, boundary.after(edge)].map(|point| frames.position(point));
    // Nearest of all edges of the block that are near. Where it is nearest by an end, the point is inside the block
    // only if it lies behind the neighbour at that end, too.
    let behind = |run: &[NearPair]| {
        let point = boundary.nodes.point[run[0].node];
        let place = frames.position(point);
        let distance = |edge: EdgeId| segment::distance(place, ends(edge)[0], ends(edge)[1]);
        let measured = run.iter().map(|pair| (distance(pair.edge), pair.edge));
        let (depth, edge) = measured.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let blocks = [point, edge].map(|k| boundary.block[k]);
        let is_behind = |edge: EdgeId| {
            let [a, b] = ends(edge);
            orientation(a, b, place) > 0.0
        };
        let [a, b] = ends(edge);
        let along = (place - a).dot(&(b - a));
        let is_inside = depth > least
            && blocks[0] != blocks[1]
            && is_behind(edge)
            && (along > 0.0 || is_behind(before(boundary, edge)))
            && (along < (b - a).norm_squared() || is_behind(boundary.after(edge)));
        is_inside.then(|| Suspect { blocks: in_order(blocks), depth, closure: 0.0 })
    };
    let pairs = &simulation.state().neighbours.pairs;
    let is_run = |a: &NearPair, b: &NearPair| a.node == b.node && boundary.block[a.edge] == boundary.block[b.edge];
    suspects.clear();
    if simulation.workspace().serial {
        suspects.extend(pairs.chunk_by(is_run).filter_map(behind));
    } else {
        suspects.par_extend(pairs.par_chunk_by(is_run).filter_map(behind));
    }
    suspects.sort_unstable_by(|a, b| a.blocks.cmp(&b.blocks).then(b.depth.total_cmp(&a.depth)));
    suspects.dedup_by_key(|suspect| suspect.blocks);
    if suspects.is_empty() {
        return;
    }
    for contact in &simulation.workspace().contacts {
        let blocks = in_order(contact.blocks(boundary));
        if let Ok(k) = suspects.binary_search_by(|suspect| suspect.blocks.cmp(&blocks)) {
            suspects[k].closure = suspects[k].closure.max(closure(contact));
        }
    }
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

/// Distance (m) of the deepest point of `p` in `q` from the loops of `q`, closed cracks left out.
fn corner_depth(boundary: &Boundary, place: &impl Fn(EdgeId) -> Point, p: &[EdgeId], q: &[EdgeId]) -> f64 {
    let ends = |e: EdgeId| (place(e), place(boundary.after(e)));
    let sides: Vec<(Point, Point)> = q.iter().map(|&e| ends(e)).collect();
    let is_inside = |x: Point| polygon::enclose(sides.iter().copied(), x);
    // A crack's wall is a way in where the crack stands open by as much as the point lies behind it.
    let is_way_in = |e: EdgeId, x: Point| {
        let (a, b) = ends(e);
        let along = b - a;
        let foot = a + along * ((x - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let outward = Vector::new(along.y, -along.x).normalize();
        !boundary.partial[e] || !is_inside(foot + outward * (foot - x).norm().max(ROOM))
    };
    let depth = |x: Point| {
        let mut near: Vec<(f64, EdgeId)> = q.iter().map(|&e| (segment::distance(x, ends(e).0, ends(e).1), e)).collect();
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        near.iter().find(|&&(_, e)| is_way_in(e, x)).map_or(f64::INFINITY, |(distance, _)| *distance)
    };
    let (low, high) = polygon::bounds(&sides.iter().map(|side| side.0).collect::<Vec<Point>>());
    let is_boxed = |x: &Point| x.x >= low.x && x.x <= high.x && x.y >= low.y && x.y <= high.y;
    p.iter().map(|&k| place(k)).filter(is_boxed).filter(|&x| is_inside(x)).map(depth).fold(0.0, f64::max)
}
