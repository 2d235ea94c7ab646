//! One step: sub-steps that are cut until they settle.

use std::any::Any;
use std::time::Instant;

use enmm::contact::VertexEdge;
use enmm::geometry::Vector;
use enmm::mechanics::MassMatrix;
use enmm::state::{Buffers, Model, State, Workspace};
use enmm::step::{Integrator, Regime, Step, StepReport, Window, acceleration, base_motion, push_forces, ramp};

use super::buffers::ImplicitBuffers;
use super::choices::{Implicit, Rule};
use super::motion::{self, kinetic_energy};
use super::substep::{CUT, Inertia, Substep};

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
            &mut buffers.applied_before,
            &mut buffers.internal,
            &mut buffers.internal_before,
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

    fn cover(&self, step: &mut Step, dt: f64) -> StepReport {
        with_buffers(step, |mut substep| substep.implicit_interval(self, dt))
    }

    fn begin(&self, step: &mut Step, dt: f64) -> StepReport {
        with_buffers(step, |mut substep| substep.implicit_begin(self, dt))
    }

    fn find_contacts(&self, step: &mut Step, dt: f64) {
        with_buffers(step, |mut substep| substep.implicit_contacts(dt));
    }

    fn each_contact(&self, step: &mut Step, dt: f64, see: &mut dyn FnMut(&VertexEdge)) {
        with_buffers(step, |mut substep| substep.implicit_contacts(dt));
        step.workspace.contacts.iter().for_each(see);
    }

    fn kinetic(&self, model: &Model, mass_matrix: &MassMatrix, _: &[Vector], velocity: &[Vector]) -> f64 {
        kinetic_energy(model, self, mass_matrix, velocity)
    }
}

/// Works on a step with the buffers that its workspace keeps.
fn with_buffers<R>(step: &mut Step, work: impl FnOnce(Substep) -> R) -> R {
    let mut buffers = taken(step.workspace);
    let result = work(Substep { step, buffers: &mut buffers });
    step.workspace.of_integrator = Some(buffers);
    result
}

/// The buffers, out of the workspace; empty ones where there are none.
fn taken(workspace: &mut Workspace) -> Box<ImplicitBuffers> {
    let kept = workspace.of_integrator.take().map(|buffers: Box<dyn Buffers>| buffers as Box<dyn Any>);
    kept.and_then(|buffers| buffers.downcast().ok()).unwrap_or_default()
}

impl Substep<'_, '_> {
    fn inertia<'a>(&mut self, implicit: &'a Implicit, dt: f64) -> Inertia<'a> {
        let (factor, end, rests) = match (self.step.regime, implicit.rule) {
            (Regime::Static { .. }, _) => (self.static_inertia(dt), 1.0, true),
            (Regime::Dynamic { .. }, Rule::Constant) => (2.0 / (dt * dt), 1.0, false),
            (Regime::Dynamic { .. }, Rule::Trapezoidal) => (4.0 / (dt * dt), 0.5, false),
        };
        Inertia { element_mass: &implicit.element_mass, dt, factor, end, rests }
    }

    /// Inertia over displacement (1/s²) of a static sub-step (Eq. 72): that of a step from rest over a time that grows
    /// while sub-steps settle easily and is cut when one does not.
    fn static_inertia(&mut self, dt: f64) -> f64 {
        let stretch = &mut self.step.state.static_stretch;
        if *stretch == 0.0 {
            *stretch = 1.0;
        }
        2.0 / (*stretch * dt).powi(2)
    }
}

impl Substep<'_, '_> {
    /// Covers `dt` (s) by sub-steps: one that does not settle is cut, and the rest follows.
    fn implicit_interval(&mut self, implicit: &Implicit, dt: f64) -> StepReport {
        let (mut left, mut part, mut cuts) = (dt, dt, 0);
        let mut first = None;
        loop {
            let report = self.implicit_begin(implicit, part);
            first.get_or_insert(report);
            self.step.report = false;
            let inertia = self.inertia(implicit, part);
            let settled = self.implicit_open_close(implicit, &inertia);
            if !settled && cuts < CUTS_MAX {
                self.step.state.counters.halved += 1;
                cuts += 1;
                if !inertia.rests {
                    part *= CUT;
                }
                continue;
            }
            self.step.state.counters.unsettled += u64::from(!settled);
            self.implicit_commit(implicit, &inertia);
            left -= part;
            if left <= 1e-9 * dt || self.step.singular {
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
        let first = self.step.state.stage_step == 0
            && self.step.state.part == 0.0
            && self.step.time == self.step.state.stage_start;
        let loaded_at_once = first && self.step.regime == Regime::Static { ramp: 0.0 };
        self.implicit_loads(self.step.report || loaded_at_once || implicit.rule == Rule::Trapezoidal, dt);
        self.implicit_internal();
        let buffers = &mut self.buffers;
        buffers.internal_before.copy_from_slice(&buffers.internal);
        if loaded_at_once {
            self.start_balance();
            self.step.state.stage_force.copy_from_slice(&self.buffers.residual);
        }
        let trapezoidal = implicit.rule == Rule::Trapezoidal && matches!(self.step.regime, Regime::Dynamic { .. });
        if trapezoidal && self.step.state.acceleration.is_empty() {
            self.implicit_start_acceleration(implicit);
        }
        self.step.workspace.seconds.elements += clock.elapsed().as_secs_f64();
        if self.step.report { self.implicit_report(implicit, dt) } else { StepReport::default() }
    }

    /// Contacts that take part in a sub-step of `dt` (s), with the forces of the last one.
    fn implicit_contacts(&mut self, dt: f64) {
        let searches = self.step.state.counters.searches;
        self.step.locate();
        self.step.search();
        if self.step.state.counters.searches != searches {
            self.buffers.matrix.clear();
        }
        let workspace = &mut *self.step.workspace;
        workspace.speed_max = self.step.state.velocity.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt();
        let (rule, size) = (&self.step.model.entrance, self.step.model.covers.mesh.size);
        let reach = rule.reach * size + REACH_STEPS * dt * workspace.speed_max;
        self.step.entrance(reach.min(rule.cutoff * size), 0.0);
        self.step.load_supports(self.step.times(dt));
        let buffers = &mut self.buffers;
        buffers.forces_before.clear();
        let forces = self.step.workspace.contacts.iter().map(|c| [c.history.normal_force, c.history.shear_force]);
        buffers.forces_before.extend(forces);
        buffers.bearing_before.clear();
        buffers.bearing_before.extend(self.step.workspace.rows.iter().map(|row| row.force));
        buffers.moved.fill(Vector::zeros());
    }

    /// Forces of loads and gravity at the end of the sub-step, and at its start where they are needed.
    fn implicit_loads(&mut self, before: bool, dt: f64) {
        let buffers = &mut *self.buffers;
        for (wanted, force, time) in
            [(true, &mut buffers.applied, self.step.time + dt), (before, &mut buffers.applied_before, self.step.time)]
        {
            if !wanted {
                continue;
            }
            let share = ramp(self.step.regime, time - self.step.state.stage_start);
            let whole = Window { from: self.step.time, to: self.step.time + dt };
            let base = base_motion(self.step.model, self.step.regime, self.step.state, whole);
            let pull = acceleration(self.step.model, self.step.state, time) * share - base;
            for (force, mass) in force.iter_mut().zip(&*self.step.model.mass_matrix.row_sum) {
                *force = pull * *mass;
            }
            push_forces(self.step.model, self.step.state, time, share, force);
        }
    }
}
