//! Free-field columns, which move beside the model.

use crate::cover::BlockId;
use crate::geometry::Vector;
use crate::mechanics::{ColumnDrive, Foot};

use super::{DECAY_MAX, Regime, Step, StepTimes, records};

impl Step<'_> {
    /// Velocities of the free-field columns after a sub-step.
    pub(super) fn kick_columns(&mut self, StepTimes { dt, window, .. }: StepTimes) {
        let Regime::Dynamic { damping } = self.regime else { return };
        let (model, state) = (self.model, &*self.state);
        let kick = window.to - window.from;
        let host = state.drive.base_acceleration(state.drive.share(self.time));
        let acceleration = -(host + records::base_motion(model, self.regime, state, window));
        for (k, column) in model.columns.iter().enumerate() {
            let wave = match column.foot {
                Foot::Rigid => Vector::zeros(),
                Foot::Quiet(quiet) => records::wave(model, self.regime, state, window, quiet),
            };
            let drive = ColumnDrive { acceleration, wave, kick };
            let decay = |block: BlockId| libm::exp(-(damping * dt * model.block_frequency[block]).min(DECAY_MAX));
            column.kick(&state.columns[k], &drive, decay, &mut self.workspace.columns[k]);
        }
    }

    /// Ends a step of the free-field columns.
    pub(super) fn commit_columns(&mut self, dt: f64) {
        if !matches!(self.regime, Regime::Dynamic { .. }) {
            return;
        }
        for (column, velocity) in self.state.columns.iter_mut().zip(&self.workspace.columns) {
            column.velocity.copy_from_slice(velocity);
            column.displacement.iter_mut().zip(velocity).for_each(|(u, v)| *u += v * dt);
        }
    }
}
