//! All constants of the geometry of contact: boundary, search, vertex rule, lengths and springs. No case sets them.

/// Constants of contact. Lengths are relative to the mesh size unless stated otherwise.
///
/// They are not settings of a case: tests halve and double each of them, and results stay (theory §5).
#[doc(alias = "tolerance")]
#[doc(alias = "slop")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DetectionRule {
    /// Height of a ledge up to which it holds nothing; a ledge of twice the height holds in full.
    pub ledge: f64,
    /// Upper bound of the compression of springs: a greater depth is no compression.
    pub closure_most: f64,
    /// Sine of the angle up to which two facing sides count as parallel, and by which a neighbour of a node may lie
    /// inside the edge that the node enters: 10°.
    pub flush_sine: f64,
    /// Cosine from which two sides of a block face away from each other, with rock between them: 60°.
    pub opposed_cosine: f64,
    /// Band at the end of a side: a foot within it counts as over the edge, and a contact that carries force there
    /// hands over to the next one.
    pub held_beyond: f64,
    /// Depth from which a new contact starts without force.
    pub deep: f64,
    /// The same depth relative to the thickness of the thinner block; the lesser of both counts.
    pub deep_share: f64,
    /// Distance, relative to the gap, by which the foot of a contact without force may miss an edge where the boundary
    /// bends.
    pub wedge_ratio: f64,
    /// Least length of the solver's own stiffness of a contact in full strength, relative to the mean of the node
    /// segments: a contact at a point is not softer than one of two faces.
    pub stiffness_floor: f64,
    /// Penetration at which the solver's own stiffness has doubled.
    pub hardens: f64,
    /// Distance beyond a corner that counts as the corner.
    pub corner_tolerance: f64,
    /// Difference of two depths below which they count as equal.
    pub tie_tolerance: f64,
    /// Least tributary length, relative to the mean of the node segments: avoids a division by zero.
    pub length_floor: f64,
    /// Least length over which rock crushes: what a corner breaks to.
    pub crush_floor: f64,
    /// Least share of its length that a contact has beside a corner.
    pub share_floor: f64,
    /// Gap within which a contact at rest takes part in a step.
    pub reach: f64,
    /// The same for one that closes: steps of the fastest cover.
    pub reach_steps: f64,
    /// Way of a node against the sides near it up to which its contacts stay as they were found.
    pub stays: f64,
    /// Internal steps after which contacts are found again at all nodes: round-off chooses between equal depths, and
    /// what it chose must not last.
    pub stays_steps: f64,
    /// Distance within which the search pairs nodes and edges.
    pub cutoff: f64,
    /// Turn (rad) from which a boundary point is a corner.
    pub corner_angle: f64,
    /// Turn (rad) from which a boundary point is a node.
    pub kink_angle: f64,
    /// Turn (rad) summed along a side at which the side ends.
    pub side_turn: f64,
    /// Distance from an existing boundary point, relative to the distance of nodes, within which a node lies on it.
    pub node_snap: f64,
}

/// Difference of lengths (relative) and of turns (rad) that is round-off. Derived: far above it, below `kink_angle`.
pub const BOUNDARY_ROUND_OFF: f64 = 1e-6;
/// Relative difference of squared distances that is round-off at most. Derived: 4000 times the precision of a number.
pub const SQUARES_ROUND_OFF: f64 = 1e-12;
/// Share of its length that a corner has at the corner of another side. Derived: that corner is a contact as well.
pub const CORNER_SHARE: f64 = 0.5;

impl Default for DetectionRule {
    fn default() -> Self {
        Self {
            ledge: 1e-3,
            closure_most: 0.02,
            flush_sine: 0.17,
            opposed_cosine: 0.5,
            held_beyond: 1e-3,
            deep: 3e-3,
            deep_share: 0.25,
            wedge_ratio: 0.5,
            stiffness_floor: 0.5,
            hardens: 3e-3,
            corner_tolerance: 1e-9,
            tie_tolerance: 1e-6,
            length_floor: 1e-9,
            crush_floor: 0.02,
            share_floor: 1e-3,
            reach: 0.005,
            reach_steps: 8.0,
            stays: 5e-4,
            stays_steps: 10.0,
            cutoff: 0.25,
            corner_angle: 0.05,
            kink_angle: 1e-3,
            side_turn: 0.3,
            node_snap: 0.1,
        }
    }
}

impl DetectionRule {
    /// Cosine of the angle up to which faces lie on each other.
    pub fn flush_cosine(&self) -> f64 {
        (1.0 - self.flush_sine * self.flush_sine).sqrt()
    }

    /// Depth (over the mesh size) of the other facet from which springs need no count. They shorten it by
    /// `closure_most` at most, so that it stays deeper than a candidate that is less deep than `closure_most`.
    pub fn clear_depth(&self) -> f64 {
        2.0 * self.closure_most
    }

    /// Distance (over the mesh size) that nodes may move before the next search: two that are `cutoff` apart and
    /// approach by as much each are still apart by a fifth of it, ten times `reach`.
    pub fn skin(&self) -> f64 {
        0.4 * self.cutoff
    }
}
