//! The noder: makes segments meet in common vertices only, within a tolerance.
//!
//! Knows points, edges and which edges are still where the mesh put them; nothing of faces. Vertices are never moved
//! and lie more than the merge radius apart, so that their number, and with it the work, is bounded.

use std::num::NonZeroU32;

use super::edge_cells::{EdgeCells, Edges, Rank};
use super::grid::{CellGrid, PointChains};
use super::planar_map::{Label, NodingReport, Segment, VertexId};
use super::work::Work;
use super::{GeometryError, Point, cross, orientation};

/// Merge radius of vertices over the snap tolerance. With 1 more than half of adversarial inputs never settle.
const MERGE_RATIO: f64 = 1.5;
/// Passes allowed; adversarial inputs settle in about ten.
const PASSES_MAX: usize = 100;
/// A split vertex off the line by more than this part of the tolerance bends the edge, which is then tested again.
const BEND_RATIO: f64 = 1e-3;
/// Traces are cut off beyond the box of outline and mesh by this part of its diagonal, so that only the endless are.
const MARGIN_RATIO: f64 = 1.0;
/// The tolerance must exceed this many units of round-off of the largest coordinate.
const ROUND_OFF_RATIO: f64 = 64.0;
/// Hits of one pass over the edges allowed; many hits may fall on one vertex.
const HITS_RATIO: usize = 4;
/// Positions in cells of the grid over the edges allowed.
const PLACES_RATIO: usize = 100;

/// An edge in the making.
#[derive(Clone, Copy)]
pub(super) struct WorkEdge {
    pub a: VertexId,
    pub b: VertexId,
    pub label: Label,
    /// Not yet tested against all edges.
    uncrossed: bool,
    /// Still on the line where the caller put it, among edges known not to cross each other.
    lattice: bool,
    /// Made since edges were last put into cells.
    is_new: bool,
    /// The next piece of the same segment.
    next: Option<NonZeroU32>,
}

impl WorkEdge {
    /// Whether it still has to be tested against all edges.
    fn is_to_cross(&self) -> bool {
        self.uncrossed && !self.lattice
    }
}

/// A vertex that splits an edge.
struct Hit {
    edge: u32,
    vertex: VertexId,
    /// Position along the edge, 0 to 1.
    at: f64,
    /// Whether the vertex lies off the line.
    bends: bool,
}

/// A vertex made at the crossing of two edges.
struct Crossing {
    vertex: VertexId,
    edges: [u32; 2],
}

/// The noder and its search structures.
///
/// A pass costs what it changes: the first piece of an edge that is split takes its place, and the others are appended.
/// All that depends on an order takes edges by their rank, so that it is the order of the segments and along each.
pub(super) struct Noder {
    points: Vec<Point>,
    /// The edges, in order once the noder has run.
    edges: Vec<WorkEdge>,
    /// Segments at the start, whose first pieces come first among the edges.
    segments: usize,
    /// Rank of each edge behind these.
    ranks: Vec<Rank>,
    /// Edges not yet tested against all vertices, in order.
    unsplit: Vec<u32>,
    /// Edges not yet tested against all edges, each once, and some that need no such test.
    uncrossed: Vec<u32>,
    /// Edges by cell, once one has had to be crossed.
    cells: Option<EdgeCells>,
    tolerance: f64,
    /// Edges allowed.
    edges_max: usize,
    merged: usize,
    grid: CellGrid,
    chains: PointChains,
    work: Work,
    /// Cells that the edges pass through.
    places: usize,
}

impl Noder {
    /// Merges the ends of the segments that count; segments that shrink to a point vanish.
    pub fn new(
        segments: &[Segment],
        counts: impl Fn(&Segment) -> bool,
        tolerance: f64,
        edges_max: usize,
    ) -> Result<Self, GeometryError> {
        check(segments, tolerance)?;
        let reach = reach(segments);
        let cut = segments.iter().filter_map(|segment| clip(segment, &reach));
        let grid = CellGrid::for_edges(cut.clone().map(|s| (s.a, s.b)), 4.0 * tolerance);
        let chains = PointChains::new(grid.len());
        let work = Work::for_lines(segments.len());
        let (points, edges, ranks) = (Vec::new(), Vec::new(), Vec::new());
        let (segments, unsplit, uncrossed, cells) = (0, Vec::new(), Vec::new(), None);
        let (merged, places) = (0, 0);
        let mut noder = Self {
            points,
            edges,
            segments,
            ranks,
            unsplit,
            uncrossed,
            cells,
            tolerance,
            edges_max,
            merged,
            grid,
            chains,
            work,
            places,
        };
        for Segment { a, b, label } in cut.filter(counts) {
            let (a, b) = (noder.vertex(a)?, noder.vertex(b)?);
            if a != b {
                let lattice = label.mesh.is_some() && label.trace.is_none() && label.outline == 0;
                noder.edges.push(WorkEdge { a, b, label, uncrossed: true, lattice, is_new: true, next: None });
            }
        }
        noder.segments = noder.edges.len();
        let edges = (0u32..).zip(&noder.edges);
        noder.uncrossed = edges.filter(|(_, edge)| edge.is_to_cross()).map(|(id, _)| id).collect();
        Ok(noder)
    }

    /// Splits and crosses until nothing changes.
    pub fn run(&mut self) -> Result<NodingReport, GeometryError> {
        // Crossings that meet a vertex later are no ends of the drawing.
        let (mut passes, merged_vertices) = (1, self.merged);
        self.places = self.edges.iter().map(|edge| self.places(edge)).sum();
        self.unsplit = (0..self.edges.len() as u32).collect();
        while let Some(hits) = self.hits()? {
            if passes == PASSES_MAX {
                let (p, tolerance) = (self.points[hits[0].vertex], self.tolerance);
                return Err(GeometryError::Unsettled { passes, limit: PASSES_MAX, x: p.x, y: p.y, tolerance });
            }
            self.split(hits)?;
            passes += 1;
        }
        self.put_in_order();
        Ok(NodingReport { tolerance: self.tolerance, passes, merged_vertices, ..Default::default() })
    }

    /// Points and edges; the search structures are freed.
    pub fn finish(self) -> (Vec<Point>, Vec<WorkEdge>) {
        (self.points, self.edges)
    }

    /// Finds what splits edges: vertices near them, and crossings only when there are none of those.
    fn hits(&mut self) -> Result<Option<Vec<Hit>>, GeometryError> {
        self.check_places()?;
        let mut hits = self.near_vertices()?;
        if hits.is_empty() {
            hits = self.crossings()?;
        }
        Ok((!hits.is_empty()).then_some(hits))
    }

    /// Refuses more than `limit` pieces; `edge` is one of the many.
    fn check_count(&self, pieces: usize, limit: usize, edge: u32) -> Result<(), GeometryError> {
        if pieces <= limit {
            return Ok(());
        }
        let (a, b) = self.ends(&self.edges[edge as usize]);
        let middle = (a + b) * 0.5;
        Err(GeometryError::TooManyPieces { limit: self.edges_max, x: middle.x, y: middle.y })
    }

    /// Refuses edges that pass through too many cells of the grid, as dense ones across the whole plane do.
    fn check_places(&self) -> Result<(), GeometryError> {
        let limit = PLACES_RATIO.saturating_mul(self.edges_max);
        if self.places <= limit {
            return Ok(());
        }
        let middle = self.in_order().nth(self.edges.len() / 2).unwrap_or_default();
        self.check_count(self.places, limit, middle)
    }

    /// Cells of the grid that an edge passes through.
    fn places(&self, edge: &WorkEdge) -> usize {
        let (a, b) = self.ends(edge);
        self.grid.cells_along(a, b)
    }

    /// The edges in order.
    fn in_order(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.segments as u32).flat_map(|first| self.pieces(first))
    }

    /// The pieces of a segment, the first of which is given.
    fn pieces(&self, first: u32) -> impl Iterator<Item = u32> + '_ {
        std::iter::successors(Some(first), |&edge| self.edges[edge as usize].next.map(NonZeroU32::get))
    }

    /// Puts the edges in order. Their links are of no more use.
    fn put_in_order(&mut self) {
        if self.edges.len() > self.segments {
            let mut edges = Vec::with_capacity(self.edges.len());
            edges.extend(self.in_order().map(|edge| self.edges[edge as usize]));
            self.edges = edges;
        }
    }

    fn ends(&self, edge: &WorkEdge) -> (Point, Point) {
        (self.points[edge.a], self.points[edge.b])
    }

    /// Returns the vertex within the merge radius of a point, or makes one there.
    fn vertex(&mut self, p: Point) -> Result<VertexId, GeometryError> {
        let radius = MERGE_RATIO * self.tolerance;
        let mut nearest: Option<(f64, VertexId)> = None;
        let mut compared = 0;
        self.grid.visit_square(p, radius, |cell| {
            for vertex in self.chains.get(cell) {
                compared += 1;
                let distance = (self.points[vertex] - p).norm_squared();
                let is_nearer = nearest.map_or(distance <= radius * radius, |(least, first)| {
                    distance < least || (distance == least && vertex < first)
                });
                if is_nearer {
                    nearest = Some((distance, vertex));
                }
            }
        });
        self.work.take(compared, p)?;
        if let Some((distance, vertex)) = nearest {
            self.merged += usize::from(distance > 0.0);
            return Ok(vertex);
        }
        self.chains.push(self.grid.cell_of(p));
        self.points.push(p);
        Ok(VertexId::new(self.points.len() - 1))
    }

    /// Judges whether a vertex lies within the tolerance of the inside of an edge.
    fn near(&self, edge: u32, vertex: VertexId) -> Option<Hit> {
        let work = &self.edges[edge as usize];
        if vertex == work.a || vertex == work.b {
            return None;
        }
        let (hit, off_squared) = self.hit(edge, vertex);
        (off_squared < self.tolerance * self.tolerance && hit.at > 0.0 && hit.at < 1.0).then_some(hit)
    }

    /// Projects a vertex onto an edge; returns the hit and the squared distance from the line.
    #[inline]
    fn hit(&self, edge: u32, vertex: VertexId) -> (Hit, f64) {
        let (a, b) = self.ends(&self.edges[edge as usize]);
        let (along, to) = (b - a, self.points[vertex] - a);
        let length_squared = along.norm_squared();
        let off = cross(along, to);
        let off_squared = off * off / length_squared;
        let bend = BEND_RATIO * self.tolerance;
        let at = along.dot(&to) / length_squared;
        (Hit { edge, vertex, at, bends: off_squared > bend * bend }, off_squared)
    }

    /// Finds the vertices near the edges that have not been tested yet.
    fn near_vertices(&mut self) -> Result<Vec<Hit>, GeometryError> {
        let mut hits = Vec::new();
        for id in std::mem::take(&mut self.unsplit) {
            let (a, b) = self.ends(&self.edges[id as usize]);
            let mut compared = 0;
            self.grid.visit_edge(a, b, self.tolerance, |cell| {
                let near = self.chains.get(cell).inspect(|_| compared += 1);
                hits.extend(near.filter_map(|vertex| self.near(id, vertex)));
            });
            self.work.take(compared, a)?;
            self.check_count(hits.len(), HITS_RATIO.saturating_mul(self.edges_max), id)?;
        }
        Ok(hits)
    }

    /// Finds the crossings of edges that have not been tested yet, and the edges near the vertices made there.
    fn crossings(&mut self) -> Result<Vec<Hit>, GeometryError> {
        let mut untested = std::mem::take(&mut self.uncrossed);
        untested.retain(|&edge| self.edges[edge as usize].is_to_cross());
        if untested.is_empty() {
            return Ok(Vec::new());
        }
        untested.sort_unstable_by_key(|&edge| self.rank(edge));
        let cells = self.cells_to_cross(&untested);
        let first_new = self.points.len();
        let crossings = self.cross_all(&untested, &cells)?;
        let mut hits = Vec::with_capacity(2 * crossings.len());
        for crossing in &crossings {
            for edge in crossing.edges {
                let work = &self.edges[edge as usize];
                if crossing.vertex != work.a && crossing.vertex != work.b {
                    hits.push(self.hit(edge, crossing.vertex).0);
                }
            }
        }
        for vertex in VertexId::range(first_new..self.points.len()) {
            let near = cells.get(self.grid.cell_of(self.points[vertex]));
            self.work.take(near.len(), self.points[vertex])?;
            hits.extend(near.iter().filter_map(|&edge| self.near(edge, vertex)));
        }
        self.cells = Some(cells);
        untested.iter().for_each(|&edge| self.edges[edge as usize].uncrossed = false);
        Ok(hits)
    }

    /// The edges in each cell that an untested edge comes near.
    fn cells_to_cross(&mut self, untested: &[u32]) -> EdgeCells {
        let old = self.cells.take().filter(|cells| cells.serves(untested.len(), self.edges.len()));
        if let Some(mut cells) = old {
            cells.find(untested, self);
            return cells;
        }
        let cells = EdgeCells::fill(self.grid.len(), self, |put| self.in_order().for_each(put));
        self.edges.iter_mut().for_each(|edge| edge.is_new = false);
        cells
    }

    /// Makes a vertex at each proper crossing of an untested edge with any other.
    fn cross_all(&mut self, untested: &[u32], cells: &EdgeCells) -> Result<Vec<Crossing>, GeometryError> {
        let mut crossings = Vec::new();
        // The last untested edge that has seen each edge, counted from 1.
        let mut seen = vec![0u32; self.edges.len()];
        let mut near = Vec::new();
        for (turn, &e) in (1u32..).zip(untested) {
            let edge = self.edges[e as usize];
            let rank = self.rank(e);
            near.clear();
            let (a, b) = self.ends(&edge);
            let mut compared = 0;
            self.grid.visit_edge(a, b, self.tolerance, |cell| {
                compared += cells.get(cell).len();
                for &f in cells.get(cell) {
                    let taken = self.edges[f as usize].is_to_cross() && self.rank(f) <= rank;
                    if !taken && std::mem::replace(&mut seen[f as usize], turn) != turn {
                        near.push(f);
                    }
                }
            });
            self.work.take(compared, a)?;
            for &f in &near {
                if let Some(position) = self.crossing(&edge, &self.edges[f as usize]) {
                    crossings.push(Crossing { vertex: self.vertex(position)?, edges: [e, f] });
                }
            }
            self.check_count(crossings.len(), HITS_RATIO.saturating_mul(self.edges_max), e)?;
        }
        Ok(crossings)
    }

    /// Returns the point where two edges cross inside both, decided by exact signs.
    fn crossing(&self, e: &WorkEdge, f: &WorkEdge) -> Option<Point> {
        let ((a, b), (c, d)) = (self.ends(e), self.ends(f));
        let apart = |a: f64, b: f64, c: f64, d: f64| a.max(b) < c.min(d) || c.max(d) < a.min(b);
        if apart(a.x, b.x, c.x, d.x) || apart(a.y, b.y, c.y, d.y) {
            return None;
        }
        let (side_c, side_d) = (orientation(a, b, c), orientation(a, b, d));
        if !opposite(side_c, side_d) {
            return None;
        }
        let (side_a, side_b) = (orientation(c, d, a), orientation(c, d, b));
        opposite(side_a, side_b).then(|| a + (b - a) * (side_a / (side_a - side_b)))
    }

    /// Replaces each edge that is hit by the chain through its vertices.
    fn split(&mut self, mut hits: Vec<Hit>) -> Result<(), GeometryError> {
        let order = |p: &Hit, q: &Hit| self.rank(p.edge).cmp(&self.rank(q.edge));
        hits.sort_unstable_by(|p, q| order(p, q).then(p.at.total_cmp(&q.at)).then(p.vertex.cmp(&q.vertex)));
        hits.dedup_by_key(|hit| (hit.edge, hit.vertex));
        let pieces = self.edges.len() + hits.len();
        self.check_count(pieces, self.edges_max, hits[hits.len() / 2].edge)?;
        self.edges.reserve(hits.len());
        let mut last = None;
        for own in hits.chunk_by(|p, q| p.edge == q.edge) {
            let (segment, _) = self.rank(own[0].edge);
            if let Some(done) = last.replace(segment).filter(|&done| done != segment) {
                self.number(done);
            }
            self.split_edge(segment, own);
        }
        last.into_iter().for_each(|done| self.number(done));
        Ok(())
    }

    /// Ranks the pieces of a segment, some of which are new.
    fn number(&mut self, segment: u32) {
        let (mut piece, mut k) = (segment, 0);
        while let Some(next) = self.edges[piece as usize].next {
            (piece, k) = (next.get(), k + 1);
            self.ranks[piece as usize - self.segments] = (segment, k);
        }
    }

    /// Replaces an edge by the pieces through its hits, in order; bent pieces must be tested again.
    fn split_edge(&mut self, segment: u32, hits: &[Hit]) {
        let slot = hits[0].edge;
        let edge = self.edges[slot as usize];
        self.places -= self.places(&edge);
        let (mut from, mut bent_from, mut id) = (edge.a, false, slot);
        for (k, (to, bends)) in hits.iter().map(|hit| (hit.vertex, hit.bends)).chain([(edge.b, false)]).enumerate() {
            let is_bent = bends || bent_from;
            let (uncrossed, lattice) = (edge.uncrossed || is_bent, edge.lattice && !is_bent);
            let piece = WorkEdge { a: from, b: to, uncrossed, lattice, is_new: true, ..edge };
            if k > 0 {
                let next = self.edges.len() as u32;
                self.edges[id as usize].next = NonZeroU32::new(next);
                self.edges.push(piece);
                self.ranks.push((segment, 0));
                id = next;
            }
            self.edges[id as usize] = piece;
            self.places += self.places(&piece);
            self.note_piece(id, is_bent, if k == 0 { Some(&edge) } else { None });
            (from, bent_from) = (to, bends);
        }
    }

    /// Notes what has to be done with a piece, which may be in the place of an edge.
    fn note_piece(&mut self, id: u32, is_bent: bool, before: Option<&WorkEdge>) {
        if is_bent {
            self.unsplit.push(id);
        }
        if self.edges[id as usize].is_to_cross() && !before.is_some_and(WorkEdge::is_to_cross) {
            self.uncrossed.push(id);
        }
        if let Some(cells) = self.cells.as_mut().filter(|_| !before.is_some_and(|edge| edge.is_new)) {
            cells.changed.push(id);
        }
    }
}

impl Edges for Noder {
    fn visit(&self, edge: u32, visit: impl FnMut(usize)) {
        let (a, b) = self.ends(&self.edges[edge as usize]);
        self.grid.visit_edge(a, b, self.tolerance, visit);
    }

    fn rank(&self, edge: u32) -> Rank {
        (edge as usize).checked_sub(self.segments).map_or((edge, 0), |k| self.ranks[k])
    }

    fn is_new(&self, edge: u32) -> bool {
        self.edges[edge as usize].is_new
    }
}

fn opposite(a: f64, b: f64) -> bool {
    (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)
}

/// Refuses coordinates that are not finite and a tolerance within round-off.
fn check(segments: &[Segment], tolerance: f64) -> Result<(), GeometryError> {
    let mut extent = 0.0f64;
    for (index, segment) in segments.iter().enumerate() {
        for p in [segment.a, segment.b] {
            if !(p.x.is_finite() && p.y.is_finite()) {
                return Err(GeometryError::NotFinite { what: "segment".into(), index, x: p.x, y: p.y });
            }
            extent = extent.max(p.amax());
        }
    }
    let limit = ROUND_OFF_RATIO * f64::EPSILON * extent;
    if !(tolerance.is_finite() && tolerance > limit) {
        return Err(GeometryError::Tolerance { value: tolerance, limit, extent });
    }
    Ok(())
}

/// The box in which traces matter.
struct Reach {
    low: Point,
    high: Point,
}

/// Returns the box of outline and mesh with a margin, or the whole plane when there is neither.
fn reach(segments: &[Segment]) -> Reach {
    let (mut low, mut high) = (Point::repeat(f64::INFINITY), Point::repeat(f64::NEG_INFINITY));
    for segment in segments.iter().filter(|s| s.label.outline != 0 || s.label.mesh.is_some()) {
        low = low.inf(&segment.a).inf(&segment.b);
        high = high.sup(&segment.a).sup(&segment.b);
    }
    if low.x > high.x {
        return Reach { low: high, high: low };
    }
    let margin = Point::repeat(MARGIN_RATIO * (high - low).norm());
    Reach { low: low - margin, high: high + margin }
}

/// Cuts a trace off at the box; other segments and traces inside stay as they are.
fn clip(segment: &Segment, reach: &Reach) -> Option<Segment> {
    let (mut start, mut end) = (0.0f64, 1.0f64);
    let along = segment.b - segment.a;
    for axis in 0..2 {
        let (a, d) = (segment.a[axis], along[axis]);
        if a.min(a + d) >= reach.low[axis] && a.max(a + d) <= reach.high[axis] {
            continue;
        }
        let (p, q) = ((reach.low[axis] - a) / d, (reach.high[axis] - a) / d);
        start = start.max(p.min(q));
        end = end.min(p.max(q));
    }
    if start > end {
        return None;
    }
    let position = |t: f64, whole: Point| if t > 0.0 && t < 1.0 { segment.a + along * t } else { whole };
    Some(Segment { a: position(start, segment.a), b: position(end, segment.b), label: segment.label })
}
