//! Works of a sub-step: what the ledger of energies adds up.

use crate::geometry::Vector;
use crate::state::Ledger;

use super::finish::Totals;
use super::{Step, StepTimes, Window};

impl Step<'_> {
    /// Acceleration (m/s²) beyond gravity while forces act: its work is external.
    pub(super) fn extra(&self, window: Window) -> Vector {
        self.acceleration(window) - self.model.gravity
    }

    /// Loads times velocities before and after the step (W/m).
    fn load_power(&self) -> f64 {
        let velocities = self.state.velocity.iter().zip(&self.workspace.predicted);
        self.workspace.load_force.iter().zip(velocities).map(|(f, (before, after))| f.dot(&(before + after))).sum()
    }

    /// Works of this sub-step: each force by the mean of the velocities before and after it (Eq. 18).
    pub(super) fn works(&self, StepTimes { kick, window, .. }: StepTimes, finished: &Totals) -> Ledger {
        let (model, state, workspace) = (self.model, &*self.state, &*self.workspace);
        let mut works = Ledger { damping: finished.damping, ..Ledger::default() };
        for outcome in &workspace.outcomes {
            works.contact_work += outcome.work;
            works.friction -= outcome.friction;
        }
        for row in &workspace.rows {
            let support = &model.supports[row.support as usize];
            let velocity = 0.5 * (support.sample(&state.velocity) + support.sample(&workspace.predicted));
            let work = if support.is_dashpot() { &mut works.radiation } else { &mut works.support_work };
            *work += row.force * velocity * kick;
        }
        for row in &workspace.bolts {
            let velocity = row.pair.difference(&state.velocity) + row.pair.difference(&workspace.predicted);
            works.bolt_work -= row.force * velocity.dot(&row.direction) * (0.5 * kick);
        }
        works.external_work += 0.5 * kick * (self.extra(window).dot(&finished.row_sum) + self.load_power());
        works
    }
}
