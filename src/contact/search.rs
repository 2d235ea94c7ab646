//! Which nodes are near which edges: edges sorted into a grid by their middles, anew when nodes have moved far enough.

use std::ops::Range;

use rayon::prelude::*;

use crate::geometry::{NONE, Point, Vector, segment};

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
        let (mut old, mut was) = (old.iter().map(pair).peekable(), self.behind.iter().copied().peekable());
        for edges in self.candidates.chunk_by(|a, b| pair(a) == pair(b)) {
            let key = pair(&edges[0]);
            while old.next_if(|k| *k < key).is_some() {}
            while was.next_if(|k| *k < key).is_some() {}
            let known = old.peek() == Some(&key);
            if was.peek() == Some(&key) || !known && gap(edges) < 0.0 {
                behind.push(key);
            }
        }
        std::mem::swap(&mut self.behind, behind);
    }
}

/// Nodes whose near edges are found as one run, and shared between threads as one.
const RUN: usize = 1024;
/// Most cells of a grid per edge; where blocks have flown apart cells are larger.
const CELLS_PER_EDGE: f64 = 4.0;

/// An edge in the grid, with all that most nodes ask of it.
#[derive(Debug, Clone, Copy)]
struct GridEdge {
    ends: [Point; 2],
    edge: u32,
    block: u32,
}

/// Edges in the order of the cells that hold their middles, and buffers of a search. Cells go row by row, so that
/// neighbours in a row are one run of edges.
#[derive(Debug, Clone, Default)]
pub struct SearchGrid {
    origin: Point,
    /// Cells per metre.
    density: f64,
    columns: usize,
    rows: usize,
    /// Farthest that a middle may be from a node near its edge, along either axis (m).
    reach: f64,
    cell_of_edge: Vec<u32>,
    cell_start: Vec<u32>,
    edges: Vec<GridEdge>,
    runs: Vec<Vec<Candidate>>,
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
    /// Whether to keep to the calling thread.
    pub serial: bool,
}

impl SearchGrid {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let cells = size_of_val(self.cell_start.as_slice()) + size_of_val(self.cell_of_edge.as_slice());
        let runs = self.runs.iter().map(|run| size_of_val(run.as_slice())).sum::<usize>();
        let found = runs + size_of_val(self.old.as_slice()) + size_of_val(self.behind.as_slice());
        cells + size_of_val(self.edges.as_slice()) + found
    }

    /// Finds all nodes within the cutoff of an edge of another block, or of the other side of a partial cut.
    pub fn search(&mut self, view: &SearchView, found: &mut Near) {
        self.lay(view);
        self.sort_edges(view);
        std::mem::swap(&mut self.old, &mut found.candidates);
        found.candidates.clear();
        found.found_at.clear();
        found.found_at.extend(view.boundary.node_point.iter().map(|&point| view.place[point as usize]));
        let nodes = view.boundary.node_count();
        if view.serial || nodes <= RUN {
            self.find(view, 0..nodes, &mut found.candidates);
        } else {
            let mut runs = std::mem::take(&mut self.runs);
            runs.resize_with(nodes.div_ceil(RUN), Vec::new);
            runs.par_iter_mut().enumerate().for_each(|(k, run)| {
                run.clear();
                self.find(view, k * RUN..nodes.min((k + 1) * RUN), run);
            });
            runs.iter().for_each(|run| found.candidates.extend_from_slice(run));
            self.runs = runs;
        }
        let depth = view.cutoff * if self.old.is_empty() { BEHIND_DEPTH_FIRST } else { BEHIND_DEPTH };
        found.renew_behind(&self.old, &mut self.behind, |edges| gap_over(view, edges) + depth);
    }

    /// Lays the grid over the middles of all edges that count.
    fn lay(&mut self, view: &SearchView) {
        let (mut low, mut high, mut longest) = (Point::new(f64::MAX, f64::MAX), Point::new(f64::MIN, f64::MIN), 0.0f64);
        let counts = |e: &usize| !view.removed[view.boundary.block[*e] as usize];
        for (a, b) in (0..view.boundary.len()).filter(counts).map(|e| ends(view, e)) {
            let middle = (a + b) * 0.5;
            (low, high) = (low.inf(&middle), high.sup(&middle));
            longest = longest.max((b - a).amax());
        }
        self.origin = low;
        self.reach = 0.5 * longest + view.cutoff;
        let span = (high - low).map(|x| x.max(0.0));
        let count = |cell: f64| [span.x, span.y].map(|x| (x / cell).floor() + 1.0);
        let most = CELLS_PER_EDGE * view.boundary.len() as f64 + 16.0;
        let mut cell = view.cell;
        while count(cell).iter().product::<f64>() > most {
            cell *= 2.0;
        }
        self.density = 1.0 / cell;
        [self.columns, self.rows] = count(cell).map(|n| n as usize);
    }

    /// Sorts the edges that count by cell and, within one, by index.
    fn sort_edges(&mut self, view: &SearchView) {
        let boundary = view.boundary;
        self.cell_start.clear();
        self.cell_start.resize(self.columns * self.rows + 2, 0);
        self.cell_of_edge.clear();
        for e in 0..boundary.len() {
            let (a, b) = ends(view, e);
            let cell = if view.removed[boundary.block[e] as usize] {
                NONE
            } else {
                let [column, row] = self.cell((a + b) * 0.5);
                (row * self.columns + column) as u32
            };
            self.cell_of_edge.push(cell);
            if cell != NONE {
                self.cell_start[cell as usize + 2] += 1;
            }
        }
        for k in 1..self.cell_start.len() {
            self.cell_start[k] += self.cell_start[k - 1];
        }
        let total = self.cell_start.last().map_or(0, |&n| n as usize);
        self.edges.resize(total, GridEdge { ends: [Point::zeros(); 2], edge: NONE, block: NONE });
        for (e, &cell) in self.cell_of_edge.iter().enumerate().filter(|(_, cell)| **cell != NONE) {
            let (a, b) = ends(view, e);
            let at = &mut self.cell_start[cell as usize + 1];
            self.edges[*at as usize] = GridEdge { ends: [a, b], edge: e as u32, block: boundary.block[e] };
            *at += 1;
        }
    }

    /// Column and row of the cell of a point, or of the nearest one.
    fn cell(&self, p: Point) -> [usize; 2] {
        let index = |x: f64, count: usize| ((x * self.density) as usize).min(count - 1);
        [index(p.x - self.origin.x, self.columns), index(p.y - self.origin.y, self.rows)]
    }

    /// Appends the near edges of some nodes, ordered by node, side and edge.
    fn find(&self, view: &SearchView, nodes: Range<usize>, found: &mut Vec<Candidate>) {
        let boundary = view.boundary;
        let reach = Vector::new(self.reach, self.reach);
        for node in nodes {
            let point = boundary.node_point[node] as usize;
            let p = view.place[point];
            let block = boundary.block[point];
            if view.removed[block as usize] {
                continue;
            }
            let first = found.len();
            let ([left, bottom], [right, top]) = (self.cell(p - reach), self.cell(p + reach));
            for row in bottom..=top {
                let run = |column: usize| self.cell_start[row * self.columns + column] as usize;
                for at in &self.edges[run(left)..run(right + 1)] {
                    if at.is_near(p, view.cutoff)
                        && (at.block != block || boundary.partial[at.edge as usize])
                        && segment::distance(p, at.ends[0], at.ends[1]) < view.cutoff
                        && may_meet(boundary, node, at.edge as usize, view.fixed)
                    {
                        let side = boundary.side[at.edge as usize];
                        found.push(Candidate { node: node as u32, side, edge: at.edge });
                    }
                }
            }
            found[first..].sort_unstable_by_key(|c| c.edge);
        }
    }
}

impl GridEdge {
    /// Whether a point is within `distance` (m) of the box round the edge.
    fn is_near(&self, p: Point, distance: f64) -> bool {
        let [a, b] = [self.ends[0] - p, self.ends[1] - p];
        let [x, y] = [(a.x, b.x), (a.y, b.y)].map(|(a, b)| a.min(b).max(-a.max(b)) <= distance);
        x & y
    }
}

fn ends(view: &SearchView, edge: usize) -> (Point, Point) {
    (view.place[edge], view.place[view.boundary.after(edge)])
}

/// Gap (m) of a node over the nearest of some edges of one side, negative behind it; infinite where the node is beyond
/// an end of the side and outside the side round that corner.
fn gap_over(view: &SearchView, edges: &[Candidate]) -> f64 {
    let p = view.place[view.boundary.node_point[edges[0].node as usize] as usize];
    let gap = |e: usize| {
        let (a, b) = ends(view, e);
        (p - a).dot(&Vector::new(b.y - a.y, a.x - b.x)) / (b - a).norm()
    };
    let distance = |c: &&Candidate| {
        let (a, b) = ends(view, c.edge as usize);
        segment::distance(p, a, b)
    };
    let Some(nearest) = edges.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))) else { return f64::INFINITY };
    let (a, b) = ends(view, nearest.edge as usize);
    let along = (p - a).dot(&(b - a));
    let round = view.boundary.side_round(nearest.edge, along < 0.0, along > (b - a).norm_squared());
    if round.is_some_and(|e| gap(e as usize) > 0.0) { f64::INFINITY } else { gap(nearest.edge as usize) }
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
