//! Contacts, supports and bolts of an explicit sub-step: their selection, and the open–close iteration.

use std::time::Instant;

use crate::contact::{Approach, BoltView, OtherConstraints, SolverOptions, SolverReport};
use crate::state::Workspace;

use super::{Regime, Step, StepTimes};

impl Step<'_> {
    /// Gap (m) below which a contact takes part in an explicit step of `dt` (s).
    fn reach(&self, dt: f64) -> f64 {
        let rule = &self.model.entrance;
        rule.reach * self.model.covers.mesh.size + rule.reach_steps * dt * self.workspace.speed_max
    }

    /// Contacts that take part in an explicit sub-step, and how they answer.
    pub(super) fn touch(&mut self, times: StepTimes) {
        self.entrance(self.reach(times.dt), times.dt);
    }

    /// How supports and bolts answer.
    pub(super) fn answer(&mut self, times: StepTimes) {
        let clock = Instant::now();
        self.load_supports(times);
        self.load_bolts();
        self.workspace.seconds.entrance += clock.elapsed().as_secs_f64();
    }

    /// Bolts that carry force in this step.
    fn load_bolts(&mut self) {
        let (model, state, workspace) = (self.model, &*self.state, &mut *self.workspace);
        let view = BoltView {
            star: &model.covers.star_position,
            displacement: &state.displacement,
            predicted: &workspace.predicted,
            mass_matrix: &workspace.mass_matrix,
            motion: &workspace.motion,
        };
        let rows = model.bolts.iter().zip(&state.bolts).enumerate();
        let bearing = rows.filter(|(_, (_, bolt))| bolt.active && !bolt.broken);
        workspace.bolts.clear();
        workspace.bolts.extend(bearing.map(|(k, (segment, bolt))| segment.row(k as u32, bolt, &view)));
    }

    /// Open–close iteration on the predicted velocities.
    pub(super) fn open_close(&mut self, times: StepTimes) -> SolverReport {
        let clock = Instant::now();
        let StepTimes { dt, kick, .. } = times;
        let damping = if let Regime::Dynamic { damping } = self.regime { Some(damping) } else { None };
        let (model, state, workspace) = (self.model, &*self.state, &mut *self.workspace);
        let Workspace {
            open_close,
            near_sides,
            accepted,
            contacts,
            rows,
            bolts,
            increment,
            push,
            mass_matrix,
            motion,
            predicted,
            frames,
            strength,
            serial,
            ..
        } = workspace;
        let (theta, tolerance, sweeps_max) = (model.theta, model.tolerance, model.sweeps_max);
        let options = SolverOptions { dt, kick, theta, tolerance, sweeps_max, serial: *serial };
        let approach = Approach {
            predicted,
            velocity: &state.velocity,
            dt_last: state.dt_last,
            forward: model.theta_in(dt),
            damping,
            setting: model.contact_setting(&state.laws, frames, *strength),
            motion,
        };
        let (near, block_covers) = ((&state.neighbours.pairs[..], &*near_sides), &model.covers.block_covers);
        open_close.arrange(&model.boundary, near, mass_matrix, block_covers, &accepted.near_side);
        let swept = open_close.run(mass_matrix, &options, &approach, contacts, &mut OtherConstraints { rows, bolts });
        open_close.impulses(mass_matrix, increment, push);
        workspace.seconds.sweep += clock.elapsed().as_secs_f64();
        swept
    }
}
