//! Sums and extremes over the model.

use enmm::model::{Quantity, StepReport};

/// Numbers of the report of a step in a row of `history.csv`, behind the energies.
pub const REPORT_QUANTITIES: [Quantity<StepReport>; 4] = [
    Quantity::new(["unbalanced", "unbalanced_ratio"], "", "Net over applied force", |report| report.unbalanced),
    Quantity::new(["penetration_max"; 2], "m", "Largest penetration", |report| report.penetration_max),
    count(["locked_contacts", "locked"], "Contacts below their shear limit", |report| f64::from(report.locked)),
    count(["slipping_contacts", "slipping"], "Contacts at their shear limit", |report| f64::from(report.slipping)),
];

const fn count(names: [&'static str; 2], text: &'static str, get: fn(&StepReport) -> f64) -> Quantity<StepReport> {
    Quantity { is_count: true, ..Quantity::new(names, "", text, get) }
}
