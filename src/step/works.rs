//! Works of a sub-step: what the ledger of energies adds up.

use crate::geometry::Vector;
use crate::state::Ledger;

use super::Step;
use super::blocks::Totals;

impl Step<'_> {
    /// Acceleration (m/s²) beyond gravity in a step of `dt` (s): its work is external.
    pub(super) fn extra(&self, dt: f64) -> Vector {
        self.acceleration(dt) - self.model.gravity
    }

    /// Loads times velocities before and after the step (W/m).
    fn load_power(&self) -> f64 {
        if !self.scratch.is_loaded {
            return 0.0;
        }
        let velocities = self.state.velocity.iter().zip(&self.scratch.predicted);
        self.scratch.load_force.iter().zip(velocities).map(|(f, (before, after))| f.dot(&(before + after))).sum()
    }

    /// Works of this sub-step: each force by the mean of the velocities before and after it (Eq. 18).
    pub(super) fn works(&self, dt: f64, finished: &Totals) -> Ledger {
        let (model, state, scratch) = (self.model, &*self.state, &*self.scratch);
        let mut works = Ledger { damping: finished.damping, ..Ledger::default() };
        let kick_dt = 0.5 * (state.dt_last + dt);
        for outcome in &scratch.outcomes {
            works.contact_work += outcome.work;
            works.friction -= outcome.friction;
        }
        for row in &scratch.rows {
            let support = &model.supports[row.support as usize];
            let velocity = 0.5 * (support.sample(&state.velocity) + support.sample(&scratch.predicted));
            let work = if support.is_dashpot() { &mut works.radiation } else { &mut works.support_work };
            *work += row.force * velocity * kick_dt;
        }
        for row in &scratch.bolts {
            let velocity = row.pair.difference(&state.velocity) + row.pair.difference(&scratch.predicted);
            works.bolt_work -= row.force * velocity.dot(&row.direction) * (0.5 * kick_dt);
        }
        works.external_work += 0.5 * kick_dt * (self.extra(dt).dot(&finished.row_sum) + self.load_power());
        works
    }
}
