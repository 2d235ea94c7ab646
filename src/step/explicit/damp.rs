//! Damping of the blocks in a sub-step.

use crate::cover::BlockId;
use crate::mechanics::{Damping, MassMatrix};
use crate::state::{Model, MotionBuffers, State};

use super::{DECAY_MAX, Regime, Substep};

/// Damping of every block, when the step or the masses are no longer those of the step before.
pub(super) fn damp(model: &Model, state: &State, step: &Substep, mass_matrix: &MassMatrix, motion: &mut MotionBuffers) {
    let damping = damping_of(model, state, step);
    if motion.damping_of != Some(damping) {
        motion.damping_of = Some(damping);
        let blocks = model.covers.blocks();
        motion.damping.clear();
        motion.damping.extend(blocks.map(|block| block_damping(model, mass_matrix, damping, block)));
    }
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
            let rate = 2.0 * (step.ramp(state) * work.max(0.0) / inertia.max(f64::MIN_POSITIVE)).sqrt();
            Damping::Mass(libm::exp(-(rate * step.dt).min(DECAY_MAX)))
        }
    }
}

/// Damping factor of one block: exp(−2ξπ·cs/√A·dt) relative to its rigid motion; or the common one, of a block that is
/// lighter by the root of that faster (Eq. 76).
fn block_damping(model: &Model, mass_matrix: &MassMatrix, damping: Damping, block: BlockId) -> Damping {
    match damping {
        Damping::Deformation(ratio_dt) if ratio_dt > 0.0 => {
            Damping::Deformation(libm::exp(-(ratio_dt * model.block_frequency[block]).min(DECAY_MAX)))
        }
        Damping::Deformation(_) => Damping::Deformation(1.0),
        Damping::Mass(factor) if mass_matrix.lightness > 1.0 && mass_matrix.is_free(block) => {
            Damping::Mass(libm::pow(factor, mass_matrix.lightness.sqrt()).max(libm::exp(-DECAY_MAX)))
        }
        mass => mass,
    }
}

/// Whether damping takes anything.
pub(super) fn is_damping(damping: Damping) -> bool {
    let (Damping::Deformation(factor) | Damping::Mass(factor)) = damping;
    factor < 1.0
}
