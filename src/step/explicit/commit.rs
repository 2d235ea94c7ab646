//! The end of a sub-step: velocities, positions, contact histories and the ledger.

use std::time::Instant;

use crate::contact::ContactState;
use crate::geometry::Vector;
use crate::mechanics;
use crate::state::{Ledger, Workspace};

use super::finish::{Finish, Finished, Totals};
use super::{Regime, Step, StepReport, StepTimes, blocks, chunk_runs, guard, report};

impl Step<'_> {
    /// Ends a sub-step; returns the report of its start when one is wanted.
    pub(super) fn commit(&mut self, times: StepTimes) -> StepReport {
        let StepTimes { dt, .. } = times;
        let clock = Instant::now();
        let totals = self.finish(times);
        self.settle_contacts(times);
        let works = self.works(times, &totals);
        let report = if self.report { self.report(times, &works) } else { StepReport::default() };
        self.capture_stage_force(times.kick);
        self.commit_columns(dt);
        if self.report {
            self.drift(dt);
        }
        self.turn(dt);
        let state = &mut *self.state;
        for row in &self.workspace.bolts {
            let segment = &self.model.bolts[row.segment as usize];
            let bolt = &mut state.bolts[row.segment as usize];
            let length = segment.span(&self.model.covers.star_position, &state.displacement).norm();
            *bolt = segment.after(bolt, length, row.force);
        }
        std::mem::swap(&mut state.velocity, &mut self.workspace.predicted);
        state.ledger.add_works(&works, 1.0);
        state.dt_last = dt;
        self.time += dt;
        self.workspace.seconds.commit += clock.elapsed().as_secs_f64();
        report
    }

    /// Adds what the impulses of all contacts give to every cover (Eq. 17); moves the covers unless a report wants the
    /// positions before.
    fn finish(&mut self, StepTimes { dt, window, .. }: StepTimes) -> Totals {
        let is_loaded = self.extra(window) != Vector::zeros();
        let (model, state) = (self.model, &mut *self.state);
        let Workspace {
            mass_matrix,
            predicted,
            increment,
            motion,
            start,
            push,
            sums,
            serial,
            damping,
            movable,
            exposed,
            ..
        } = &mut *self.workspace;
        let finish = Finish {
            model,
            mass_matrix,
            before: &state.velocity,
            motion,
            start,
            push,
            increment,
            damping,
            movable,
            exposed,
            moves_for: if self.report { 0.0 } else { dt },
            is_loaded,
            grain: chunk_runs::grain(*serial),
        };
        let displacement = &mut state.displacement;
        let totals = finish.run(Finished { velocity: predicted, displacement, sums });
        self.is_sound = totals.squares.is_finite() && totals.fastest <= guard::speed_limit(model).powi(2);
        totals
    }

    /// Moves the covers with the final velocities after a report.
    fn drift(&mut self, dt: f64) {
        for (u, v) in self.state.displacement.iter_mut().zip(&self.workspace.predicted) {
            *u += v * dt;
        }
        self.workspace.sums.iter_mut().for_each(|sums| sums.is_near = false);
    }

    /// Changes of the velocities (m/s) of each cover by all forces, cover by cover: what is more than damping leaves.
    fn each_change(&mut self, mut see: impl FnMut(usize, Vector)) {
        let (model, state) = (self.model, &*self.state);
        let Workspace { mass_matrix, damped, predicted, .. } = &mut *self.workspace;
        for block in model.covers.blocks() {
            let own = model.covers.covers_of(block);
            damped.clear();
            damped.resize(own.len(), Vector::zeros());
            if !mass_matrix.fixed[block] {
                let covers = report::block_covers(model, mass_matrix, &state.displacement, &state.velocity, block);
                mechanics::damp(&covers, blocks::block_damping(model, mass_matrix, self.damping, block), damped);
            }
            own.zip(&*damped).for_each(|(i, damped)| see(i, predicted[i] - damped));
        }
    }

    /// Energies at the start of this sub-step and the unbalanced ratio.
    fn report(&mut self, times: StepTimes, works: &Ledger) -> StepReport {
        let unbalanced = self.unbalanced(times);
        let (model, state, workspace) = (self.model, &*self.state, &*self.workspace);
        let kinetic =
            |velocity: &[Vector]| report::kinetic(model, &workspace.mass_matrix, &state.displacement, velocity);
        let mut ledger = state.ledger;
        ledger.add_works(works, 0.5);
        ledger.kinetic = 0.5 * (kinetic(&state.velocity) + kinetic(&workspace.predicted));
        ledger.strain = report::strain(model, state);
        ledger.potential = report::potential(model, state);
        ledger.stored = report::stored(model, state, workspace);
        ledger.bolt_stored = report::bolt_stored(model, state);
        let contacts = workspace.contacts.iter();
        let count = |which: ContactState| contacts.clone().filter(|c| c.history.state == which).count() as u32;
        StepReport {
            time: self.time,
            dt: times.dt,
            ledger,
            unbalanced,
            kinetic_of_most: report::kinetic_of_most(model, &workspace.mass_matrix, state),
            locked: count(ContactState::Lock),
            slipping: count(ContactState::Slip),
            penetration_max: contacts.clone().map(|c| c.penetration()).fold(0.0, f64::max),
            speed_max: report::speed_max(model, state),
        }
    }

    /// ‖m·dv/dt‖ over ‖applied force‖ (Eq. 19).
    fn unbalanced(&mut self, StepTimes { kick, window, .. }: StepTimes) -> f64 {
        let mass_matrix = &self.model.mass_matrix;
        let acceleration = self.acceleration(window);
        let load = |i: usize| self.workspace.load_force.get(i).copied().unwrap_or_default();
        let weights = mass_matrix.row_sum.iter().map(|mass| acceleration * *mass).enumerate();
        let applied: f64 = weights.map(|(i, weight)| (load(i) + weight).norm_squared()).sum();
        let mut net = 0.0;
        self.each_change(|i, change| net += (change * (mass_matrix.mass[i] / kick)).norm_squared());
        let stage: f64 = self.state.stage_force.iter().map(Vector::norm_squared).sum();
        report::unbalanced(net, applied.max(stage)).sqrt()
    }

    /// The forces out of balance in the first step of a static stage that begins under full load; they acted for `kick`
    /// (s).
    fn capture_stage_force(&mut self, kick: f64) {
        if self.state.stage_step > 0 || !matches!(self.regime, Regime::Static { ramp: 0.0 }) {
            return;
        }
        let mass = &self.model.mass_matrix.mass;
        let mut stage_force = std::mem::take(&mut self.state.stage_force);
        self.each_change(|i, change| stage_force[i] = change * (mass[i] / kick));
        self.state.stage_force = stage_force;
    }
}
