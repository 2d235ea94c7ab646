//! Layouts of the structures whose members are rows of the engine's tables of quantities: their order and their types
//! in C. The header is written from them.

use engine::cosimulation::Quantity;
use engine::model::{ENERGIES, Ledger};

/// Counts that have had 32 bits from version 1 on; later ones have 64.
const SHORT_COUNTS: [&str; 7] = [
    "contacts",
    "open_contacts",
    "slipping_contacts",
    "locked_contacts",
    "detached_blocks",
    "slipped_joints",
    "failed_blocks",
];

/// Energies in the order of the first structures; later ones follow in that of their table.
const FIRST_ENERGIES: [&str; 15] = [
    "kinetic",
    "strain",
    "potential",
    "stored",
    "friction",
    "contact_work",
    "support_work",
    "damping",
    "external_work",
    "baseline",
    "contact_dissipation",
    "residual",
    "yielding",
    "bolt_work",
    "radiation",
];

/// Type of a member in C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `double`.
    Real,
    /// `uint32_t`; one that stands alone has a reserved number behind it.
    ShortCount,
    /// `uint64_t`.
    Count,
}

impl Kind {
    /// That of a quantity.
    pub fn of<T>(quantity: &Quantity<T>) -> Self {
        match quantity.is_count {
            false => Self::Real,
            true if SHORT_COUNTS.contains(&quantity.name) => Self::ShortCount,
            true => Self::Count,
        }
    }
}

/// The table of energies in the order of their structure.
pub fn energies() -> impl Iterator<Item = &'static Quantity<Ledger>> {
    let is_first = |quantity: &&Quantity<Ledger>| FIRST_ENERGIES.contains(&quantity.name);
    let first = FIRST_ENERGIES.iter().filter_map(|name| ENERGIES.iter().find(|quantity| quantity.name == *name));
    first.chain(ENERGIES.iter().filter(move |quantity| !is_first(quantity)))
}
