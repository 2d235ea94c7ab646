//! Grid of the broad phase: stretches of the boundary, sorted into square cells by their middles.

use std::ops::Range;

use enmm_lanes::{LANES, Lanes};

use crate::contact::EdgeId;
use crate::cover::BlockId;
use crate::geometry::{Point, Vector};

use super::SearchView;
use super::within::{Boxes, NOWHERE, Span, Within};

/// Size of a cell, relative to the search cutoff.
const CELL: f64 = 6.0;
/// Extent along an axis, relative to the search cutoff, beyond which no edge is added to a stretch.
const LONGEST: f64 = 8.0;
/// Most cells per stretch; where blocks have flown apart cells are larger.
const CELLS_PER_STRETCH: f64 = 4.0;

/// Up to eight consecutive edges of one loop.
#[derive(Debug, Clone, Copy)]
pub struct Stretch {
    pub span: Span,
    /// First edge.
    pub edge: EdgeId,
    /// Start of that edge among the points of the grid.
    point: u32,
    pub block: BlockId,
    count: u8,
    /// Whether one of the edges lies on a partial cut.
    pub partial: bool,
}

/// Equal square cells.
#[derive(Debug, Clone, Copy, Default)]
struct Cells {
    origin: Point,
    /// Cells per metre.
    density: f64,
    columns: usize,
    rows: usize,
}

/// Cells are stored row by row, so that the stretches of neighbouring cells in a row are consecutive.
#[derive(Debug, Clone, Default)]
pub struct Grid {
    cells: Cells,
    /// Greatest distance of the middle of a stretch from a box near it, along either axis (m).
    reach: f64,
    /// Points of all loops (m), with the first of a loop again after its last.
    x: Vec<f64>,
    y: Vec<f64>,
    pub stretches: Vec<Stretch>,
    /// First position of every cell; a row starts with a new group of eight.
    cell_start: Vec<u32>,
    /// Stretches by position: by cell and, within one, by index.
    pub stretch_at: Vec<u32>,
    /// Their boxes, in groups of eight.
    pub boxes: Vec<Boxes>,
}

impl Stretch {
    /// As many of some consecutive edges as are not too long together; the first of them starts at a point of the grid.
    fn of(view: &SearchView, edges: Range<usize>, point: usize) -> Self {
        let (boundary, edge) = (view.boundary, edges.start);
        let (mut span, mut count, mut partial) = (Span::at(view.frames.position(EdgeId::new(edge))), 0, false);
        for edge in edges {
            let longer = span.with(view.frames.position(boundary.next[edge]));
            if count > 0 && (longer.high - longer.low).amax() > LONGEST * view.cutoff {
                break;
            }
            (span, count, partial) = (longer, count + 1, partial | boundary.partial[edge]);
        }
        Self { span, edge: EdgeId::new(edge), point: point as u32, block: boundary.block[edge], count, partial }
    }

    /// Bit mask of its edges.
    #[inline(always)]
    fn edges(&self) -> u8 {
        ((1u32 << self.count) - 1) as u8
    }
}

impl Cells {
    /// Column and row of the cell of a point, or of the nearest one.
    fn of(&self, p: Point) -> [usize; 2] {
        let index = |x: f64, count: usize| ((x * self.density) as usize).min(count - 1);
        [index(p.x - self.origin.x, self.columns), index(p.y - self.origin.y, self.rows)]
    }

    fn index(&self, [column, row]: [usize; 2]) -> usize {
        row * self.columns + column
    }

    fn index_of(&self, stretch: &Stretch) -> usize {
        self.index(self.of(stretch.span.middle()))
    }
}

impl Grid {
    pub fn bytes(&self) -> usize {
        let points = size_of_val(self.x.as_slice()) + size_of_val(self.y.as_slice());
        let cells = size_of_val(self.cell_start.as_slice()) + size_of_val(self.stretch_at.as_slice());
        points + cells + size_of_val(self.stretches.as_slice()) + size_of_val(self.boxes.as_slice())
    }

    /// Fills the grid with the edges of all blocks that are present.
    pub fn lay(&mut self, view: &SearchView) {
        self.divide(view);
        self.measure(view.cutoff);
        self.sort();
    }

    /// Divides the boundary of the blocks that are present into stretches.
    fn divide(&mut self, view: &SearchView) {
        let boundary = view.boundary;
        self.x.clear();
        self.y.clear();
        self.stretches.clear();
        let mut first = 0;
        while let Some(length) = boundary.next[first..].iter().position(|next| next.index() == first) {
            let edges = first..first + length + 1;
            first = edges.end;
            if !view.removed[boundary.block[edges.start]] {
                self.divide_loop(view, edges);
            }
        }
        self.push_points([Point::zeros(); LANES]);
    }

    /// Divides a loop evenly, except where stretches would become long.
    fn divide_loop(&mut self, view: &SearchView, edges: Range<usize>) {
        let most = edges.len().div_ceil(edges.len().div_ceil(LANES));
        let first_point = self.x.len();
        let mut first = edges.start;
        while first < edges.end {
            let stretch = Stretch::of(view, first..edges.end.min(first + most), first_point + first - edges.start);
            first += stretch.count as usize;
            self.stretches.push(stretch);
        }
        let around = edges.clone().chain([edges.start]);
        self.push_points(around.map(|edge| view.frames.position(EdgeId::new(edge))));
    }

    fn push_points(&mut self, points: impl IntoIterator<Item = Point>) {
        for point in points {
            self.x.push(point.x);
            self.y.push(point.y);
        }
    }

    /// Sizes the grid for the middles of all stretches.
    fn measure(&mut self, cutoff: f64) {
        let (mut low, mut high, mut longest) = (Point::new(f64::MAX, f64::MAX), Point::new(f64::MIN, f64::MIN), 0.0f64);
        for Stretch { span, .. } in &self.stretches {
            let middle = span.middle();
            (low, high) = (low.inf(&middle), high.sup(&middle));
            longest = longest.max((span.high - span.low).amax());
        }
        self.reach = 0.5 * longest + cutoff;
        let span = (high - low).map(|x| x.max(0.0));
        let count = |cell: f64| [span.x, span.y].map(|x| (x / cell).floor() + 1.0);
        let most = CELLS_PER_STRETCH * self.stretches.len() as f64 + 16.0;
        let mut cell = CELL * cutoff;
        while count(cell).iter().product::<f64>() > most {
            cell *= 2.0;
        }
        let [columns, rows] = count(cell).map(|n| n as usize);
        self.cells = Cells { origin: low, density: 1.0 / cell, columns, rows };
    }

    /// Sorts the stretches and their boxes by cell.
    fn sort(&mut self) {
        let (cells, start) = (self.cells, &mut self.cell_start);
        start.clear();
        start.resize(cells.columns * cells.rows + 1, 0);
        self.stretches.iter().for_each(|stretch| start[cells.index_of(stretch)] += 1);
        let mut end = 0u32;
        for row in start.chunks_mut(cells.columns) {
            end = end.next_multiple_of(LANES as u32);
            for cell in row {
                end += *cell;
                *cell = end;
            }
        }
        let eights = end.div_ceil(LANES as u32) as usize;
        self.stretch_at.resize(eights * LANES, 0);
        self.boxes.clear();
        self.boxes.resize(eights, NOWHERE);
        for (k, stretch) in self.stretches.iter().enumerate() {
            let start = &mut start[cells.index_of(stretch)];
            *start -= 1;
            let at = *start as usize;
            self.stretch_at[at] = k as u32;
            stretch.span.put(&mut self.boxes[at / LANES], at % LANES);
        }
    }

    /// Bit mask of the edges of a stretch that are near a point.
    #[inline(always)]
    pub fn near_edges<L: Lanes>(&self, within: &Within<L>, p: Point, stretch: &Stretch) -> u8 {
        let from = stretch.point as usize;
        match (self.x[from..].first_chunk(), self.y[from..].first_chunk()) {
            (Some(x), Some(y)) => stretch.edges() & within.edges(p, x, y),
            _ => 0,
        }
    }

    /// Groups of eight, by index, in the cells round a box, row by row.
    #[inline(always)]
    pub fn round(&self, span: Span) -> impl Iterator<Item = Range<usize>> {
        let reach = Vector::new(self.reach, self.reach);
        let ([left, bottom], [right, top]) = (self.cells.of(span.low - reach), self.cells.of(span.high + reach));
        (bottom..=top).map(move |row| {
            let [start, end] =
                [left, right + 1].map(|column| self.cell_start[self.cells.index([column, row])] as usize);
            start / LANES..end.div_ceil(LANES)
        })
    }
}
