//! The planar map: vertices, half-edges and faces, and where each edge comes from.

use super::{Point, id, polygon};

id! {
    /// A joint trace.
    TraceId: optional
}
id! {
    /// An edge of the mesh, as its maker counts them.
    MeshEdgeId: optional
}
id! {
    /// A vertex of an arrangement.
    VertexId: optional
}
id! {
    /// A half-edge of an arrangement: 2e runs along edge e, 2e + 1 against it.
    HalfEdgeId: optional
}
id! {
    /// A face of an arrangement.
    FaceId: optional
}

/// Where an edge comes from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Label {
    /// Change of winding: +1 when rock lies to the left of a→b, -1 to the right, 0 not an outline.
    pub outline: i8,
    /// Joint trace, if any; where traces coincide the lowest index.
    pub trace: Option<TraceId>,
    /// Mesh edge, if any.
    pub mesh: Option<MeshEdgeId>,
    /// Whether a→b runs against the direction of the mesh edge.
    pub mesh_reversed: bool,
}

impl Label {
    /// Labels an outline edge with rock on its left.
    pub const OUTLINE: Self = Self { outline: 1, trace: None, mesh: None, mesh_reversed: false };

    /// Labels a piece of a joint trace.
    pub const fn trace(trace: TraceId) -> Self {
        Self { outline: 0, trace: Some(trace), mesh: None, mesh_reversed: false }
    }

    /// Labels a mesh edge in its own direction.
    pub const fn mesh(mesh: MeshEdgeId) -> Self {
        Self { outline: 0, trace: None, mesh: Some(mesh), mesh_reversed: false }
    }

    /// Returns the label as read from b to a.
    pub const fn reversed(self) -> Self {
        let mesh_reversed = self.mesh_reversed != self.mesh.is_some();
        Self { outline: -self.outline, trace: self.trace, mesh: self.mesh, mesh_reversed }
    }

    /// Whether nothing is left: two outlines that cancel, no trace, no mesh.
    pub(super) const fn is_empty(self) -> bool {
        self.outline == 0 && self.trace.is_none() && self.mesh.is_none()
    }

    /// Adds the label of an edge that coincides and runs the same way.
    pub(super) fn absorb(&mut self, other: Self) {
        self.outline = self.outline.saturating_add(other.outline);
        self.trace = [self.trace, other.trace].into_iter().flatten().min();
        if other.mesh.is_some_and(|mesh| self.mesh.is_none_or(|own| mesh < own)) {
            self.mesh = other.mesh;
            self.mesh_reversed = other.mesh_reversed;
        }
    }
}

/// A straight piece given to [`super::arrange`].
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Segment {
    /// Start (m).
    pub a: Point,
    /// End (m).
    pub b: Point,
    /// Where it comes from.
    pub label: Label,
}

/// An edge of the arrangement; it meets others in its ends only.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Edge {
    /// Start vertex.
    pub a: VertexId,
    /// End vertex.
    pub b: VertexId,
    /// Where it comes from, read from a to b.
    pub label: Label,
}

/// A face: the region between an outer cycle and the cycles inside it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Face {
    /// A half-edge of the outer cycle; none for the unbounded face.
    pub outer: Option<HalfEdgeId>,
    /// A half-edge of each inner cycle.
    pub inner: Vec<HalfEdgeId>,
    /// How often the outlines wind round the face: 1 rock, 0 none.
    pub winding: i32,
}

/// Lengths of one joint trace that were kept and removed.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct TraceLength {
    /// Length before pruning (m), without the parts that lie far outside outline and mesh.
    pub noded: f64,
    /// Length that bounds faces after pruning (m); 0 for a trace that has no effect at all.
    pub kept: f64,
    /// Part of the kept length with rock on both sides (m); 0 for a trace that cuts no rock.
    pub in_rock: f64,
}

/// Changes that the noder made to the input.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct NodingReport {
    /// Snap tolerance (m).
    pub tolerance: f64,
    /// Rounds of splitting and crossing until nothing changed.
    pub passes: usize,
    /// Segment ends that became one with another end at a different position.
    pub merged_vertices: usize,
    /// Dead ends removed.
    pub trimmed_edges: usize,
    /// Length of the dead ends removed (m).
    pub trimmed_length: f64,
    /// Length along which outlines of opposite sense coincide without a trace (m): there two regions of rock are one.
    pub fused_outline_length: f64,
    /// Lengths of each trace.
    pub traces: Vec<TraceLength>,
    /// Pairs of traces that coincide along an edge, lower index first, sorted; the lower one holds the edge.
    pub overlapping_traces: Vec<[TraceId; 2]>,
}

impl HalfEdgeId {
    /// The two half-edges of an edge, along it and against it.
    pub fn both(edge: usize) -> [Self; 2] {
        [Self::new(2 * edge), Self::new(2 * edge + 1)]
    }

    /// The half-edge that runs the other way.
    #[must_use]
    pub const fn twin(self) -> Self {
        Self::new(self.index() ^ 1)
    }

    /// Its edge.
    pub const fn edge(self) -> usize {
        self.index() / 2
    }

    /// Whether it runs along its edge.
    pub const fn runs_along(self) -> bool {
        self.index() & 1 == 0
    }
}

impl FaceId {
    /// The unbounded face.
    pub const UNBOUNDED: Self = Self::new(0);
}

/// A planar subdivision with provenance.
#[derive(Clone, PartialEq, Debug)]
pub struct Arrangement {
    /// Vertices (m), each with at least two edges.
    pub points: Vec<Point>,
    /// Edges.
    pub edges: Vec<Edge>,
    /// Next half-edge round the face on the left of each half-edge.
    pub next: Vec<HalfEdgeId>,
    /// Face on the left of each half-edge.
    pub face: Vec<FaceId>,
    /// Faces; face 0 is the unbounded one.
    pub faces: Vec<Face>,
    /// Report of the noder.
    pub report: NodingReport,
}

impl Arrangement {
    /// Returns the vertex where a half-edge starts.
    pub fn origin(&self, half_edge: HalfEdgeId) -> VertexId {
        let edge = &self.edges[half_edge.edge()];
        if half_edge.runs_along() { edge.a } else { edge.b }
    }

    /// Returns the vertex where a half-edge ends.
    pub fn target(&self, half_edge: HalfEdgeId) -> VertexId {
        self.origin(half_edge.twin())
    }

    /// Returns all half-edges.
    pub fn half_edges(&self) -> impl ExactSizeIterator<Item = HalfEdgeId> + Clone {
        HalfEdgeId::all(2 * self.edges.len())
    }

    /// Returns the label read along a half-edge.
    pub fn label_of(&self, half_edge: HalfEdgeId) -> Label {
        let label = self.edges[half_edge.edge()].label;
        if half_edge.runs_along() { label } else { label.reversed() }
    }

    /// Returns the half-edges round the loop of a half-edge, that one first.
    pub fn cycle(&self, half_edge: HalfEdgeId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        std::iter::successors(Some(half_edge), move |&h| {
            let next = self.next[h];
            (next != half_edge).then_some(next)
        })
    }

    /// Returns one half-edge of each loop of a face: the outer loop, if any, then the inner ones.
    pub fn face_loops(&self, face: FaceId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let face = &self.faces[face];
        face.outer.into_iter().chain(face.inner.iter().copied())
    }

    /// Returns the points round the loop of a half-edge (m).
    pub fn loop_points(&self, half_edge: HalfEdgeId) -> Vec<Point> {
        self.cycle(half_edge).map(|h| self.points[self.origin(h)]).collect()
    }

    /// Whether rock lies on both sides of an edge.
    pub fn in_rock(&self, edge: usize) -> bool {
        HalfEdgeId::both(edge).iter().all(|&h| self.faces[self.face[h]].winding != 0)
    }

    /// Returns the area of a face (m²), holes taken out; negative for the unbounded face.
    pub fn face_area(&self, face: FaceId) -> f64 {
        self.face_loops(face).map(|h| polygon::area(&self.loop_points(h))).sum()
    }
}
