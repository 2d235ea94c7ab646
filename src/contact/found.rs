//! Contacts as the narrow phase finds them. Nodes that hardly move against the sides near them keep theirs.

use serde::{Deserialize, Serialize};

use crate::geometry::Point;

use super::{DetectionRule, Frames};

/// A contact as it is found: its near side, and how long it is. Node, side and edge are in its history.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct FoundContact {
    /// Index of the near side.
    pub near_side: u32,
    /// Tributary length (m).
    pub length: f64,
    /// Part of it on which cohesion and tension act (m).
    pub bonded: f64,
    /// Length for the default stiffness (m).
    pub penalty: f64,
    /// Share of its strength that the contact has.
    pub share: f64,
    /// Whether it keeps its stiffness through an impact.
    pub keeps: bool,
}

/// Contacts of the last step as they were found, in their order, and where the nodes were when all were found.
#[doc(alias = "contact recycling")]
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FoundContacts {
    /// The contacts; empty where the next step has to find all of them.
    pub contacts: Vec<FoundContact>,
    found_at: Vec<Point>,
    /// Internal steps of all stages before that.
    step: u64,
}

clone_without_allocating!(FoundContacts { contacts found_at step });

impl FoundContacts {
    /// Positions of the nodes when all contacts were found (m).
    pub fn found_at(&self) -> &[Point] {
        &self.found_at
    }

    /// The same, unless all have to be found in the step after as many `steps`.
    pub fn kept_from(&self, steps: u64, rule: &DetectionRule) -> Option<&[Point]> {
        (!self.contacts.is_empty() && (steps.saturating_sub(self.step) as f64) < rule.stays_steps)
            .then_some(&self.found_at)
    }

    /// Bytes of the lists.
    pub fn bytes(&self) -> usize {
        size_of_val(self.contacts.as_slice()) + size_of_val(self.found_at.as_slice())
    }

    /// Makes the next step find all contacts.
    pub fn forget(&mut self) {
        self.contacts.clear();
        self.found_at.clear();
    }

    /// Takes over the contacts of the step after as many `steps`, in exchange for those before.
    pub fn take_over(&mut self, contacts: &mut Vec<FoundContact>, frames: &Frames, steps: u64, rule: &DetectionRule) {
        if self.kept_from(steps, rule).is_none() {
            self.found_at.clear();
            self.found_at.extend(frames.node_positions());
            self.step = steps;
        }
        std::mem::swap(&mut self.contacts, contacts);
    }
}
