//! An audit of overlaps that knows nothing of contacts: only the polygons of the blocks at their current places.

use enmm::contact::Boundary;
use enmm::geometry::{Point, Vector, polygon, segment};
use enmm::model::Simulation;

/// Opening (m) from which a crack is a way in.
const ROOM: f64 = 1e-3;

/// Deepest overlap (m) of two blocks in the last step, and which.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Overlap {
    /// Depth (m).
    pub depth: f64,
    /// Blocks.
    pub blocks: [u32; 2],
}

/// Deepest overlap among all pairs of blocks that are near each other, at the places of the last step.
pub fn deepest_overlap(simulation: &Simulation) -> Overlap {
    let (boundary, scratch) = (&simulation.slope().boundary, simulation.scratch());
    let mut points = vec![Vec::new(); simulation.slope().covers.block_count()];
    for k in 0..boundary.len() {
        points[boundary.block[k] as usize].push(k);
    }
    let blocks_of = |node: u32, edge: u32| {
        let own = boundary.block[boundary.node_point[node as usize] as usize];
        let other = boundary.block[edge as usize];
        [own.min(other), own.max(other)]
    };
    let mut pairs: Vec<[u32; 2]> =
        simulation.state().near.candidates.iter().map(|c| blocks_of(c.node, c.edge)).collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs.retain(|pair| pair[0] != pair[1]);
    let overlap = |&blocks: &[u32; 2]| {
        let [p, q] = blocks.map(|b| points[b as usize].as_slice());
        Overlap { depth: pair_depth(boundary, &scratch.place, p, q), blocks }
    };
    pairs.iter().map(overlap).max_by(|a, b| a.depth.total_cmp(&b.depth)).unwrap_or_default()
}

/// Overlap (m) of two blocks; of a cracked one, which is no simple polygon, the depth of corners in it.
fn pair_depth(boundary: &Boundary, place: &[Point], p: &[usize], q: &[usize]) -> f64 {
    if p.iter().chain(q).any(|&k| boundary.partial[k]) {
        return corner_depth(boundary, place, p, q).max(corner_depth(boundary, place, q, p));
    }
    let polygon = |points: &[usize]| -> Vec<Point> { points.iter().map(|&k| place[k]).collect() };
    polygon::overlap_depth(&polygon(p), &polygon(q))
}

/// Distance (m) of the deepest point of `p` in `q` from the boundary of `q`, closed cracks left out.
fn corner_depth(boundary: &Boundary, place: &[Point], p: &[usize], q: &[usize]) -> f64 {
    let polygon: Vec<Point> = q.iter().map(|&k| place[k]).collect();
    let ends = |e: usize| (place[e], place[boundary.after(e)]);
    // A crack's wall is a way in where the crack stands open by as much as the point lies behind it.
    let is_way_in = |e: usize, x: Point| {
        let (a, b) = ends(e);
        let along = b - a;
        let foot = a + along * ((x - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let outward = Vector::new(along.y, -along.x).normalize();
        !boundary.partial[e] || !polygon::contains(&polygon, foot + outward * (foot - x).norm().max(ROOM))
    };
    let depth = |x: Point| {
        let outer = q.iter().filter(|&&e| is_way_in(e, x));
        outer.map(|&e| segment::distance(x, ends(e).0, ends(e).1)).fold(f64::INFINITY, f64::min)
    };
    p.iter().map(|&k| place[k]).filter(|&x| polygon::contains(&polygon, x)).map(depth).fold(0.0, f64::max)
}
