//! Constants of the vertex rule, and of lengths and springs of contacts. No case sets them.

/// Constants of contact. Lengths are relative to the mesh size unless stated otherwise.
///
/// They are not settings of a case: tests halve and double each of them, and results stay (theory §5).
#[doc(alias = "tolerance")]
#[doc(alias = "slop")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EntranceRule {
    /// Height of a ledge up to which it holds nothing; a ledge of twice the height holds in full.
    pub ledge: f64,
    /// Upper bound of the penetration of contacts: corners that are deeper do not touch by springs alone.
    pub closure_most: f64,
    /// Sine of the angle up to which two facing sides count as parallel, and by which a neighbour of a node may lie
    /// inside the edge that the node enters: 10°.
    pub flush_sine: f64,
    /// Cosine from which two sides of a block face away from each other, with rock between them: 60°.
    pub opposed_cosine: f64,
    /// Distance beyond a corner up to which a contact that carries force is kept.
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
}

impl Default for EntranceRule {
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
        }
    }
}

impl EntranceRule {
    /// Cosine of the angle up to which faces lie on each other.
    pub fn flush_cosine(&self) -> f64 {
        (1.0 - self.flush_sine * self.flush_sine).sqrt()
    }
}
