//! Boundary loops of the blocks: joint faces and outline parts, partial cuts included.

use super::{BlockId, ElementId};
use crate::geometry::{Arrangement, HalfEdgeId, Label, Point, TraceId};

/// A straight piece of a block's boundary inside one element; rock lies to its left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryPiece {
    /// Start (m).
    pub a: Point,
    /// End (m).
    pub b: Point,
    /// Element on the left.
    pub element: ElementId,
    /// Joint trace that made it; none on an outline.
    pub trace: Option<TraceId>,
    /// Element on the right; none outside the rock.
    pub opposite: Option<ElementId>,
    /// Whether both sides belong to one block.
    pub partial: bool,
    /// Where contact lays its nodes.
    pub nodes: NodePlaces,
}

/// Where the nodes of contact lie on a piece of boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodePlaces {
    /// At corners and kinks, and evenly between them.
    Even,
    /// At corners and kinks, and at its start alone or nowhere else: where they were before a cut.
    Kept {
        /// Whether there is one at the start.
        at_start: bool,
    },
}

/// Boundary loops stored end to end, ordered by block; rock on the left.
#[derive(Debug, Clone, Default)]
pub struct Outlines {
    /// Pieces, consecutive along each loop.
    pub pieces: Vec<BoundaryPiece>,
    /// First piece of each loop, and the number of pieces at the end.
    pub loop_start: Vec<u32>,
    /// Block of each loop.
    pub loop_block: Vec<BlockId>,
}

/// Whether an edge carries the mesh and nothing that cuts.
pub(super) fn mesh_only(label: &Label) -> bool {
    label.mesh.is_some() && label.trace.is_none() && label.outline == 0
}

impl Outlines {
    /// Number of loops.
    pub fn len(&self) -> usize {
        self.loop_block.len()
    }

    /// Whether there is no loop.
    pub fn is_empty(&self) -> bool {
        self.loop_block.is_empty()
    }

    /// Pieces of a loop.
    pub fn of_loop(&self, k: usize) -> &[BoundaryPiece] {
        &self.pieces[self.loop_start[k] as usize..self.loop_start[k + 1] as usize]
    }

    /// Walks all boundary loops of the elements that `element_of_face` names.
    pub(super) fn trace(
        arrangement: &Arrangement,
        element_of_face: &[Option<ElementId>],
        element_block: &[BlockId],
    ) -> Self {
        let element = |h: HalfEdgeId| element_of_face[arrangement.face[h]];
        let block = |e: ElementId| element_block[e];
        let bounds = |h: HalfEdgeId| Some((block(element(h)?), h)).filter(|_| !mesh_only(&arrangement.label_of(h)));
        let mut starts: Vec<(BlockId, HalfEdgeId)> = arrangement.half_edges().filter_map(bounds).collect();
        starts.sort_unstable();
        let mut seen = vec![false; arrangement.next.len()];
        let mut outlines = Self { loop_start: vec![0], ..Self::default() };
        for (loop_block, start) in starts {
            if seen[start] {
                continue;
            }
            let mut h = start;
            while let (false, Some(own)) = (seen[h], element(h)) {
                seen[h] = true;
                let [a, b] = [h, h.twin()].map(|h| arrangement.points[arrangement.origin(h)]);
                let opposite = element(h.twin());
                let partial = opposite.is_some_and(|other| block(other) == block(own));
                let trace = arrangement.label_of(h).trace.filter(|_| opposite.is_some());
                outlines.pieces.push(BoundaryPiece {
                    a,
                    b,
                    element: own,
                    trace,
                    opposite,
                    partial,
                    nodes: NodePlaces::Even,
                });
                h = next_boundary(arrangement, h);
            }
            outlines.loop_start.push(outlines.pieces.len() as u32);
            outlines.loop_block.push(loop_block);
        }
        outlines
    }
}

/// The boundary half-edge after `h`, turning across mesh-only edges.
fn next_boundary(arrangement: &Arrangement, h: HalfEdgeId) -> HalfEdgeId {
    let mut next = arrangement.next[h];
    while mesh_only(&arrangement.label_of(next)) {
        next = arrangement.next[next.twin()];
    }
    next
}
