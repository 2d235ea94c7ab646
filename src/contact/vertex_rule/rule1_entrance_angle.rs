//! Rule 1, entrance angle: both neighbours of the node lie outside the edge, up to 0.17 of their distance, and the
//! node's own rock faces the edge.
//!
//! ```text
//!     previous ●           ● next          next ●──────● node             previous ●──────● node
//!               ╲  rock   ╱                  rock above │ previous              rock below ╲ next
//!                ╲       ╱                              ●                                    ●
//!                 ╲     ╱             ────────────────────────────       ────────────────────────────
//!                  ╲   ╱                 one neighbour is inside:            both are outside, but the
//!      ─────────────● node ─────        its side enters, not the node        rock is on the other side
//!             enters                          does not enter                     does not enter
//! ```
//!
//! The rock faces the edge if it is a corner of less than half a turn, or if the way from the previous node to the next
//! one runs against the edge (up to 10°), as the boundaries of two bodies do that lie on each other. The tip of a
//! closed crack faces no edge: there is rock all round it. A block that turns does not end a contact that carries
//! force: its neighbours may then lie inside.

use super::{ContactCandidate, VertexRule, right_of};

impl VertexRule<'_> {
    /// Whether the angle between node and edge lets the node enter.
    pub(super) fn faces_edge(&self, candidate: &ContactCandidate) -> bool {
        let (frame, sine) = (self.frames.node(candidate.node), self.constants.flush_sine);
        let normal = right_of(candidate.tangent);
        let is_outside = |k: usize| frame.to[k].dot(&normal) >= -sine * frame.distance[k];
        let chord = frame.to[1] - frame.to[0];
        let runs_against = || -chord.dot(&candidate.tangent) > -sine * chord.norm();
        let is_crack_tip = || !self.boundary.nodes.convex[candidate.node] && frame.turns_back(sine);
        (candidate.is_held || is_outside(0) && is_outside(1))
            && (frame.is_convex(sine) || runs_against())
            && !is_crack_tip()
    }
}
