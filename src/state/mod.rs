//! The three heaps: [`Slope`] (fixed once built), [`State`] (all that a checkpoint holds), [`Scratch`] (buffers).

mod ledger;
mod scratch;
mod slope;

pub use ledger::Ledger;
pub use scratch::{Scratch, Seconds};
pub use slope::{Fixity, Slope};

use serde::{Deserialize, Serialize};

use crate::contact::{ContactHistory, JointLaw, Near};
use crate::geometry::Vector;

/// Everything that changes in time and that a checkpoint holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Stage in progress.
    pub stage: u32,
    /// Time at the start of the stage (s).
    pub stage_start: f64,
    /// Internal steps done in the stage.
    pub stage_step: u64,
    /// Internal steps done in all stages.
    pub step: u64,
    /// Part of an internal step by which the last kick was shifted: the last sub-step (s).
    pub dt_last: f64,
    /// Displacement of each physical cover (m).
    pub displacement: Vec<Vector>,
    /// Velocity of each physical cover half a step ago (m/s).
    pub velocity: Vec<Vector>,
    /// Contacts of the last step, ordered by node and side.
    pub contacts: Vec<ContactHistory>,
    /// Near pairs of the last search.
    pub near: Near,
    /// Force of each support (N/m).
    pub support_force: Vec<f64>,
    /// Displacement along each support's direction at which it bears only its preload (m).
    pub support_rest: Vec<f64>,
    /// Whether each fixity holds.
    pub fix_active: Vec<bool>,
    /// Blocks that have been excavated.
    pub removed: Vec<bool>,
    /// Joint laws as they are now.
    pub laws: Vec<JointLaw>,
    /// Law that each law of the case has been switched to.
    pub law_switch: Vec<u32>,
    /// Displacements at the start of a static stage (m).
    pub stage_displacement: Vec<Vector>,
    /// Forces out of balance at the start of a static stage (N/m).
    pub stage_force: Vec<Vector>,
    /// Energy ledger.
    pub ledger: Ledger,
    /// Counters of the whole run.
    pub counters: Counters,
}

/// Counters of the whole run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Counters {
    /// Sweeps of the open–close iteration.
    pub sweeps: u64,
    /// Most sweeps of one sub-step.
    pub sweeps_max: u32,
    /// Sub-steps taken, halved ones included.
    pub substeps: u64,
    /// Steps that were redone in halves.
    pub halved: u64,
    /// Sub-steps whose iteration ended unsettled.
    pub unsettled: u64,
    /// Contacts first seen deep, hence started without force.
    pub deep_contacts: u64,
    /// Deepest of them (m).
    pub deepest_contact: f64,
    /// Largest penetration of all steps (m).
    pub penetration_max: f64,
    /// Shortest sub-step (s).
    pub dt_min: f64,
    /// Longest sub-step (s).
    pub dt_max: f64,
    /// Searches for near edges.
    pub searches: u64,
    /// Contacts judged, summed over sub-steps and sweeps.
    pub judged: u64,
}
