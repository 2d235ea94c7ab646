//! Free-field columns, which move beside the model.

use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::mechanics::{ColumnDrive, ColumnState, Foot};
use crate::state::{Model, State};

use super::{DECAY_MAX, Regime, Substep, records};

/// Velocities (m/s) of the free-field columns after a sub-step.
pub(super) fn kick_columns(model: &Model, state: &State, step: &Substep, velocities: &mut [Vec<Vector>]) {
    let Substep { regime: Regime::Dynamic { damping }, window, dt, time, .. } = *step else { return };
    let kick = window.to - window.from;
    let host = state.drive.base_acceleration(state.drive.share(time));
    let acceleration = -(host + records::base_motion(model, step.regime, state, window));
    for (k, column) in model.columns.iter().enumerate() {
        let wave = match column.foot {
            Foot::Rigid => Vector::zeros(),
            Foot::Quiet(quiet) => records::wave(model, step.regime, state, window, quiet),
        };
        let drive = ColumnDrive { acceleration, wave, kick };
        let decay = |block: BlockId| libm::exp(-(damping * dt * model.block_frequency[block]).min(DECAY_MAX));
        column.kick(&state.columns[k], &drive, decay, &mut velocities[k]);
    }
}

/// Moves the free-field columns to the end of a sub-step.
pub(super) fn move_columns(step: &Substep, velocities: &[Vec<Vector>], columns: &mut [ColumnState]) {
    if !matches!(step.regime, Regime::Dynamic { .. }) {
        return;
    }
    for (column, velocity) in columns.iter_mut().zip(velocities) {
        column.velocity.copy_from_slice(velocity);
        column.displacement.iter_mut().zip(velocity).for_each(|(u, v)| *u += v * step.dt);
    }
}
