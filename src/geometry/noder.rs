//! The noder: makes segments meet in common vertices only, within a tolerance.
//!
//! Knows points, edges and which edges are still where the mesh put them; nothing of faces. Vertices are never moved
//! and lie more than the merge radius apart, so that their number, and with it the work, is bounded.

use super::grid::{CellGrid, Groups, PointChains};
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
    /// Not yet tested against all vertices.
    unsplit: bool,
    /// Not yet tested against all edges.
    uncrossed: bool,
    /// Still on the line where the caller put it, among edges known not to cross each other.
    lattice: bool,
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
pub(super) struct Noder {
    pub points: Vec<Point>,
    pub edges: Vec<WorkEdge>,
    tolerance: f64,
    /// Edges allowed.
    edges_max: usize,
    merged: usize,
    grid: CellGrid,
    chains: PointChains,
    work: Work,
    /// Cells that the edges pass through.
    places: usize,
    /// Room for the edges of the next pass.
    spare: Vec<WorkEdge>,
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
        let (points, edges, spare) = (Vec::new(), Vec::new(), Vec::new());
        let mut noder = Self { points, edges, tolerance, edges_max, merged: 0, grid, chains, work, places: 0, spare };
        for Segment { a, b, label } in cut.filter(counts) {
            let (a, b) = (noder.vertex(a)?, noder.vertex(b)?);
            if a != b {
                let lattice = label.mesh.is_some() && label.trace.is_none() && label.outline == 0;
                noder.edges.push(WorkEdge { a, b, label, unsplit: true, uncrossed: true, lattice });
            }
        }
        Ok(noder)
    }

    /// Splits and crosses until nothing changes.
    pub fn run(&mut self) -> Result<NodingReport, GeometryError> {
        let mut passes = 1;
        self.places = self.places(&self.edges);
        while let Some(hits) = self.hits()? {
            if passes == PASSES_MAX {
                let (p, tolerance) = (self.points[hits[0].vertex], self.tolerance);
                return Err(GeometryError::Unsettled { passes, limit: PASSES_MAX, x: p.x, y: p.y, tolerance });
            }
            self.split(hits)?;
            passes += 1;
        }
        let (tolerance, merged_vertices) = (self.tolerance, self.merged);
        Ok(NodingReport { tolerance, passes, merged_vertices, ..Default::default() })
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
        if self.edges.is_empty() { Ok(()) } else { self.check_count(self.places, limit, self.edges.len() as u32 / 2) }
    }

    /// Cells of the grid that edges pass through, each as often as one does.
    fn places(&self, edges: &[WorkEdge]) -> usize {
        edges.iter().map(|edge| self.ends(edge)).map(|(a, b)| self.grid.cells_along(a, b)).sum()
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
        for (id, edge) in (0u32..).zip(&self.edges).filter(|(_, edge)| edge.unsplit) {
            let (a, b) = self.ends(edge);
            let mut compared = 0;
            self.grid.visit_edge(a, b, self.tolerance, |cell| {
                let near = self.chains.get(cell).inspect(|_| compared += 1);
                hits.extend(near.filter_map(|vertex| self.near(id, vertex)));
            });
            self.work.take(compared, a)?;
            self.check_count(hits.len(), HITS_RATIO.saturating_mul(self.edges_max), id)?;
        }
        self.edges.iter_mut().filter(|edge| edge.unsplit).for_each(|edge| edge.unsplit = false);
        Ok(hits)
    }

    /// Finds the crossings of edges that have not been tested yet, and the edges near the vertices made there.
    fn crossings(&mut self) -> Result<Vec<Hit>, GeometryError> {
        if self.edges.iter().all(|edge| !edge.uncrossed || edge.lattice) {
            return Ok(Vec::new());
        }
        let cells = self.cells_to_cross();
        let first_new = self.points.len();
        let crossings = self.cross_all(&cells)?;
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
            let cell = self.grid.cell_of(self.points[vertex]);
            self.work.take(cells.get(cell).len(), self.points[vertex])?;
            hits.extend(cells.get(cell).iter().filter_map(|&edge| self.near(edge, vertex)));
        }
        self.edges.iter_mut().filter(|edge| edge.uncrossed).for_each(|edge| edge.uncrossed = false);
        Ok(hits)
    }

    /// The edges in each cell that an untested edge comes near; the other cells stay empty.
    fn cells_to_cross(&self) -> Groups {
        let mut wanted = vec![false; self.grid.len()];
        for edge in self.edges.iter().filter(|edge| edge.uncrossed && !edge.lattice) {
            let (a, b) = self.ends(edge);
            self.grid.visit_edge(a, b, self.tolerance, |cell| wanted[cell] = true);
        }
        Groups::build(self.grid.len(), |put| {
            for (id, edge) in (0u32..).zip(&self.edges) {
                let (a, b) = self.ends(edge);
                self.grid.visit_edge(a, b, self.tolerance, |cell| {
                    if wanted[cell] {
                        put(cell, id);
                    }
                });
            }
        })
    }

    /// Makes a vertex at each proper crossing of an untested edge with any other.
    fn cross_all(&mut self, cells: &Groups) -> Result<Vec<Crossing>, GeometryError> {
        let mut crossings = Vec::new();
        let mut seen = vec![None; self.edges.len()];
        let mut near = Vec::new();
        for e in 0..self.edges.len() as u32 {
            let edge = self.edges[e as usize];
            if !edge.uncrossed || edge.lattice {
                continue;
            }
            near.clear();
            let (a, b) = self.ends(&edge);
            let mut compared = 0;
            self.grid.visit_edge(a, b, self.tolerance, |cell| {
                compared += cells.get(cell).len();
                for &f in cells.get(cell) {
                    let other = &self.edges[f as usize];
                    let taken = f <= e && other.uncrossed && !other.lattice;
                    if !taken && seen[f as usize].replace(e) != Some(e) {
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
        hits.sort_unstable_by(|p, q| (p.edge.cmp(&q.edge)).then(p.at.total_cmp(&q.at)).then(p.vertex.cmp(&q.vertex)));
        hits.dedup_by_key(|hit| (hit.edge, hit.vertex));
        let pieces = self.edges.len() + hits.len();
        self.check_count(pieces, self.edges_max, hits[hits.len() / 2].edge)?;
        let mut edges = std::mem::take(&mut self.spare);
        edges.clear();
        edges.reserve(pieces);
        let (mut places, mut whole) = (self.places, 0);
        for own in hits.chunk_by(|p, q| p.edge == q.edge) {
            let split = own[0].edge as usize;
            edges.extend_from_slice(&self.edges[whole..split]);
            let first = edges.len();
            push_chain(&self.edges[split], own, &mut edges);
            places += self.places(&edges[first..]);
            places -= self.places(&self.edges[split..=split]);
            whole = split + 1;
        }
        edges.extend_from_slice(&self.edges[whole..]);
        self.places = places;
        self.spare = std::mem::replace(&mut self.edges, edges);
        Ok(())
    }
}

/// Appends the pieces of an edge through its hits, in order; bent pieces must be tested again.
fn push_chain(edge: &WorkEdge, hits: &[Hit], edges: &mut Vec<WorkEdge>) {
    let (mut from, mut bent_from) = (edge.a, false);
    let end = (edge.b, false);
    for (to, bends) in hits.iter().map(|hit| (hit.vertex, hit.bends)).chain([end]) {
        let mut piece = WorkEdge { a: from, b: to, ..*edge };
        if bends || bent_from {
            piece.unsplit = true;
            piece.uncrossed = true;
            piece.lattice = false;
        }
        edges.push(piece);
        (from, bent_from) = (to, bends);
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
