//! One step of the explicit integrator: [`Step::interval`] is the table of contents.

mod blocks;
mod chunk_runs;
mod columns;
mod commit;
mod finish;
mod kick;
mod predict;
mod touch;
mod turn;
mod works;
mod yielding;

use crate::contact::{SolverReport, VertexEdge};
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;
use crate::state::Model;

use super::integrator::Integrator;
use super::{Regime, Step, StepReport, StepTimes, Window, applied, guard, ramp, records, report};

/// Relative change of force above which an unsettled step is redone in halves (Eq. 16).
const UNSETTLED: f64 = 0.1;
/// Largest decay c·dt of velocities in a step: a factor d before the kick needs (ω dt)² < 2(1 + d), which holds at 0.9
/// of the critical step for d > 0.62.
const DECAY_MAX: f64 = 0.3;
/// Near pairs that are taken together, about, when contacts are only shown.
const PIECE: usize = 1 << 16;
/// Most times that a step is halved.
const HALVINGS_MAX: u32 = 4;

/// The explicit integrator.
pub(super) struct Explicit;

impl Integrator for Explicit {
    fn lightness(&self, model: &Model) -> f64 {
        model.mass_scaling
    }

    fn cover(&self, step: &mut Step, dt: f64) -> StepReport {
        step.interval(dt, 0)
    }

    fn begin(&self, step: &mut Step, dt: f64) -> StepReport {
        step.interval(dt, 0)
    }

    fn find_contacts(&self, step: &mut Step, dt: f64) {
        let times = step.times(dt);
        step.set_out(times);
        step.touch(times);
    }

    fn each_contact(&self, step: &mut Step, dt: f64, see: &mut dyn FnMut(&VertexEdge)) {
        let times = step.times(dt);
        step.set_out(times);
        step.entrance_by_pieces(times, see);
    }

    fn kinetic(&self, model: &Model, mass_matrix: &MassMatrix, displacement: &[Vector], velocity: &[Vector]) -> f64 {
        report::kinetic(model, mass_matrix, displacement, velocity)
    }
}

impl Step<'_> {
    /// Covers `dt` (s) by one sub-step, or by two halves when the iteration does not settle.
    fn interval(&mut self, dt: f64, halvings: u32) -> StepReport {
        let times = self.times(dt);
        self.set_out(times);
        self.touch(times);
        self.answer(times);
        let swept = self.open_close(times);
        if swept.unsettled > UNSETTLED && halvings < HALVINGS_MAX {
            self.state.counters.halved += 1;
            let first = self.interval(0.5 * dt, halvings + 1);
            self.report = false;
            self.interval(0.5 * dt, halvings + 1);
            return first;
        }
        self.count(dt, &swept);
        self.commit(times)
    }

    /// Positions, near pairs, yielding and predicted velocities of a sub-step.
    fn set_out(&mut self, times: StepTimes) {
        self.locate();
        self.search();
        self.yield_rock();
        self.predict(times);
    }

    /// The contacts of a sub-step, found piece by piece: all together they can be larger than the model. The
    /// near pairs of the state are then of no further use.
    fn entrance_by_pieces(&mut self, times: StepTimes, see: &mut dyn FnMut(&VertexEdge)) {
        let all = std::mem::take(&mut self.state.neighbours.pairs);
        let mut rest = all.as_slice();
        while let Some(last) = rest.get(PIECE).or(rest.last()) {
            let (piece, others) = rest.split_at(rest.partition_point(|c| c.node <= last.node));
            self.state.neighbours.pairs.clear();
            self.state.neighbours.pairs.extend_from_slice(piece);
            self.workspace.near_sides.forget();
            self.touch(times);
            self.workspace.contacts.iter().for_each(&mut *see);
            rest = others;
        }
        self.workspace.near_sides.forget();
    }

    fn count(&mut self, dt: f64, swept: &SolverReport) {
        let counters = &mut self.state.counters;
        counters.substeps += 1;
        counters.sweeps += u64::from(swept.sweeps);
        counters.sweeps_max = counters.sweeps_max.max(swept.sweeps);
        counters.unsettled += u64::from(swept.unsettled > self.model.tolerance);
        counters.contacts_solved += swept.contacts_solved;
        counters.dt_min = if counters.dt_min > 0.0 { counters.dt_min.min(dt) } else { dt };
        counters.dt_max = counters.dt_max.max(dt);
    }
}
