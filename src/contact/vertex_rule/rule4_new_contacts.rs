//! Rule 4, new contacts: a new contact in penetration belongs to the rock that the node is in; a deep one to the
//! nearest side of it.
//!
//! ```text
//!     ────────────────── nearest side                 ╲      ╱
//!        ●  deep node: it enters the nearest side,     ╲    ╱
//!           no other one                          ──────╲──●───── line of a side
//!           rock                                      ╱  ╲╱        below the line, but outside the rock and
//!     ────────────────── another side             rock             beyond another side: it does not enter
//! ```
//!
//! A shallow node may also be beside the rock, round a corner of the side: two tips that cross touch at a point where
//! neither is inside the other. Deep is more than a node moves in a step, beyond the compression of springs that it
//! brings from other sides.

use crate::contact::{EdgeId, NodeId, SideId};
use crate::geometry::segment;

use super::{Boundary, ContactCandidate, VertexRule, right_of};

impl VertexRule<'_> {
    /// Whether a new candidate in penetration cannot be a contact.
    pub(super) fn is_spurious(&self, candidate: &ContactCandidate) -> bool {
        let tie = self.tie();
        if candidate.held.is_some() || candidate.gap >= -tie {
            return false;
        }
        let Boundary { block, nodes, .. } = self.boundary;
        let is_deep = self.is_deep(candidate);
        if block[nodes.point[candidate.node]] == block[candidate.edge] {
            return is_deep;
        }
        let (depth, nearest) = self.depth_in_rock(candidate.node, candidate.edge);
        if is_deep {
            return -candidate.gap > depth + tie;
        }
        let meets = nearest == candidate.side || self.end_between(candidate.side, nearest).is_some();
        depth <= tie && !meets
    }

    /// Whether a candidate is deeper than a node moves in one step, with the springs of the node's other contacts
    /// unloaded: a node that slides from one side to the next brings their compression with it.
    pub(in crate::contact) fn is_deep(&self, candidate: &ContactCandidate) -> bool {
        let Boundary { block, block_thickness, nodes, .. } = self.boundary;
        let blocks = [nodes.point[candidate.node], candidate.edge].map(|point| block[point]);
        let thin = blocks.map(|b| block_thickness[b]).into_iter().fold(f64::INFINITY, f64::min);
        let most = (self.constants.deep * self.size).min(self.constants.deep_share * thin);
        let brought = || self.closure_along(candidate.node, right_of(candidate.tangent), [candidate.side; 2]);
        -candidate.gap > most && -candidate.gap - brought() > most
    }

    /// Depth (m) of a node in the rock within the loop of an edge, 0 outside, and the nearest side of the loop.
    #[cold]
    fn depth_in_rock(&self, node: NodeId, edge: EdgeId) -> (f64, SideId) {
        let p = self.position(node);
        let next = |point: EdgeId| self.boundary.next[point];
        let (mut point, mut area, mut turns, mut nearest) = (edge, 0.0, 0, (f64::INFINITY, edge));
        loop {
            let ends = [point, next(point)].map(|point| self.frames.position(point));
            let [a, b] = ends.map(|end| end - p);
            area += a.perp(&b);
            if (a.y > 0.0) != (b.y > 0.0) && (a.perp(&b) > 0.0) == (b.y > 0.0) {
                turns += if b.y > 0.0 { 1 } else { -1 };
            }
            let distance = segment::distance(p, ends[0], ends[1]);
            if distance < nearest.0 {
                nearest = (distance, point);
            }
            point = next(point);
            if point == edge {
                break;
            }
        }
        let is_inside = turns > 0 || area < 0.0 && turns == 0;
        (if is_inside { nearest.0 } else { 0.0 }, self.boundary.side[nearest.1])
    }
}
