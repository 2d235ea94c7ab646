//! Event mode (FMI 3): inputs that are set there jump, also where inputs are interpolated.

use crate::log::Status;
use crate::phase::{Call, Phase};
use crate::values::inputs_of;

use super::{Failure, Instance};

impl Instance {
    /// enterEventMode.
    pub fn enter_event_mode(&mut self) -> Status {
        let used = if self.event_mode { Ok(()) } else { Err("eventModeUsed was false: set it to true".to_owned()) };
        let outcome = self.allow(Call::EnterEvent).and(used);
        if outcome.is_ok() {
            self.phase = Phase::Event;
        }
        self.end(outcome)
    }

    /// enterStepMode.
    pub fn enter_step_mode(&mut self) -> Status {
        let outcome = self.allow(Call::Event);
        if outcome.is_ok() {
            self.phase = Phase::Step;
        }
        self.end(outcome)
    }

    /// Makes inputs that were just set jump if this is event mode.
    pub(super) fn jump_in_event_mode(&mut self, references: &[u32]) -> Result<(), Failure> {
        if self.phase != Phase::Event {
            return Ok(());
        }
        let blocks = self.model.inputs().block_force.len();
        let quantities = references.iter().filter_map(|&reference| Some(self.table.get(reference)?.quantity));
        let mut inputs: Vec<_> = quantities.flat_map(|quantity| inputs_of(quantity, blocks)).collect();
        inputs.sort_unstable();
        inputs.dedup();
        inputs.into_iter().try_for_each(|input| self.model.jump_of(input)).map_err(|error| error.to_string())
    }
}
