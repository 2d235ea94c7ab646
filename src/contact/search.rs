//! Which nodes are near which edges: a bucket grid over the edges, rebuilt when nodes have moved far enough.

use crate::geometry::{Point, Vector, segment};

use super::Boundary;

/// Depth, relative to the search cutoff, from which a side that comes into view has rock before it: deeper than
/// contacts go, but for the first search, when nothing overlaps.
const BEHIND_DEPTH: f64 = 0.012;
/// The same for the first search.
const BEHIND_DEPTH_FIRST: f64 = 4e-6;

/// A node and an edge that may meet before the next search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub struct Candidate {
    /// Node.
    pub node: u32,
    /// Side of the edge.
    pub side: u32,
    /// Edge.
    pub edge: u32,
}

/// What the last search found, and where the nodes were then.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Near {
    /// Near pairs, ordered by node, side and edge.
    pub candidates: Vec<Candidate>,
    /// Nodes and sides, sorted, that came into view with the side's own rock between them: at the start, when nothing
    /// overlaps, or through a thin block. The node is not inside such a side, however deep it lies behind it.
    pub behind: Vec<[u32; 2]>,
    found_at: Vec<Point>,
}

impl Near {
    /// Whether a node has moved more than `slack` (m) since the last search.
    pub fn is_stale(&self, boundary: &Boundary, place: &[Point], slack: f64) -> bool {
        self.found_at.len() != boundary.node_count()
            || boundary
                .node_point
                .iter()
                .zip(&self.found_at)
                .any(|(&p, old)| (place[p as usize] - old).norm_squared() > slack * slack)
    }

    /// Whether all indices are those of a boundary.
    pub fn fits(&self, boundary: &Boundary) -> bool {
        let (nodes, sides, edges) = (boundary.node_count(), boundary.side_first.len(), boundary.len());
        let within = |index: u32, count: usize| (index as usize) < count;
        let candidates = self.candidates.iter();
        candidates.clone().all(|c| within(c.node, nodes) && within(c.side, sides) && within(c.edge, edges))
            && self.behind.iter().all(|[node, side]| within(*node, nodes) && within(*side, sides))
            && (self.found_at.is_empty() || self.found_at.len() == nodes)
    }

    /// Bytes of the lists.
    pub fn bytes(&self) -> usize {
        let pairs = size_of_val(self.candidates.as_slice()) + size_of_val(self.behind.as_slice());
        pairs + size_of_val(self.found_at.as_slice())
    }

    /// Copies without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.candidates.clone_from(&other.candidates);
        self.behind.clone_from(&other.behind);
        self.found_at.clone_from(&other.found_at);
    }

    /// Makes the next step search anew.
    pub fn forget(&mut self) {
        self.found_at.clear();
    }

    /// Keeps the pairs behind rock that are still in view, and adds those that have come into view deep.
    ///
    /// `old` and `behind` are scratch lists: the candidates before this search and the pairs behind rock after it.
    fn renew_behind(&mut self, old: &[Candidate], behind: &mut Vec<[u32; 2]>, gap: impl Fn(&[Candidate]) -> f64) {
        behind.clear();
        let pair = |c: &Candidate| [c.node, c.side];
        for edges in self.candidates.chunk_by(|a, b| pair(a) == pair(b)) {
            let key = pair(&edges[0]);
            let known = old.binary_search_by(|c| pair(c).cmp(&key)).is_ok();
            let was_behind = self.behind.binary_search(&key).is_ok();
            if was_behind || !known && gap(edges) < 0.0 {
                behind.push(key);
            }
        }
        std::mem::swap(&mut self.behind, behind);
    }
}

/// Bucket grid over edges: buffers of a search.
#[derive(Debug, Clone, Default)]
pub struct SearchGrid {
    bucket_start: Vec<u32>,
    bucket_edges: Vec<u32>,
    near: Vec<Candidate>,
    old: Vec<Candidate>,
    behind: Vec<[u32; 2]>,
}

/// What a search reads.
pub struct SearchView<'a> {
    /// Boundary of the blocks.
    pub boundary: &'a Boundary,
    /// Current places of the boundary points (m).
    pub place: &'a [Point],
    /// Size of a grid cell (m).
    pub cell: f64,
    /// Distance (m) within which a pair is near.
    pub cutoff: f64,
    /// Blocks that do not count.
    pub removed: &'a [bool],
    /// Blocks of which no two can meet.
    pub fixed: &'a [bool],
}

impl SearchGrid {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let buckets = size_of_val(self.bucket_start.as_slice()) + size_of_val(self.bucket_edges.as_slice());
        buckets + size_of_val(self.old.as_slice()) + size_of_val(self.behind.as_slice())
    }

    /// Finds all nodes within the cutoff of an edge of another block, or of the other side of a partial cut.
    pub fn search(&mut self, view: &SearchView, found: &mut Near) {
        let &SearchView { boundary, place, cell, cutoff, removed, fixed } = view;
        self.fill_buckets(boundary, place, cell, cutoff, removed);
        std::mem::swap(&mut self.old, &mut found.candidates);
        found.candidates.clear();
        found.found_at.clear();
        for node in 0..boundary.node_count() {
            let point = boundary.node_point[node] as usize;
            let p = place[point];
            found.found_at.push(p);
            let block = boundary.block[point] as usize;
            if removed[block] {
                continue;
            }
            self.near.clear();
            let bucket = self.bucket(cell_of(p.x, cell), cell_of(p.y, cell));
            for &edge in &self.bucket_edges[self.bucket_start[bucket] as usize..self.bucket_start[bucket + 1] as usize]
            {
                let e = edge as usize;
                if may_meet(boundary, node, e, fixed)
                    && segment::distance(p, place[e], place[boundary.after(e)]) < cutoff
                {
                    self.near.push(Candidate { node: node as u32, side: boundary.side[e], edge });
                }
            }
            self.near.sort_unstable();
            self.near.dedup();
            found.candidates.extend_from_slice(&self.near);
        }
        let depth = cutoff * if self.old.is_empty() { BEHIND_DEPTH_FIRST } else { BEHIND_DEPTH };
        found.renew_behind(&self.old, &mut self.behind, |edges| gap_over(view, edges) + depth);
    }

    fn bucket(&self, i: i64, j: i64) -> usize {
        let mixed = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (j as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
        (mixed >> 20) as usize & (self.bucket_start.len() - 2)
    }

    fn fill_buckets(&mut self, boundary: &Boundary, place: &[Point], cell: f64, cutoff: f64, removed: &[bool]) {
        let buckets = (boundary.len() * 2).next_power_of_two().max(16);
        self.bucket_start.clear();
        self.bucket_start.resize(buckets + 1, 0);
        let each_cell = |act: &mut dyn FnMut(i64, i64, u32)| {
            for e in (0..boundary.len()).filter(|&e| !removed[boundary.block[e] as usize]) {
                let (a, b) = (place[e], place[boundary.after(e)]);
                let (low, high) = (a.inf(&b), a.sup(&b));
                for i in cell_of(low.x - cutoff, cell)..=cell_of(high.x + cutoff, cell) {
                    for j in cell_of(low.y - cutoff, cell)..=cell_of(high.y + cutoff, cell) {
                        act(i, j, e as u32);
                    }
                }
            }
        };
        let mut total = 0;
        each_cell(&mut |i, j, _| {
            let bucket = self.bucket(i, j);
            self.bucket_start[bucket + 1] += 1;
            total += 1;
        });
        for k in 1..self.bucket_start.len() {
            self.bucket_start[k] += self.bucket_start[k - 1];
        }
        self.bucket_edges.clear();
        self.bucket_edges.resize(total, 0);
        each_cell(&mut |i, j, e| {
            let bucket = self.bucket(i, j);
            self.bucket_edges[self.bucket_start[bucket] as usize] = e;
            self.bucket_start[bucket] += 1;
        });
        self.bucket_start.rotate_right(1);
        self.bucket_start[0] = 0;
    }
}

/// Gap (m) of a node over the nearest of some edges of one side, negative behind it; infinite where the node is beyond
/// an end of the side and outside the side round that corner.
fn gap_over(view: &SearchView, edges: &[Candidate]) -> f64 {
    let p = view.place[view.boundary.node_point[edges[0].node as usize] as usize];
    let ends = |e: usize| (view.place[e], view.place[view.boundary.after(e)]);
    let gap = |e: usize| {
        let (a, b) = ends(e);
        (p - a).dot(&Vector::new(b.y - a.y, a.x - b.x)) / (b - a).norm()
    };
    let distance = |c: &&Candidate| {
        let (a, b) = ends(c.edge as usize);
        segment::distance(p, a, b)
    };
    let Some(nearest) = edges.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))) else { return f64::INFINITY };
    let (a, b) = ends(nearest.edge as usize);
    let along = (p - a).dot(&(b - a));
    let round = view.boundary.side_round(nearest.edge, along < 0.0, along > (b - a).norm_squared());
    if round.is_some_and(|e| gap(e as usize) > 0.0) { f64::INFINITY } else { gap(nearest.edge as usize) }
}

fn cell_of(v: f64, cell: f64) -> i64 {
    (v / cell).floor() as i64
}

/// Whether a node and an edge can touch at all.
fn may_meet(boundary: &Boundary, node: usize, edge: usize, fixed: &[bool]) -> bool {
    let point = boundary.node_point[node] as usize;
    let (own, other) = (boundary.block[point] as usize, boundary.block[edge] as usize);
    if own != other {
        return !(fixed[own] && fixed[other]);
    }
    let before = boundary.side_of_node_before(node);
    !fixed[own]
        && boundary.partial[edge]
        && boundary.node_partial(node)
        && boundary.side[edge] != boundary.side[point]
        && boundary.side[edge] != before
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buckets_hold_what_was_put_in() {
        let grid = SearchGrid { bucket_start: vec![0; 17], ..SearchGrid::default() };
        for (i, j) in [(0, 0), (-5, 3), (1 << 40, -(1 << 39))] {
            assert!(grid.bucket(i, j) < 16);
        }
    }
}
