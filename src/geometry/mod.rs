//! Points, exact predicates, loops, planar arrangement and the joint sets that cut it.
//!
//! Knows the plane: coordinates in metres, angles in radians, tolerances in metres. Must not know rock, covers, stress,
//! time or files; a label carries ids whose meaning belongs to the caller.

mod arrangement;
mod edge_cells;
pub mod ends;
mod error;
mod faces;
pub(crate) mod grid;
pub(crate) mod id;
pub mod joint_set;
pub mod loops;
mod noder;
mod planar_map;
pub mod polygon;
pub mod segment;
pub mod trace;
mod work;

pub use arrangement::{arrange, arrange_within};
pub use error::GeometryError;
pub(crate) use id::id;
pub use planar_map::{
    Arrangement, Edge, Face, FaceId, HalfEdgeId, Label, MeshEdgeId, NodingReport, Segment, TraceId, TraceLength,
    VertexId,
};

/// A position in the plane (m).
pub type Point = nalgebra::Vector2<f64>;
/// A direction, a displacement, a velocity or a force in the plane.
pub type Vector = nalgebra::Vector2<f64>;

/// Returns twice the signed area of the triangle `a`, `b`, `c`; its sign is exact, positive counter-clockwise.
#[inline]
pub fn orientation(a: Point, b: Point, c: Point) -> f64 {
    let coord = |p: Point| robust::Coord { x: p.x, y: p.y };
    robust::orient2d(coord(a), coord(b), coord(c))
}

/// Returns the third component of the cross product `a` × `b`.
#[inline]
pub fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}
