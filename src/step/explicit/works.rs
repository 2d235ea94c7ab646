//! Works of a sub-step: what the ledger of energies adds up.

use crate::geometry::Vector;
use crate::state::{ContactOutcome, Ledger, Model, State, SupportBuffers};

use super::Substep;
use super::kick::acceleration;

/// Acceleration (m/s²) beyond gravity while forces act: its work is external.
pub(super) fn extra(model: &Model, state: &State, step: &Substep) -> Vector {
    acceleration(model, state, step) - model.gravity
}

/// Works of contacts, supports and bolts, those of moved supports as of loads: each force by the mean of the velocities
/// before and after it (Eq. 18).
pub(super) fn contact_works(
    model: &Model,
    kick: f64,
    velocities: [&[Vector]; 2],
    outcomes: &[ContactOutcome],
    supports: &SupportBuffers,
) -> Ledger {
    let [before, after] = velocities;
    let mut works = Ledger::default();
    for outcome in outcomes {
        works.contact_work += outcome.work;
        works.friction += outcome.friction - outcome.dilation;
    }
    for row in &supports.rows {
        let support = &model.supports[row.support as usize];
        let velocity = 0.5 * (support.sample(before) + support.sample(after));
        let is_moved = model.fixities[support.fix as usize].is_moved();
        let work = match support.is_dashpot() {
            true => &mut works.radiation,
            false if is_moved => &mut works.external_work,
            false => &mut works.support_work,
        };
        *work += row.force * velocity * kick;
    }
    for row in &supports.bolts {
        let velocity = row.pair.difference(before) + row.pair.difference(after);
        works.bolts.work -= row.force * velocity.dot(&row.direction) * (0.5 * kick);
    }
    works
}

/// Work (J/m) of loads and of what acts on all rock beyond gravity, given Σ(∫ρw)(v + v') (kg/s) of all covers.
pub(super) fn external_work(
    kick: f64,
    velocities: [&[Vector]; 2],
    (extra, row_sum): (Vector, Vector),
    load_force: &[Vector],
) -> f64 {
    let [before, after] = velocities;
    let pairs = before.iter().zip(after);
    let power: f64 = load_force.iter().zip(pairs).map(|(f, (before, after))| f.dot(&(before + after))).sum();
    0.5 * kick * (extra.dot(&row_sum) + power)
}
