//! Nodes and sides of two boundaries of the same rock by their places.

use crate::contact::{Boundary, EdgeId, NodeId, SideId};
use crate::cover::BlockId;
use crate::geometry::{Point, TraceId, Vector};

/// Cosine above which two directions of a boundary are the same: edges of a micrometre have directions within it.
const ALONG: f64 = 0.999_999;

/// What tells a point of a boundary from others at the same place: its block, the ways there and on, and their joints.
#[derive(Clone, Copy)]
struct Place {
    block: BlockId,
    at: Point,
    ways: [Vector; 2],
    traces: [Option<TraceId>; 2],
}

impl Place {
    fn new(boundary: &Boundary, at: EdgeId, edges: [EdgeId; 2]) -> Self {
        let way = |edge: EdgeId| boundary.reference[boundary.after(edge)] - boundary.reference[edge];
        Self {
            block: boundary.block[at],
            at: boundary.reference[at],
            ways: edges.map(|edge| way(edge).normalize()),
            traces: edges.map(|edge| boundary.trace[edge]),
        }
    }

    /// The place before the cuts, where blocks have these parents.
    fn of_parent(self, parents: &[BlockId]) -> Self {
        Self { block: parents[self.block], ..self }
    }

    fn is_same(&self, other: &Self, tolerance: f64) -> bool {
        let same_way = |k: usize| self.ways[k].dot(&other.ways[k]) >= ALONG;
        self.block == other.block
            && (self.at - other.at).norm() <= tolerance
            && same_way(0)
            && same_way(1)
            && self.traces == other.traces
    }
}

/// Places in the order of block and x, to find them.
struct Places(Vec<(Place, usize)>);

impl Places {
    fn new(places: impl Iterator<Item = Place>) -> Self {
        let mut places: Vec<(Place, usize)> = places.zip(0..).collect();
        places.sort_by(|(a, _), (b, _)| a.block.cmp(&b.block).then(a.at.x.total_cmp(&b.at.x)));
        Self(places)
    }

    /// Indices of those that are the same as one.
    fn like(&self, place: Place, tolerance: f64) -> impl Iterator<Item = usize> {
        let key = |x: f64| self.0.partition_point(|(other, _)| (other.block, other.at.x) < (place.block, x));
        let near = &self.0[key(place.at.x - tolerance)..];
        let near = near.iter().take_while(move |(o, _)| o.block == place.block && o.at.x <= place.at.x + tolerance);
        near.filter(move |(other, _)| other.is_same(&place, tolerance)).map(|(_, k)| *k)
    }
}

/// The node `old` that each node `new` was.
pub fn nodes(old: &Boundary, new: &Boundary, parents: &[BlockId], tolerance: f64) -> Vec<Option<NodeId>> {
    let place = |boundary: &Boundary, node: NodeId| {
        Place::new(boundary, boundary.nodes.point[node], boundary.edges_of_node(node))
    };
    let places = Places::new(NodeId::all(old.node_count()).map(|node| place(old, node)));
    let of = |node| places.like(place(new, node).of_parent(parents), tolerance).next().map(NodeId::new);
    NodeId::all(new.node_count()).map(of).collect()
}

/// The side `old` that each side `new` was, with both of its ends.
pub fn sides(old: &Boundary, new: &Boundary, parents: &[BlockId], tolerance: f64) -> Vec<Option<SideId>> {
    let ends = |boundary: &Boundary, side: SideId| {
        let [start, end] = boundary.sides.ends[side];
        [start, end].map(|end| Place::new(boundary, end.point, [end.edge, end.edge]))
    };
    let all = || SideId::all(old.sides.ends.len());
    let places = Places::new(all().map(|side| ends(old, side)[0]));
    let of = |side| {
        let [start, end] = ends(new, side).map(|place| place.of_parent(parents));
        let mut like = places.like(start, tolerance).map(SideId::new);
        like.find(|&was| ends(old, was)[1].is_same(&end, tolerance))
    };
    SideId::all(new.sides.ends.len()).map(of).collect()
}
