//! Events: changes that happened for the first time while the model moved.

use serde::{Deserialize, Serialize};

/// Kind of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum EventKind {
    /// A block that touched others lost its last contact.
    Detached,
    /// A joint slipped.
    Slipped,
    /// A block moved beyond the failure displacement.
    Failed,
}

/// Something that happened for the first time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// What.
    pub kind: EventKind,
    /// Block id, or index of the joint trace; `u32::MAX` for contacts away from joints.
    pub subject: u32,
    /// End of the internal step in which it happened (s).
    pub time: f64,
}

/// Everything that happened in dynamic stages, in order, and what is needed to see the next event.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Events {
    /// The events.
    pub list: Vec<Event>,
    /// Whether each block touched another at the end of the last step.
    pub touching: Vec<bool>,
    /// Blocks that have detached.
    pub detached: Vec<bool>,
    /// Joint traces that have slipped; the last entry stands for contacts away from joints.
    pub slipped: Vec<bool>,
    /// Blocks that have failed.
    pub failed: Vec<bool>,
}

impl Events {
    /// Nothing has happened to so many blocks and joint traces.
    pub fn none(blocks: usize, traces: usize) -> Self {
        Self {
            list: Vec::new(),
            touching: vec![false; blocks],
            detached: vec![false; blocks],
            slipped: vec![false; traces + 1],
            failed: vec![false; blocks],
        }
    }

    /// Copies without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { list, touching, detached, slipped, failed } = other;
        self.list.clone_from(list);
        self.touching.clone_from(touching);
        self.detached.clone_from(detached);
        self.slipped.clone_from(slipped);
        self.failed.clone_from(failed);
    }
}
