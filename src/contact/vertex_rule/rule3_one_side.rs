//! Rule 3, one block, one side: of the sides of one block with rock between them that a node is inside, it enters only
//! one, the one that carries force, or else the less deep one.
//!
//! ```text
//!        ┌───────────────                     ●  node                        ╲     ╱
//!      a │  ● node                    ────────┴────── shallow side            ╲ ● ╱  node
//!        │      rock                        rock      (node outside)         a ╲ ╱ b
//!        └───────────────             ─────────────── deep side            rock V rock
//!              b                            (node inside)
//!     inside a and b: a, less deep     faces away from the first one:        a notch: both hold
//!                                      the node is not inside it
//! ```

use crate::contact::{Corner, SideId};

use super::{ContactCandidate, End, VertexRule};

impl VertexRule<'_> {
    /// Rejects sides until the node enters one alone of each block, notches excepted.
    pub(super) fn choose_sides(&self, candidates: &mut [ContactCandidate]) {
        let block = |p: &ContactCandidate| self.boundary.block[p.edge];
        for i in 0..candidates.len() {
            for j in i + 1..candidates.len() {
                let (a, b) = (&candidates[i], &candidates[j]);
                let corner = |end: End| self.boundary.sides.ends[a.side][end as usize].corner;
                let is_notch = self.end_between(a.side, b.side).is_some_and(|end| corner(end) == Corner::Reflex);
                if block(a) != block(b) || is_notch {
                    continue;
                }
                let first_is_deeper = a.gap < b.gap;
                let (deep, shallow) = if first_is_deeper { (a, b) } else { (b, a) };
                if let Some(deep_loses) = self.is_rejected(deep, shallow) {
                    candidates[if deep_loses == first_is_deeper { i } else { j }].accepted = false;
                }
            }
        }
    }

    /// Whether the node does not enter the deeper of two sides (`true`) or the shallower one (`false`); none when both
    /// may stand.
    fn is_rejected(&self, deep: &ContactCandidate, shallow: &ContactCandidate) -> Option<bool> {
        let end = self.end_between(deep.side, shallow.side);
        if end.is_none() && !self.are_opposed(deep, shallow) {
            return None;
        }
        let is_behind = -deep.gap > shallow.gap.abs() + self.tie();
        let deep_loses = if deep.is_held {
            shallow.is_held && shallow.accepted
        } else {
            is_behind && end.is_none() && shallow.gap > 0.0
                || shallow.accepted && (shallow.is_held || shallow.gap <= 0.0)
        };
        let contest = deep.gap <= 0.0 && shallow.gap <= 0.0 && deep.accepted && shallow.accepted;
        (deep_loses || contest).then_some(deep_loses)
    }

    /// Whether two sides that do not meet have rock between them: they face away from each other, and the foot of the
    /// node on the deeper one lies behind the other.
    fn are_opposed(&self, deep: &ContactCandidate, shallow: &ContactCandidate) -> bool {
        let cosine = deep.tangent.dot(&shallow.tangent);
        cosine < -self.constants.opposed_cosine && shallow.gap < deep.gap * cosine
    }

    /// The end of side `s` at which it meets side `t`.
    pub(super) fn end_between(&self, s: SideId, t: SideId) -> Option<End> {
        if self.boundary.sides.next[s] == t {
            Some(End::Finish)
        } else {
            (self.boundary.sides.previous[s] == t).then_some(End::Start)
        }
    }
}
