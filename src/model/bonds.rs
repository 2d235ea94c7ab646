//! Joints that soften, such as rock bridges: which hold, and which have broken.

use crate::contact::EdgeId;
use crate::state::{Model, State};

/// State of the bond of a joint.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum BondState {
    /// A joint without a bond.
    #[default]
    None,
    /// The bond has broken.
    Broken,
    /// The bond holds, damaged or not.
    Holds,
}

impl BondState {
    /// Names by number.
    pub const NAMES: [&str; 3] = ["none", "broken", "holds"];

    /// Number in files.
    pub fn number(self) -> u8 {
        self as u8
    }
}

/// State of the bond of each edge of the boundary: it holds as long as a contact on it has strength left.
pub fn bond_states(model: &Model, state: &State) -> Vec<BondState> {
    let boundary = &model.boundary;
    let softens: Vec<bool> = state.laws.iter().map(|law| law.softening.is_some()).collect();
    if !softens.contains(&true) {
        return vec![BondState::None; boundary.len()];
    }
    let law = |edge: EdgeId| boundary.trace[edge].map(|trace| state.law_switch[model.trace_law[trace]]);
    // Before the first step all bonds are whole.
    let start = if state.bonds.is_empty() { BondState::Holds } else { BondState::Broken };
    let of_edge = |edge| if law(edge).is_some_and(|law| softens[law.index()]) { start } else { BondState::None };
    let mut found: Vec<BondState> = boundary.edges().map(of_edge).collect();
    for (contact, bond) in state.held_bonds() {
        let under = boundary.segment(boundary.node_before[contact.edge]);
        for edge in boundary.edges_about(contact.node).chain(under).filter(|&edge| law(edge) == Some(bond.law)) {
            found[edge.index()] = BondState::Holds;
        }
    }
    found
}
