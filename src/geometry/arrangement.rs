//! The planar arrangement: segments with provenance in, half-edges and faces out.
//!
//! Knows where an edge comes from only as ids (outline, joint trace, mesh edge). `noder` makes edges that meet in
//! common vertices only, this file merges and prunes them, `faces` walks round them.

use super::grid::Groups;
use super::noder::{Noder, WorkEdge};
use super::planar_map::{Arrangement, Edge, Label, NodingReport, Segment, TraceId, TraceLength, VertexId};
use super::{GeometryError, Point, faces};

/// Edges whose half-edges and faces can be numbered by 32 bits.
const EDGES_MAX: usize = 1 << 30;

impl Arrangement {
    /// The arrangement without the traces along some edges; faces that nothing else parts become one.
    ///
    /// # Errors
    /// Those of the walk round the faces.
    pub fn without_traces(self, along: &[bool]) -> Result<Self, GeometryError> {
        let Self { points, mut edges, mut report, .. } = self;
        edges.iter_mut().zip(along).filter(|(_, along)| **along).for_each(|(edge, _)| edge.label.trace = None);
        edges.retain(|edge| !edge.label.is_empty());
        let kept = prune(&points, &edges, &mut report);
        let (points, edges) = compact(&points, &edges, &kept);
        faces::build(points, edges, report)
    }

    /// Adds up what became of each trace and which traces coincide; `edges` are those before pruning.
    fn report_traces(&mut self, points: &[Point], edges: &[Edge], kept: &[bool], members: &[Member], copies: &Copies) {
        let mut overlaps = Vec::new();
        let mut ranked = (0, 0); // edges looked at, and how many of them were kept
        for member in members {
            let edge = member.edge;
            ranked.1 += kept[ranked.0..edge].iter().filter(|&&kept| kept).count();
            ranked.0 = edge;
            let length = length(points, &edges[edge]);
            let in_rock = kept[edge] && self.in_rock(ranked.1);
            let report = &mut self.report.traces[member.trace];
            report.noded += length;
            report.kept += if kept[edge] { length } else { 0.0 };
            report.in_rock += if in_rock { length } else { 0.0 };
            overlaps.extend(edges[edge].label.trace.map(|holder| [holder, member.trace]));
        }
        overlaps.sort_unstable();
        overlaps.dedup();
        copies.report(&mut self.report.traces, &mut overlaps);
        overlaps.retain(|[holder, trace]| holder != trace);
        self.report.overlapping_traces = overlaps;
    }
}

/// Traces that run through the same points as an earlier one; only the first of each is cut.
struct Copies {
    /// The first trace like each.
    first: Vec<TraceId>,
}

impl Copies {
    /// Compares all traces; segments that are outline or mesh as well are never copies.
    fn find(segments: &[Segment], traces: usize) -> Self {
        let of_trace = |put: &mut dyn FnMut(usize, u32)| {
            let labelled = (0u32..).zip(segments).filter_map(|(k, segment)| Some((segment.label.trace?, k)));
            labelled.for_each(|(trace, k)| put(trace.index(), k));
        };
        let groups = Groups::build(traces, of_trace);
        let compare = |s: TraceId, t: TraceId| {
            let positions = |t: TraceId| groups.get(t.index()).iter().map(|&k| position(&segments[k as usize]));
            positions(s).cmp(positions(t))
        };
        let pure = |t: &TraceId| {
            let own = groups.get(t.index());
            own.iter().all(|&k| segments[k as usize].label == Label::trace(*t))
        };
        let mut order: Vec<TraceId> = TraceId::all(traces).filter(pure).collect();
        order.sort_unstable_by(|&s, &t| compare(s, t).then(s.cmp(&t)));
        let mut first: Vec<TraceId> = TraceId::all(traces).collect();
        for alike in order.chunk_by(|&s, &t| compare(s, t).is_eq()) {
            alike.iter().for_each(|&t| first[t] = alike[0]);
        }
        Self { first }
    }

    /// Whether a segment is to be cut.
    fn is_first(&self, segment: &Segment) -> bool {
        segment.label.trace.is_none_or(|trace| self.first[trace] == trace)
    }

    /// Gives each copy what the first has: its lengths, and its overlaps, sorted as they were.
    fn report(&self, lengths: &mut [TraceLength], overlaps: &mut Vec<[TraceId; 2]>) {
        let copies = || TraceId::all(self.first.len()).zip(&self.first).filter(|(trace, first)| trace != *first);
        if copies().next().is_none() {
            return;
        }
        let mut of_first = overlaps.clone();
        of_first.sort_unstable_by_key(|&[holder, trace]| [trace, holder]);
        for (copy, &first) in copies() {
            lengths[copy] = lengths[first];
            let from = of_first.partition_point(|pair| pair[1] < first);
            let own = of_first[from..].iter().take_while(|pair| pair[1] == first);
            overlaps.extend(own.map(|&[holder, _]| [holder, copy]));
        }
        overlaps.sort_unstable();
    }
}

/// Start and end of a segment as numbers that compare.
fn position(segment: &Segment) -> [u64; 4] {
    [segment.a.x, segment.a.y, segment.b.x, segment.b.y].map(f64::to_bits)
}

/// Cuts the plane along segments: merges what lies within `tolerance` (m), inserts crossings, trims dead ends, walks
/// round the faces and floods the winding from outside.
///
/// Vertices within 1.5 tolerances become one, at the position of the first in input order; edges are split at vertices
/// nearer than one tolerance. Mesh edges may meet each other in shared ends only. Traces are cut off far outside the
/// box of outline and mesh, where they can bound no rock.
///
/// # Errors
/// A coordinate that is not finite, a tolerance within round-off, outlines that do not close, or a noder that does not
/// settle within its passes.
pub fn arrange(segments: &[Segment], tolerance: f64) -> Result<Arrangement, GeometryError> {
    arrange_within(segments, tolerance, EDGES_MAX)
}

/// As [`arrange`], stopping as soon as there are more than `edges_max` edges.
///
/// # Errors
/// As [`arrange`], and too many edges.
pub fn arrange_within(segments: &[Segment], tolerance: f64, edges_max: usize) -> Result<Arrangement, GeometryError> {
    let traces = segments.iter().filter_map(|s| s.label.trace).map(|trace| trace.index() + 1).max().unwrap_or(0);
    let copies = Copies::find(segments, traces);
    let mut noder = Noder::new(segments, |s| copies.is_first(s), tolerance, edges_max.min(EDGES_MAX))?;
    let mut report = noder.run()?;
    let (points, work) = noder.finish();
    report.traces = vec![TraceLength::default(); traces];
    let Merged { edges, members, fused_length } = merge_coincident(&points, &work);
    report.fused_outline_length = fused_length;
    let kept = prune(&points, &edges, &mut report);
    let (points_kept, edges_kept) = compact(&points, &edges, &kept);
    let mut arrangement = faces::build(points_kept, edges_kept, report)?;
    arrangement.report_traces(&points, &edges, &kept, &members, &copies);
    Ok(arrangement)
}

/// A trace that runs along an edge.
struct Member {
    edge: usize,
    trace: TraceId,
}

/// Edges each of which is the only one between its vertices.
struct Merged {
    edges: Vec<Edge>,
    members: Vec<Member>,
    /// Length along which outlines cancel without a trace (m).
    fused_length: f64,
}

/// Merges edges between the same vertices, drops those whose outlines cancel, and lists which traces run where.
fn merge_coincident(points: &[Point], edges: &[WorkEdge]) -> Merged {
    let mut groups = Groups::build(points.len(), |put| {
        for (k, edge) in edges.iter().enumerate() {
            put(edge.a.min(edge.b).index(), k as u32);
        }
    });
    let mut merged = Merged { edges: Vec::with_capacity(edges.len()), members: Vec::new(), fused_length: 0.0 };
    let far = |k: u32| edges[k as usize].a.max(edges[k as usize].b);
    for vertex in 0..points.len() {
        let group = groups.get_mut(vertex);
        group.sort_unstable_by_key(|&k| (far(k), k));
        for run in group.chunk_by(|&i, &j| far(i) == far(j)) {
            let edge = merge_run(edges, run, merged.edges.len(), &mut merged.members);
            let cancels = edge.label.outline == 0 && edge.label.trace.is_none();
            if cancels && run.iter().any(|&k| edges[k as usize].label.outline != 0) {
                merged.fused_length += length(points, &edge);
            }
            if !edge.label.is_empty() {
                merged.edges.push(edge);
            }
        }
    }
    merged
}

/// Merges a run of edges between the same two vertices and lists its traces, each once.
fn merge_run(edges: &[WorkEdge], run: &[u32], edge: usize, members: &mut Vec<Member>) -> Edge {
    let WorkEdge { a, b, mut label, .. } = edges[run[0] as usize];
    for &k in &run[1..] {
        let other = &edges[k as usize];
        label.absorb(if other.a == a { other.label } else { other.label.reversed() });
    }
    let first = members.len();
    for trace in run.iter().filter_map(|&k| edges[k as usize].label.trace) {
        if members[first..].iter().all(|member| member.trace != trace) {
            members.push(Member { edge, trace });
        }
    }
    Edge { a, b, label }
}

/// Finds the edges that are left when dead ends are removed again and again.
fn prune(points: &[Point], edges: &[Edge], report: &mut NodingReport) -> Vec<bool> {
    let mut degree = vec![0u32; points.len()];
    let mut incident = vec![0; points.len()]; // exclusive or of the incident edges: the edge itself at degree one
    for (k, edge) in edges.iter().enumerate() {
        for v in [edge.a, edge.b] {
            degree[v] += 1;
            incident[v] ^= k;
        }
    }
    let mut kept = vec![true; edges.len()];
    for start in VertexId::all(points.len()) {
        let mut vertex = start;
        while degree[vertex] == 1 {
            let k: usize = incident[vertex];
            let edge = &edges[k];
            kept[k] = false;
            report.trimmed_edges += 1;
            report.trimmed_length += length(points, edge);
            for v in [edge.a, edge.b] {
                degree[v] -= 1;
                incident[v] ^= k;
            }
            vertex = if edge.a == vertex { edge.b } else { edge.a };
        }
    }
    kept
}

fn length(points: &[Point], edge: &Edge) -> f64 {
    (points[edge.b] - points[edge.a]).norm()
}

/// Keeps the selected edges and the vertices that they use, both in order.
fn compact(points: &[Point], edges: &[Edge], kept: &[bool]) -> (Vec<Point>, Vec<Edge>) {
    let mut edges: Vec<Edge> = edges.iter().zip(kept).filter(|(_, kept)| **kept).map(|(edge, _)| *edge).collect();
    let mut is_used = vec![false; points.len()];
    for edge in &edges {
        is_used[edge.a] = true;
        is_used[edge.b] = true;
    }
    let mut used = Vec::new();
    let mut new = Vec::with_capacity(points.len());
    for (point, is_used) in points.iter().zip(is_used) {
        new.push(VertexId::new(used.len()));
        used.extend(is_used.then_some(*point));
    }
    for edge in &mut edges {
        (edge.a, edge.b) = (new[edge.a], new[edge.b]);
    }
    (used, edges)
}
