//! Bonds that soften (theory §7): their damage at the end of a sub-step, and the energy of fracture.

use crate::contact::{BondHistory, ContactHistory, ContactSetting, ContactState, JointLaw, VertexEdge};
use crate::geometry::Vector;
use crate::state::{Counters, Ledger};

use super::Substep;

/// Whether joints of these laws soften, so that the state keeps the damage of their bonds.
pub fn has_bonds(laws: &[JointLaw]) -> bool {
    laws.iter().any(|law| law.softening.is_some())
}

/// Damages the bonds of a sub-step by opening and slip, with the velocities (m/s) of the covers before and after it;
/// returns the energy of fracture, which is no heat of friction.
pub fn settle_bonds(
    setting: ContactSetting,
    step: &Substep,
    after: &[Vector],
    contacts: &[VertexEdge],
    histories: &mut [ContactHistory],
    bonds: &mut Vec<BondHistory>,
    counters: &mut Counters,
) -> Ledger {
    let mut works = Ledger::default();
    bonds.clear();
    for (contact, history) in contacts.iter().zip(histories) {
        let Some(bond) = contact.bond(&setting) else {
            bonds.push(BondHistory::default());
            continue;
        };
        let [opens, _] = contact.relative(setting.boundary, after);
        let slipped = history.slip - contact.history.slip;
        let forces = [contact.history.normal_force, contact.history.shear_force];
        let damaged = bond.after(contact.gap + opens * step.dt, slipped, forces);
        history.state = if slipped > 0.0 { ContactState::Slip } else { ContactState::Lock };
        history.intact = damaged.damage < 1.0;
        counters.broken += if history.intact { 0.0 } else { contact.bonded };
        works.fracture += damaged.loss;
        works.friction -= damaged.of_slip;
        bonds.push(BondHistory { damage: damaged.damage, lengths: [contact.length, contact.bonded], law: contact.law });
    }
    works
}
