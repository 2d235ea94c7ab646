//! The first half of a step: forces without contact, damping and kick.

use crate::geometry::Vector;
use crate::mechanics::{Damping, MassMatrix};
use crate::state::{ChunkSums, Model, MotionBuffers, State, YieldBuffers};

use super::chunk_runs::{self, ChunkSlices};
use super::kick::Kick;
use super::{DECAY_MAX, Regime, Substep, applied, blocks, ramp, records};

/// Internal forces and the kick of every block, with the forces of loads and without those of contacts.
pub(super) fn predict(
    model: &Model,
    state: &State,
    step: &Substep,
    (load_force, yielding): (&[Vector], &YieldBuffers),
    mass_matrix: &mut MassMatrix,
    motion: &mut MotionBuffers,
    sums: &mut [ChunkSums],
) {
    let MotionBuffers { predicted, blocks, start, damping, movable, exposed, speed_max, .. } = motion;
    let kick = Kick {
        model,
        state,
        mass_matrix,
        acceleration: acceleration(model, state, step),
        damping,
        movable,
        exposed,
        kick: step.kick,
        grain: chunk_runs::grain(step.serial),
        load_force,
        deformations: &yielding.deformations,
        patch_mean: &yielding.averages.patch_mean,
    };
    kick.run(ChunkSlices { velocity: predicted, motion: blocks, start, sums, ..ChunkSlices::default() });
    *speed_max = sums.iter().map(|s| s.fastest).fold(0.0, f64::max).sqrt();
    for (spin, motion) in mass_matrix.spin.iter_mut().zip(blocks) {
        *spin = motion.spin;
    }
}

/// Damping of every block, when the step or the masses are no longer those of the step before.
pub(super) fn damp(model: &Model, state: &State, step: &Substep, mass_matrix: &MassMatrix, motion: &mut MotionBuffers) {
    let damping = damping_of(model, state, step);
    if motion.damping_of != Some(damping) {
        motion.damping_of = Some(damping);
        let blocks = model.covers.blocks();
        motion.damping.clear();
        motion.damping.extend(blocks.map(|block| blocks::block_damping(model, mass_matrix, damping, block)));
    }
}

/// Forces (N/m) of loads on covers, when there are any.
pub(super) fn load(model: &Model, state: &State, step: &Substep, load_force: &mut Vec<Vector>) {
    load_force.clear();
    if applied::pushes(model, state) {
        load_force.resize(model.covers.cover_count(), Vector::zeros());
        applied::push_forces(model, state, step.time, ramp_of(state, step), load_force);
    }
}

/// Acceleration of all rock (m/s²) while forces act.
pub(super) fn acceleration(model: &Model, state: &State, step: &Substep) -> Vector {
    let base = records::base_motion(model, step.regime, state, step.window);
    applied::acceleration(model, state, step.time) * ramp_of(state, step) - base
}

/// Share of gravity that acts at this time.
fn ramp_of(state: &State, step: &Substep) -> f64 {
    ramp(step.regime, step.time - state.stage_start)
}

/// Damping of a sub-step (Eqs. 11, 12).
fn damping_of(model: &Model, state: &State, step: &Substep) -> Damping {
    match step.regime {
        Regime::Dynamic { damping } => Damping::Deformation(damping * step.dt),
        Regime::Static { .. } => {
            let (mut work, mut inertia) = (0.0, 0.0);
            let moved = state.displacement.iter().zip(&state.stage_displacement).map(|(u, start)| u - start);
            for ((moved, force), mass) in moved.zip(&state.stage_force).zip(model.mass_matrix.mass.iter()) {
                work += force.dot(&moved);
                inertia += mass * moved.norm_squared();
            }
            let rate = 2.0 * (ramp_of(state, step) * work.max(0.0) / inertia.max(f64::MIN_POSITIVE)).sqrt();
            Damping::Mass(libm::exp(-(rate * step.dt).min(DECAY_MAX)))
        }
    }
}
