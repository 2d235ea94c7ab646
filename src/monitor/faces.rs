//! Faces of blocks that lay on each other at the start, found by their edges.

use crate::contact::{Boundary, EdgeId, Facing, Facings, LawId, NodeId};
use crate::geometry::Point;

/// The joints of a model as it was built: which edges of the boundary face each other.
#[derive(Debug, Clone, Default)]
pub struct Faces {
    /// Pieces, those of a face one after the other.
    pub pieces: Vec<Facing>,
    /// Number of faces.
    pub count: usize,
    /// First of `of_edges` of each edge of the boundary, and their number at the end.
    of_edge_start: Vec<u32>,
    /// Pieces by edge of the boundary.
    of_edges: Vec<u32>,
}

impl Faces {
    /// Finds the faces that lie on each other, from the boundary and the joint traces with their laws.
    pub fn of(boundary: &Boundary, traces: &[(Vec<Point>, LawId)]) -> Self {
        let Facings { pieces, faces, .. } = Facings::of(boundary, traces);
        let mut found = Self { pieces, count: faces, ..Self::default() };
        found.index(boundary.len());
        found
    }

    /// Lists the pieces of each edge.
    fn index(&mut self, edges: usize) {
        let mut on_edge: Vec<(u32, u32)> = Vec::with_capacity(2 * self.pieces.len());
        for (k, piece) in self.pieces.iter().enumerate() {
            on_edge.extend(piece.edges.map(|edge| (edge.number(), k as u32)));
        }
        on_edge.sort_unstable();
        self.of_edge_start = vec![0; edges + 1];
        on_edge.iter().for_each(|&(edge, _)| self.of_edge_start[edge as usize + 1] += 1);
        (0..edges).for_each(|edge| self.of_edge_start[edge + 1] += self.of_edge_start[edge]);
        self.of_edges = on_edge.into_iter().map(|(_, piece)| piece).collect();
    }

    /// The pieces of an edge.
    pub fn on(&self, edge: EdgeId) -> &[u32] {
        let [start, end] = [0, 1].map(|next| self.of_edge_start[edge.index() + next] as usize);
        &self.of_edges[start..end]
    }

    /// The face of a contact between a node and an edge, and whether the edge is on the first block of the face.
    pub fn between(&self, boundary: &Boundary, edge: EdgeId, node: NodeId) -> Option<(usize, bool)> {
        let other = boundary.block[boundary.nodes.point[node]];
        let facing = |edge: EdgeId, block| {
            self.on(edge).iter().find_map(|&piece| {
                let Facing { edges, face, .. } = self.pieces[piece as usize];
                let is_first = edges[0] == edge;
                (boundary.block[edges[usize::from(is_first)]] == block).then_some((face, is_first))
            })
        };
        let beside = || {
            let edges = boundary.edges_of_node(node).into_iter();
            edges.filter_map(|own| facing(own, boundary.block[edge])).map(|(face, is_first)| (face, !is_first)).next()
        };
        facing(edge, other).or_else(beside)
    }
}
