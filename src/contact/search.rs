//! Which nodes are near which edges: a bucket grid over the edges, rebuilt when nodes have moved far enough.

use crate::geometry::{Point, segment};

use super::Boundary;

/// A node and an edge that may meet before the next search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Candidate {
    /// Node.
    pub node: u32,
    /// Side of the edge.
    pub side: u32,
    /// Edge.
    pub edge: u32,
}

/// Bucket grid over edges, its candidates, and the places at which they were found.
#[derive(Debug, Clone, Default)]
pub struct SearchGrid {
    /// Near pairs, ordered by node, side and edge.
    pub candidates: Vec<Candidate>,
    found_at: Vec<Point>,
    bucket_start: Vec<u32>,
    bucket_edges: Vec<u32>,
    near: Vec<Candidate>,
}

impl SearchGrid {
    /// Whether a node has moved more than `slack` (m) since the last search.
    pub fn is_stale(&self, boundary: &Boundary, place: &[Point], slack: f64) -> bool {
        self.found_at.len() != boundary.node_count()
            || boundary
                .node_point
                .iter()
                .zip(&self.found_at)
                .any(|(&p, old)| (place[p as usize] - old).norm_squared() > slack * slack)
    }

    /// Forgets the last search, so that the next step searches anew.
    pub fn forget(&mut self) {
        self.found_at.clear();
    }

    /// Finds all nodes within `cutoff` (m) of an edge of another block, or of the other side of a partial cut.
    ///
    /// `place` holds the current boundary points; blocks in `removed` and pairs of blocks in `fixed` do not count.
    pub fn search(
        &mut self,
        boundary: &Boundary,
        place: &[Point],
        cell: f64,
        cutoff: f64,
        removed: &[bool],
        fixed: &[bool],
    ) {
        self.fill_buckets(boundary, place, cell, cutoff, removed);
        self.candidates.clear();
        self.found_at.clear();
        for node in 0..boundary.node_count() {
            let point = boundary.node_point[node] as usize;
            let p = place[point];
            self.found_at.push(p);
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
            self.candidates.extend_from_slice(&self.near);
        }
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
