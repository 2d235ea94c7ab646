//! One step of the implicit integrator: Newmark's rule, global stiffness and open–close iteration with
//! refactorisation, on the same covers, contacts and histories as the explicit one.

mod assembly;
mod balance;
mod commit;
mod motion;
mod open_close;

use std::time::Instant;

use crate::contact::VertexEdge;
use crate::geometry::Vector;
use crate::mechanics::MassMatrix;
use crate::state::{Implicit, Model, Rule, State, Workspace};

use self::motion::kinetic_energy;
use super::contacts::{CUTOFF, REACH};
use super::integrator::Integrator;
use super::{Regime, Step, StepReport, Window, applied, ramp, records};

/// Factor on a sub-step that has not settled.
const CUT: f64 = 0.3;
/// Most cuts in a row; a sub-step after that is taken as it is, and counted as unsettled.
const CUTS_MAX: u32 = 5;
/// Distance of a contact in reach over the way of the fastest cover in a sub-step.
const REACH_STEPS: f64 = 2.0;

impl Integrator for Implicit {
    /// The matrix gets its pattern in the next step.
    fn prepare(&self, model: &Model, workspace: &mut Workspace) {
        let Workspace { mass_matrix, implicit: buffers, .. } = workspace;
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
        step.implicit_interval(self, dt)
    }

    fn begin(&self, step: &mut Step, dt: f64) -> StepReport {
        step.implicit_begin(self, dt)
    }

    fn find_contacts(&self, step: &mut Step, dt: f64) {
        step.implicit_contacts(dt);
    }

    fn each_contact(&self, step: &mut Step, dt: f64, see: &mut dyn FnMut(&VertexEdge)) {
        step.implicit_contacts(dt);
        step.workspace.contacts.iter().for_each(see);
    }

    fn kinetic(&self, model: &Model, mass_matrix: &MassMatrix, _: &[Vector], velocity: &[Vector]) -> f64 {
        kinetic_energy(model, self, mass_matrix, velocity)
    }
}

/// How inertia enters a sub-step.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Inertia<'a> {
    /// Consistent mass of each element.
    element_mass: &'a [[f64; 6]],
    /// Length (s).
    dt: f64,
    /// Acceleration over displacement (1/s²): 1/(β·dt²).
    factor: f64,
    /// Share of the forces at the end in the mean that works.
    end: f64,
    /// Whether the sub-step starts from rest.
    rests: bool,
}

impl Step<'_> {
    fn inertia<'a>(&mut self, implicit: &'a Implicit, dt: f64) -> Inertia<'a> {
        let (factor, end, rests) = match (self.regime, implicit.rule) {
            (Regime::Static { .. }, _) => (self.static_inertia(dt), 1.0, true),
            (Regime::Dynamic { .. }, Rule::Constant) => (2.0 / (dt * dt), 1.0, false),
            (Regime::Dynamic { .. }, Rule::Trapezoidal) => (4.0 / (dt * dt), 0.5, false),
        };
        Inertia { element_mass: &implicit.element_mass, dt, factor, end, rests }
    }

    /// Inertia over displacement (1/s²) of a static sub-step (Eq. 72): that of a step from rest over a time that grows
    /// while sub-steps settle easily and is cut when one does not.
    fn static_inertia(&mut self, dt: f64) -> f64 {
        let stretch = &mut self.state.static_stretch;
        if *stretch == 0.0 {
            *stretch = 1.0;
        }
        2.0 / (*stretch * dt).powi(2)
    }
}

impl Step<'_> {
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
        let buffers = &mut self.workspace.implicit;
        buffers.internal_before.copy_from_slice(&buffers.internal);
        if loaded_at_once {
            self.start_balance();
            self.state.stage_force.copy_from_slice(&self.workspace.implicit.residual);
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
        let searches = self.state.counters.searches;
        self.locate();
        self.search();
        if self.state.counters.searches != searches {
            self.workspace.implicit.matrix.clear();
        }
        let workspace = &mut *self.workspace;
        workspace.speed_max = self.state.velocity.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt();
        let reach = REACH * self.model.covers.mesh.size + REACH_STEPS * dt * workspace.speed_max;
        self.entrance(reach.min(CUTOFF * self.model.covers.mesh.size), 0.0);
        self.load_supports(self.times(dt));
        let buffers = &mut self.workspace.implicit;
        buffers.forces_before.clear();
        let forces = self.workspace.contacts.iter().map(|c| [c.history.normal_force, c.history.shear_force]);
        buffers.forces_before.extend(forces);
        buffers.bearing_before.clear();
        buffers.bearing_before.extend(self.workspace.rows.iter().map(|row| row.force));
        buffers.moved.fill(Vector::zeros());
    }

    /// Forces of loads and gravity at the end of the sub-step, and at its start where they are needed.
    fn implicit_loads(&mut self, before: bool, dt: f64) {
        let Workspace { implicit: buffers, .. } = &mut *self.workspace;
        for (wanted, force, time) in
            [(true, &mut buffers.applied, self.time + dt), (before, &mut buffers.applied_before, self.time)]
        {
            if !wanted {
                continue;
            }
            let share = ramp(self.regime, time - self.state.stage_start);
            let whole = Window { from: self.time, to: self.time + dt };
            let base = records::base_motion(self.model, self.regime, self.state, whole);
            let acceleration = applied::acceleration(self.model, self.state, time) * share - base;
            for (force, mass) in force.iter_mut().zip(&*self.model.mass_matrix.row_sum) {
                *force = acceleration * *mass;
            }
            applied::push_forces(self.model, self.state, time, share, force);
        }
    }
}
