//! One step: sub-steps that are cut until they settle.

use std::any::Any;
use std::time::Instant;

use enmm::geometry::Vector;
use enmm::internals::contact::VertexEdge;
use enmm::internals::mechanics::MassMatrix;
use enmm::internals::state::{Buffers, Model, State, Workspace};
use enmm::internals::step::{
    Integrator, Reach, Regime, StepInterval, StepOutcome, StepReport, Wanted, Window, acceleration, base_motion,
    delay_friction, find_contacts, load_supports, locate, push_forces, ramp, search,
};

use super::buffers::ImplicitBuffers;
use super::choices::{Implicit, Rule};
use super::motion::{self, kinetic_energy};
use super::step::{CUT, ImplicitStep, Inertia};

/// Most cuts in a row; a sub-step after that is taken as it is, and counted as unsettled.
const CUTS_MAX: u32 = 5;
/// Distance of a contact in reach over the way of the fastest cover in a sub-step.
const REACH_STEPS: f64 = 2.0;

impl Integrator for Implicit {
    /// The matrix gets its pattern in the next step.
    fn prepare(&self, model: &Model, workspace: &mut Workspace) {
        let mut buffers = taken(workspace);
        let mass_matrix = &workspace.mass_matrix;
        let covers = model.covers.cover_count();
        for field in [
            &mut buffers.moved,
            &mut buffers.offset,
            &mut buffers.applied,
            &mut buffers.start.applied,
            &mut buffers.internal,
            &mut buffers.start.internal,
            &mut buffers.residual,
            &mut buffers.field,
        ] {
            field.clear();
            field.resize(covers, Vector::zeros());
        }
        buffers.unknowns.resize(2 * covers, 0.0);
        buffers.held.clear();
        buffers.held.extend(mass_matrix.inverse.iter().flat_map(|inverse| [inverse.x == 0.0, inverse.y == 0.0]));
        buffers.any_held = buffers.held.contains(&true);
        buffers.matrix.clear();
        workspace.of_integrator = Some(buffers);
    }

    fn stop(&self, model: &Model, state: &mut State, stage: u32) {
        if stage > 0 {
            motion::stop(model, self, state);
        }
    }

    fn lightness(&self, _: &Model) -> f64 {
        1.0
    }

    fn cover(
        &self,
        model: &Model,
        state: &mut State,
        workspace: &mut Workspace,
        interval: StepInterval,
    ) -> StepOutcome {
        with_buffers(model, state, workspace, interval, |step| {
            let report = step.implicit_interval(self, interval.dt);
            StepOutcome { report, end: step.time, is_sound: false, is_singular: step.singular }
        })
    }

    fn begin(&self, model: &Model, state: &mut State, workspace: &mut Workspace, interval: StepInterval) -> StepReport {
        with_buffers(model, state, workspace, interval, |step| step.implicit_begin(self, interval.dt))
    }

    fn find_contacts(&self, model: &Model, state: &mut State, workspace: &mut Workspace, interval: StepInterval) {
        with_buffers(model, state, workspace, interval, |step| step.implicit_contacts(interval.dt));
    }

    fn each_contact(
        &self,
        model: &Model,
        state: &mut State,
        workspace: &mut Workspace,
        interval: StepInterval,
        see: &mut dyn FnMut(&VertexEdge),
    ) {
        self.find_contacts(model, state, workspace, interval);
        workspace.contacts.iter().for_each(see);
    }

    fn kinetic(&self, model: &Model, mass_matrix: &MassMatrix, _: &[Vector], velocity: &[Vector]) -> f64 {
        kinetic_energy(model, self, mass_matrix, velocity)
    }
}

/// Works on an interval with the buffers that its workspace keeps.
fn with_buffers<R>(
    model: &Model,
    state: &mut State,
    workspace: &mut Workspace,
    StepInterval { regime, time, wanted, .. }: StepInterval,
    work: impl FnOnce(&mut ImplicitStep) -> R,
) -> R {
    let mut buffers = taken(workspace);
    let report = wanted == Wanted::Report;
    let step = ImplicitStep { model, state, workspace, buffers: &mut buffers, regime, time, report, singular: false };
    let result = work(&mut { step });
    workspace.of_integrator = Some(buffers);
    result
}

/// The buffers, out of the workspace; empty ones where there are none.
fn taken(workspace: &mut Workspace) -> Box<ImplicitBuffers> {
    let kept = workspace.of_integrator.take().map(|buffers: Box<dyn Buffers>| buffers as Box<dyn Any>);
    kept.and_then(|buffers| buffers.downcast().ok()).unwrap_or_default()
}

impl ImplicitStep<'_> {
    fn inertia<'a>(&mut self, implicit: &'a Implicit, dt: f64) -> Inertia<'a> {
        let (factor, end, rests) = match (self.regime, implicit.rule) {
            // That of a step from rest over a time that grows while sub-steps settle easily, and is cut when one does
            // not (Eq. 72).
            (Regime::Static { .. }, _) => {
                let stretch = &mut self.state.static_stretch;
                if *stretch == 0.0 {
                    *stretch = 1.0;
                }
                (2.0 / (*stretch * dt).powi(2), 1.0, true)
            }
            (Regime::Dynamic { .. }, Rule::Constant) => (2.0 / (dt * dt), 1.0, false),
            (Regime::Dynamic { .. }, Rule::Trapezoidal) => (4.0 / (dt * dt), 0.5, false),
        };
        Inertia { element_mass: &implicit.element_mass, dt, factor, end, rests }
    }

    /// Covers `dt` (s) by sub-steps: one that does not settle is cut, and the rest follows.
    fn implicit_interval(&mut self, implicit: &Implicit, dt: f64) -> StepReport {
        let (mut left, mut part, mut cuts) = (dt, dt, 0);
        let mut first = None;
        loop {
            let report = self.implicit_begin(implicit, part);
            first.get_or_insert(report);
            self.report = false;
            let inertia = self.inertia(implicit, part);
            let settled = self.implicit_open_close(implicit, &inertia);
            if !settled && cuts < CUTS_MAX {
                self.state.counters.halved += 1;
                cuts += 1;
                if !inertia.rests {
                    part *= CUT;
                }
                continue;
            }
            self.state.counters.unsettled += u64::from(!settled);
            self.implicit_commit(implicit, &inertia);
            left -= part;
            if left <= 1e-9 * dt || self.singular {
                return first.unwrap_or_default();
            }
            (part, cuts) = (left, 0);
        }
    }

    /// Near pairs, contacts, loads and forces at the start of a sub-step.
    fn implicit_begin(&mut self, implicit: &Implicit, dt: f64) -> StepReport {
        self.implicit_contacts(dt);
        let clock = Instant::now();
        self.implicit_places();
        let first = self.state.stage_step == 0 && self.state.part == 0.0 && self.time == self.state.stage_start;
        let loaded_at_once = first && self.regime == Regime::Static { ramp: 0.0 };
        self.implicit_loads(self.report || loaded_at_once || implicit.rule == Rule::Trapezoidal, dt);
        self.implicit_internal();
        let buffers = &mut self.buffers;
        buffers.start.internal.copy_from_slice(&buffers.internal);
        if loaded_at_once {
            self.start_balance();
            self.state.stage_force.copy_from_slice(&self.buffers.residual);
        }
        let trapezoidal = implicit.rule == Rule::Trapezoidal && matches!(self.regime, Regime::Dynamic { .. });
        if trapezoidal && self.state.acceleration.is_empty() {
            self.implicit_start_acceleration(implicit);
        }
        self.workspace.seconds.elements += clock.elapsed().as_secs_f64();
        if self.report { self.implicit_report(implicit, dt) } else { StepReport::default() }
    }

    /// Contacts that take part in a sub-step of `dt` (s), with the forces of the last one.
    fn implicit_contacts(&mut self, dt: f64) {
        let step = self.substep(dt);
        let (model, state) = (self.model, &mut *self.state);
        let Workspace { mass_matrix, motion, frames, selection, contacts, supports, sweep, seconds, .. } =
            &mut *self.workspace;
        let (searches, clock) = (state.counters.searches, Instant::now());
        locate(model, &state.displacement, frames, step.serial);
        let located = clock.elapsed();
        search(model, state, &mass_matrix.fixed, frames, selection, &mut sweep.open_close, step.serial);
        let searched = clock.elapsed();
        if state.counters.searches != searches {
            self.buffers.matrix.clear();
        }
        motion.speed_max = state.velocity.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt();
        let (rule, size) = (&model.detection, model.covers.mesh.size);
        let gap = rule.reach * size + REACH_STEPS * dt * motion.speed_max;
        let reach = Reach { gap: gap.min(rule.cutoff * size), ahead: 0.0 };
        find_contacts(model, state, &step, reach, frames, selection, contacts);
        delay_friction(model, state, &step, mass_matrix, selection, contacts);
        seconds.search += (searched - located).as_secs_f64();
        seconds.entrance += (clock.elapsed() - searched + located).as_secs_f64();
        load_supports(model, state, &step, motion, &mut supports.rows);
        let buffers = &mut self.buffers;
        buffers.start.contacts.clear();
        let forces = self.workspace.contacts.iter().map(|c| [c.history.normal_force, c.history.shear_force]);
        buffers.start.contacts.extend(forces);
        buffers.start.supports.clear();
        buffers.start.supports.extend(self.workspace.supports.rows.iter().map(|row| row.force));
        buffers.moved.fill(Vector::zeros());
    }

    /// Forces of loads and gravity at the end of the sub-step, and at its start where they are needed.
    fn implicit_loads(&mut self, before: bool, dt: f64) {
        let buffers = &mut *self.buffers;
        for (wanted, force, time) in
            [(true, &mut buffers.applied, self.time + dt), (before, &mut buffers.start.applied, self.time)]
        {
            if !wanted {
                continue;
            }
            let share = ramp(self.regime, time - self.state.stage_start);
            let whole = Window { from: self.time, to: self.time + dt };
            let base = base_motion(self.model, self.regime, self.state, whole);
            let pull = acceleration(self.model, self.state, time) * share - base;
            for (force, mass) in force.iter_mut().zip(&*self.model.mass_matrix.row_sum) {
                *force = pull * *mass;
            }
            push_forces(self.model, self.state, self.regime, time, &mut force[..]);
        }
    }
}
