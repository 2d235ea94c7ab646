//! Events: changes that happened for the first time while the model moved.

use serde::{Deserialize, Serialize};

use crate::cover::BlockId;

/// Kind of an event.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum EventKind {
    /// A block that touched others lost its last contact.
    Detached,
    /// A joint slipped.
    Slipped,
    /// A block moved beyond the failure displacement.
    Failed,
    /// Two blocks overlap by more than the mesh or the contacts between them explain.
    Overlapped,
    /// The last bond of a joint that softens broke: of a rock bridge, as a rule.
    Broken,
    /// A block broke in two.
    Cut,
}

/// Something that happened for the first time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// What.
    pub kind: EventKind,
    /// Number of the block ([`Model::labels`](super::Model::labels)), or index of the joint trace; `u32::MAX` for
    /// contacts away from joints. Of two blocks that overlap the one with the lower id.
    pub subject: u32,
    /// End of the internal step in which it happened (s).
    pub time: f64,
    /// Number of the other block of an overlap, or of the part that a cut has made; `u32::MAX` for events of other
    /// kinds.
    pub other: u32,
    /// Depth of an overlap when it was found (m); 0 for events of other kinds.
    pub depth: f64,
}

impl Event {
    /// An event of one block or joint.
    pub fn of(kind: EventKind, subject: u32, time: f64) -> Self {
        Self { kind, subject, time, other: u32::MAX, depth: 0.0 }
    }

    /// An overlap in words, for warnings: both blocks, and the depth in metres and in parts of the mesh size (m).
    pub fn overlap_text(&self, mesh_size: f64) -> String {
        let Self { subject, other, depth, .. } = self;
        let percent = 100.0 * depth / mesh_size;
        format!("blocks {subject} and {other} overlap by {depth:.3e} m, {percent:.2} % of the mesh size")
    }
}

/// Everything that happened in dynamic stages, and overlaps of blocks and broken bonds in any stage, in order, and what
/// is needed to see the next event.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
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
    /// Joint traces that a bond held together at the end of the last step; empty in a model whose joints do not soften.
    pub bonded: Vec<bool>,
    /// Pairs of blocks that have overlapped, in order; of each the lower id first.
    pub overlapped: Vec<[BlockId; 2]>,
    /// Greatest depth of these overlaps so far (m); 0 for none.
    pub overlap_max: f64,
    /// Greatest slip (m) that a contact of each port of joints has summed up so far, also of contacts that have opened
    /// since and were forgotten; 0 of other ports.
    pub port_slip: Vec<f64>,
}

clone_without_allocating!(Events { list touching detached slipped failed bonded overlapped overlap_max port_slip });

impl Events {
    /// Nothing has happened to so many blocks, joint traces and ports.
    pub fn none(blocks: usize, traces: usize, ports: usize) -> Self {
        Self {
            list: Vec::new(),
            touching: vec![false; blocks],
            detached: vec![false; blocks],
            slipped: vec![false; traces + 1],
            failed: vec![false; blocks],
            bonded: Vec::new(),
            overlapped: Vec::new(),
            overlap_max: 0.0,
            port_slip: vec![0.0; ports],
        }
    }
}
