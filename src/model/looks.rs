//! Looks of callers at a model since it last changed: each is worked out once.

use std::sync::OnceLock;

use crate::monitor::JointMonitorState;
use crate::state::Ledger;
use crate::step::StepReport;

use super::observe::{BlockState, ContactView};

/// Looks that are kept until the model changes.
#[derive(Debug, Clone, Default)]
pub(super) struct Looks {
    /// The report on the state now, which costs a step.
    pub report: OnceLock<StepReport>,
    /// Energies half an internal step ago.
    pub energies: OnceLock<Ledger>,
    /// States of the blocks.
    pub blocks: OnceLock<Vec<BlockState>>,
    /// Monitors of joints.
    pub joints: OnceLock<Vec<JointMonitorState>>,
    /// Contacts of the last step.
    pub contacts: OnceLock<Vec<ContactView>>,
}

impl Looks {
    /// Forgets all looks, since the state has changed.
    pub fn forget(&mut self) {
        *self = Self::default();
    }
}
