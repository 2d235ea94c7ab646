//! A uniform grid over the plane with counting-sorted lists: the search structure of noder, faces and loops.
//!
//! Knows points and straight edges only. Cells on the rim reach to infinity, so nothing falls outside.

use super::{Point, VertexId};

/// Upper limit on the cells of one grid, so that memory stays bounded whatever the extent.
const CELLS_MAX: f64 = 4.0e6;
/// Edges that share a cell on average, if their total length is spread evenly.
const EDGES_PER_CELL: f64 = 2.0;

/// Square cells over a box.
pub(crate) struct CellGrid {
    low: Point,
    cell: f64,
    inverse: f64,
    columns: usize,
    rows: usize,
}

impl CellGrid {
    /// Lays square cells of at least `cell` (m) over the box, larger where the limit on cells requires it.
    pub fn new(low: Point, high: Point, cell: f64) -> Self {
        let span = high - low;
        let mut cell = cell.max(span.max() / CELLS_MAX);
        while (span.x / cell + 1.0).floor() * (span.y / cell + 1.0).floor() > CELLS_MAX {
            cell *= 1.5;
        }
        let count = |length: f64| (length / cell) as usize + 1;
        Self { low, cell, inverse: 1.0 / cell, columns: count(span.x), rows: count(span.y) }
    }

    /// Lays cells so that each holds few of `count` edges of the given total length (m); `cell_min` (m) is kept.
    pub fn for_edges(edges: impl Iterator<Item = (Point, Point)>, cell_min: f64) -> Self {
        let (mut low, mut high) = (Point::repeat(f64::INFINITY), Point::repeat(f64::NEG_INFINITY));
        let (mut length, mut count) = (0.0, 0usize);
        for (a, b) in edges {
            low = low.inf(&a).inf(&b);
            high = high.sup(&a).sup(&b);
            length += (b - a).norm();
            count += 1;
        }
        if count == 0 {
            return Self::new(Point::zeros(), Point::zeros(), cell_min);
        }
        let span = high - low;
        let area = span.x.max(cell_min) * span.y.max(cell_min);
        let by_length = EDGES_PER_CELL * area / length.max(cell_min);
        Self::new(low, high, by_length.min((area / count as f64).sqrt()).max(cell_min))
    }

    /// Returns the area of a cell (m²).
    pub fn area(&self) -> f64 {
        self.cell * self.cell
    }

    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Returns the column of an abscissa; both ends are clamped.
    pub fn column(&self, x: f64) -> usize {
        (((x - self.low.x) * self.inverse) as usize).min(self.columns - 1)
    }

    /// Returns the row of an ordinate; both ends are clamped.
    pub fn row(&self, y: f64) -> usize {
        (((y - self.low.y) * self.inverse) as usize).min(self.rows - 1)
    }

    /// Returns the cell in a column and a row.
    pub fn cell(&self, column: usize, row: usize) -> usize {
        row * self.columns + column
    }

    /// Returns the cell that holds a point.
    pub fn cell_of(&self, p: Point) -> usize {
        self.cell(self.column(p.x), self.row(p.y))
    }

    /// Visits every cell that meets the square of half-width `radius` round a point.
    pub fn visit_square(&self, p: Point, radius: f64, mut visit: impl FnMut(usize)) {
        for row in self.row(p.y - radius)..=self.row(p.y + radius) {
            for column in self.column(p.x - radius)..=self.column(p.x + radius) {
                visit(self.cell(column, row));
            }
        }
    }

    /// Returns about the number of cells through which the edge from `a` to `b` passes.
    pub fn cells_along(&self, a: Point, b: Point) -> usize {
        let along = (b - a).abs() * self.inverse;
        1 + along.x.min(self.columns as f64) as usize + along.y.min(self.rows as f64) as usize
    }

    /// Visits every cell that comes within `radius` (m, far above round-off) of the edge from `a` to `b`, once each.
    pub fn visit_edge(&self, a: Point, b: Point, radius: f64, mut visit: impl FnMut(usize)) {
        let (left, right) = if a.x <= b.x { (a, b) } else { (b, a) };
        let (first, last) = (self.column(left.x - radius), self.column(right.x + radius));
        let steep = right.x - left.x <= 2.0 * radius;
        let slope = (right.y - left.y) / (right.x - left.x);
        for column in first..=last {
            let border = |k: usize| self.low.x + k as f64 * self.cell;
            let (mut y0, mut y1) = (left.y, right.y);
            if !steep && column > first {
                y0 += (border(column) - radius - left.x).max(0.0) * slope;
            }
            if !steep && column < last {
                y1 = left.y + (border(column + 1) + radius - left.x).min(right.x - left.x) * slope;
            }
            for row in self.row(y0.min(y1) - radius)..=self.row(y0.max(y1) + radius) {
                visit(self.cell(column, row));
            }
        }
    }
}

/// Items grouped by a small integer key, in input order within a group.
pub(super) struct Groups<T = u32> {
    start: Vec<u32>,
    items: Vec<T>,
}

impl Groups {
    /// Groups edges by the cells that they come near.
    pub fn of_edges(grid: &CellGrid, edges: impl Iterator<Item = (Point, Point)> + Clone, radius: f64) -> Self {
        Self::build(grid.len(), |put| {
            for (k, (a, b)) in edges.clone().enumerate() {
                grid.visit_edge(a, b, radius, |cell| put(cell, k as u32));
            }
        })
    }
}

impl<T: Copy + Default> Groups<T> {
    /// Groups items by counting sort; `each` calls its argument with (key, item) and is run twice, alike.
    pub fn build(keys: usize, each: impl Fn(&mut dyn FnMut(usize, T))) -> Self {
        let mut start = vec![0u32; keys + 2];
        each(&mut |key, _| start[key + 2] += 1);
        for k in 2..start.len() {
            start[k] += start[k - 1];
        }
        let mut items = vec![T::default(); *start.last().unwrap_or(&0) as usize];
        each(&mut |key, item| {
            items[start[key + 1] as usize] = item;
            start[key + 1] += 1;
        });
        Self { start, items }
    }

    /// Returns the items of one group.
    pub fn get(&self, key: usize) -> &[T] {
        &self.items[self.start[key] as usize..self.start[key + 1] as usize]
    }

    /// Returns the items of one group for sorting in place.
    pub fn get_mut(&mut self, key: usize) -> &mut [T] {
        &mut self.items[self.start[key] as usize..self.start[key + 1] as usize]
    }
}

/// Points in the cells of a grid, as chains that grow.
pub(super) struct PointChains {
    head: Vec<Option<VertexId>>,
    next: Vec<Option<VertexId>>,
}

impl PointChains {
    /// Makes empty chains for a number of cells.
    pub fn new(cells: usize) -> Self {
        Self { head: vec![None; cells], next: Vec::new() }
    }

    /// Puts the next point, numbered in order of insertion, into a cell.
    pub fn push(&mut self, cell: usize) {
        let vertex = VertexId::new(self.next.len());
        self.next.push(self.head[cell].replace(vertex));
    }

    /// Returns the points of a cell, latest first.
    pub fn get(&self, cell: usize) -> impl Iterator<Item = VertexId> + '_ {
        std::iter::successors(self.head[cell], move |&vertex| self.next[vertex])
    }
}
