//! The first half of a step: forces without contact, damping and kick.

use std::time::Instant;

use crate::geometry::Vector;
use crate::mechanics::Damping;
use crate::state::Workspace;

use super::kick::{Kick, KickOut};
use super::{DECAY_MAX, Regime, Step, StepTimes, Window, applied, blocks, chunk_runs, ramp, records, yielding};

impl Step<'_> {
    /// Plastic strain at the current displacements.
    pub(super) fn yield_rock(&mut self) {
        let clock = Instant::now();
        yielding::update(self.model, self.state, self.workspace, self.time);
        self.workspace.seconds.elements += clock.elapsed().as_secs_f64();
    }

    /// Internal forces, loads and the kick of every block without contact forces.
    pub(super) fn predict(&mut self, times: StepTimes) {
        let clock = Instant::now();
        self.load();
        self.damping = self.damping_of(times.dt);
        let (acceleration, grain) = (self.acceleration(times.window), chunk_runs::grain(self.workspace.serial));
        self.damp_blocks();
        let Workspace { mass_matrix, predicted, motion, start, sums, load_force, damping, movable, exposed, .. } =
            &mut *self.workspace;
        let kick = Kick {
            model: self.model,
            state: &*self.state,
            mass_matrix,
            acceleration,
            damping,
            movable,
            exposed,
            kick: times.kick,
            grain,
            load_force,
        };
        kick.run(&mut KickOut { predicted, motion, start, sums });
        self.workspace.speed_max = self.workspace.sums.iter().map(|s| s.fastest).fold(0.0, f64::max).sqrt();
        self.kick_columns(times);
        for (spin, motion) in self.workspace.mass_matrix.spin.iter_mut().zip(&self.workspace.motion) {
            *spin = motion.spin;
        }
        self.workspace.seconds.elements += clock.elapsed().as_secs_f64();
    }

    /// Damping of every block, when the step or the masses are no longer those of the step before.
    fn damp_blocks(&mut self) {
        let (model, damping) = (self.model, self.damping);
        let Workspace { mass_matrix, damping: of_blocks, damping_of, .. } = &mut *self.workspace;
        if *damping_of != Some(damping) {
            *damping_of = Some(damping);
            let blocks = model.covers.blocks();
            of_blocks.clear();
            of_blocks.extend(blocks.map(|block| blocks::block_damping(model, mass_matrix, damping, block)));
        }
    }

    /// Forces of loads, when there are any.
    fn load(&mut self) {
        let (model, state, workspace) = (self.model, &*self.state, &mut *self.workspace);
        workspace.load_force.clear();
        if applied::pushes(model, state) {
            workspace.load_force.resize(model.covers.cover_count(), Vector::zeros());
            let ramp = ramp(self.regime, self.time - state.stage_start);
            applied::push_forces(model, state, self.time, ramp, &mut workspace.load_force);
        }
    }

    /// Acceleration of all rock (m/s²) while forces act.
    pub(super) fn acceleration(&self, window: Window) -> Vector {
        let base = records::base_motion(self.model, self.regime, self.state, window);
        applied::acceleration(self.model, self.state, self.time) * self.ramp() - base
    }

    /// Share of gravity that acts at this time.
    pub(super) fn ramp(&self) -> f64 {
        ramp(self.regime, self.time - self.state.stage_start)
    }

    /// Damping of a step of `dt` (s) (Eqs. 11, 12).
    pub(super) fn damping_of(&self, dt: f64) -> Damping {
        match self.regime {
            Regime::Dynamic { damping } => Damping::Deformation(damping * dt),
            Regime::Static { .. } => {
                let (mut work, mut inertia) = (0.0, 0.0);
                let state = &*self.state;
                for i in 0..state.displacement.len() {
                    let moved = state.displacement[i] - state.stage_displacement[i];
                    work += state.stage_force[i].dot(&moved);
                    inertia += self.model.mass_matrix.mass[i] * moved.norm_squared();
                }
                let rate = 2.0 * (self.ramp() * work.max(0.0) / inertia.max(f64::MIN_POSITIVE)).sqrt();
                Damping::Mass(libm::exp(-(rate * dt).min(DECAY_MAX)))
            }
        }
    }
}
