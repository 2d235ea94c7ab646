//! Sums and extremes over the model.

use enmm::model::{Quantity, StepReport};

/// Numbers of the report of a step in a row of `history.csv`, behind the energies.
pub const REPORT_QUANTITIES: [Quantity<StepReport>; 4] = [
    Quantity::new(["unbalanced", "unbalanced_ratio"], "", "Net over applied force", |report| report.unbalanced),
    Quantity::plain("penetration_max", "m", "Largest penetration", |report| report.penetration_max),
    Quantity::count(["locked_contacts", "locked"], "Contacts below their shear limit", |report| {
        f64::from(report.locked)
    }),
    Quantity::count(["slipping_contacts", "slipping"], "Contacts at their shear limit", |report| {
        f64::from(report.slipping)
    }),
];
