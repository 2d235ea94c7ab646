//! The end of a sub-step: velocities, positions, histories, ledger; and the report of its start.

use std::time::Instant;

use enmm::geometry::Vector;
use enmm::internals::contact::ContactState;
use enmm::internals::state::{Ledger, State, Workspace};
use enmm::internals::step::{
    Regime, StepReport, move_supports, potential, settle_contacts, settle_supports, speed_max, stored, strain,
    unbalanced,
};

use super::balance::norm;
use super::choices::{Implicit, Rule};
use super::consistent::push_mass;
use super::motion::kinetic_energy;
use super::step::{ImplicitStep, Inertia};

impl ImplicitStep<'_> {
    /// Ends a sub-step with the forces and positions that the iteration left.
    pub(super) fn implicit_commit(&mut self, implicit: &Implicit, inertia: &Inertia) {
        let clock = Instant::now();
        let mut works = self.implicit_works(implicit, inertia);
        let workspace = &mut *self.workspace;
        for (mean, moved) in workspace.motion.predicted.iter_mut().zip(&self.buffers.moved) {
            *mean = moved / inertia.dt;
        }
        self.settle(inertia.dt);
        works.friction -= self.workspace.outcomes.iter().map(|outcome| outcome.dilation).sum::<f64>();
        self.move_covers(implicit, inertia);
        if let Regime::Dynamic { damping } = self.regime {
            works.damping += self.implicit_damp(implicit, damping, inertia);
        }
        self.state.ledger.add_works(&works, 1.0);
        self.state.dt_last = 0.0;
        self.time += inertia.dt;
        self.workspace.seconds.commit += clock.elapsed().as_secs_f64();
    }

    /// Histories of the contacts and forces of the supports for the next sub-step.
    fn settle(&mut self, dt: f64) {
        let step = self.substep(dt);
        let State { laws, velocity, contacts: histories, counters, support_force, .. } = &mut *self.state;
        let Workspace { motion, frames, selection, contacts, supports, outcomes, .. } = &mut *self.workspace;
        let setting = self.model.contact_setting(laws, frames, selection);
        settle_contacts(setting, &step, [velocity, &motion.predicted], contacts, histories, outcomes, counters);
        settle_supports(&supports.rows, support_force);
        move_supports(self.model, self.state, &step);
    }

    /// Positions, velocities 2Δu/dt − v₀ and accelerations of the end (Eq. 67).
    fn move_covers(&mut self, implicit: &Implicit, inertia: &Inertia) {
        let (state, workspace) = (&mut *self.state, &*self.workspace);
        let buffers = &*self.buffers;
        for i in 0..buffers.moved.len() {
            state.displacement[i] += buffers.moved[i];
            let mean = workspace.motion.predicted[i];
            let velocity = if inertia.rests { mean } else { mean * 2.0 - state.velocity[i] };
            for axis in 0..2 {
                state.velocity[i][axis] = if buffers.held[2 * i + axis] { 0.0 } else { velocity[axis] };
            }
        }
        if implicit.rule == Rule::Trapezoidal && !inertia.rests {
            let accelerations = buffers.moved.iter().zip(&buffers.offset).map(|(u, w)| u * inertia.factor + w);
            state.acceleration.clear();
            state.acceleration.extend(accelerations);
        }
    }

    /// Works of this sub-step (Eq. 71): every force by what its point has moved, the forces of the end by their share.
    fn implicit_works(&mut self, implicit: &Implicit, inertia: &Inertia) -> Ledger {
        let mut works = self.bearing_works(inertia);
        works.external_work += self.load_work(inertia);
        let buffers = &self.buffers;
        let change = buffers.start.internal.iter().zip(&buffers.internal).zip(&buffers.moved);
        let numerical: f64 = change.map(|((before, after), moved)| (before - after).dot(moved)).sum();
        works.damping = (inertia.end - 0.5) * numerical;
        if inertia.rests {
            let buffers = &mut *self.buffers;
            buffers.residual.fill(Vector::zeros());
            for (mass, ids) in implicit.element_mass.iter().zip(&self.model.covers.element_covers) {
                push_mass(mass, *ids, &buffers.moved, &mut buffers.residual);
            }
            let spent: f64 = buffers.residual.iter().zip(&buffers.moved).map(|(p, u)| p.dot(u)).sum();
            works.damping += inertia.factor * spent;
        }
        works
    }

    fn bearing_works(&self, inertia: &Inertia) -> Ledger {
        let workspace = &*self.workspace;
        let buffers = &*self.buffers;
        let mut works = Ledger::default();
        let setting = workspace.setting(self.model, self.state);
        let mean = |after: f64, before: f64| inertia.end * after + (1.0 - inertia.end) * before;
        for (contact, before) in workspace.contacts.iter().zip(&buffers.start.contacts) {
            let [opened, sheared] = contact.relative(setting.boundary, &buffers.moved);
            let shear = mean(contact.history.shear_force, before[1]) * sheared;
            works.contact_work += mean(contact.history.normal_force, before[0]) * opened + shear;
            if contact.history.state == ContactState::Slip {
                let (kept, _) = contact.shear_after(sheared, (contact.gap, contact.history.normal_force), &setting);
                let old = contact.shear_stored();
                works.friction -= shear + 0.5 * (kept * kept - old * old) / contact.stiffness[1];
            }
        }
        for (row, before) in workspace.supports.rows.iter().zip(&buffers.start.supports) {
            let support = &self.model.supports[row.support as usize];
            let is_moved = self.model.fixities[support.fix as usize].is_moved();
            let work = if is_moved { &mut works.external_work } else { &mut works.support_work };
            *work += mean(row.force, *before) * support.sample(&buffers.moved);
        }
        works
    }

    /// Work of loads, and of gravity beyond what the potential holds.
    fn load_work(&self, inertia: &Inertia) -> f64 {
        let (model, buffers) = (self.model, &self.buffers);
        let mut work = 0.0;
        for (i, moved) in buffers.moved.iter().enumerate() {
            let mut force = buffers.applied[i] * inertia.end;
            if inertia.end < 1.0 {
                force += buffers.start.applied[i] * (1.0 - inertia.end);
            }
            work += (force - model.gravity * model.mass_matrix.row_sum[i]).dot(moved);
        }
        work
    }

    /// Energies and the unbalanced ratio at the start of this sub-step.
    pub(super) fn implicit_report(&mut self, implicit: &Implicit, dt: f64) -> StepReport {
        let model = self.model;
        // The forces out of balance over the applied ones, by the true forces (Eq. 19).
        self.start_balance();
        let applied = norm(&self.buffers.start.applied).max(norm(&self.state.stage_force));
        let unbalanced = unbalanced(norm(&self.buffers.residual), applied);
        let (state, workspace) = (&*self.state, &*self.workspace);
        let mut ledger = state.ledger;
        ledger.kinetic = kinetic_energy(model, implicit, &workspace.mass_matrix, &state.velocity);
        if let Regime::Static { .. } = self.regime {
            ledger.damping -= ledger.kinetic;
        }
        ledger.strain = strain(model, state);
        ledger.potential = potential(model, state);
        ledger.stored = stored(model, state, workspace);
        StepReport {
            time: self.time,
            dt,
            ledger,
            unbalanced,
            // Its matrix brings all blocks to rest together.
            kinetic_of_most: ledger.kinetic,
            locked: self.count_contacts(ContactState::Lock),
            slipping: self.count_contacts(ContactState::Slip),
            penetration_max: workspace.contacts.iter().map(|c| c.penetration()).fold(0.0, f64::max),
            speed_max: speed_max(model, state),
        }
    }
}
