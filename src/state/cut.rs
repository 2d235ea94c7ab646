//! Sections of intact blocks: the one nearest to its strength, and those that have broken.

use serde::{Deserialize, Serialize};

use crate::geometry::Point;
use crate::mechanics::{Resultants, SectionFailure};

/// The section of a block that is nearest to its strength.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct WorstSection {
    /// Share of its strength. Of a block whose sections cannot have a share of 0.3, a bound.
    pub share: f64,
    /// Its ends in the reference configuration (m); the same point twice where a bound was enough.
    pub ends: [Point; 2],
    /// What it carries.
    pub carries: Resultants,
    /// How it fails at a share of 1.
    pub failure: SectionFailure,
    /// Whether the block cannot be cut, because a cut of it could not be made.
    pub barred: bool,
}

/// A section through rock that has broken: a joint from then on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cut {
    /// Its ends in the reference configuration (m).
    pub ends: [Point; 2],
    /// Stage.
    pub stage: u32,
    /// End of the internal step that broke it, counted in all stages.
    pub step: u64,
    /// Simulated time then (s).
    pub time: f64,
    /// Number of the block that it parted, as hosts see it.
    pub block: u32,
    /// Number of the part that is new.
    pub part: u32,
    /// Rock of the case whose strength it had.
    pub rock: u16,
    /// Share of its strength that it had.
    pub share: f64,
    /// What it carried.
    pub carried: Resultants,
    /// How it failed.
    pub failure: SectionFailure,
}
