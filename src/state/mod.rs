//! The data of a simulation: [`Model`] (fixed once built), [`State`] (all that a checkpoint holds), [`Workspace`]
//! (buffers).

pub mod bytes;
mod cut;
mod element;
mod events;
mod inputs;
mod integrator;
mod ledger;
mod memory;
mod model;
mod quantity;
mod seepage;
mod workspace;

pub use cut::{Cut, WorstSection};
pub use events::{Event, EventKind, Events};
pub use inputs::{Course, Drive, Input, Inputs};
pub use integrator::{Buffers, OtherIntegrator};
pub use ledger::{BALANCE, BoltEnergies, ENERGIES, Ledger};
pub use memory::Part;
pub use model::{
    BaseMotion, Breaking, BreakingRock, Fixity, FreeFieldPoint, Model, MotionKind, Port, PortKind, QuietBoundary,
    TimedRecord, Water, WaterSurface,
};
pub use quantity::Quantity;
pub use seepage::{FlowBalance, Round, Rounds, Seepage, StageWater, Surroundings};
pub use workspace::{
    ChunkSums, ContactOutcome, Face, FaceBuffers, Flow, Grown, MotionBuffers, Seconds, SelectionBuffers,
    SupportBuffers, Suspect, SweepBuffers, Workspace, YieldBuffers,
};

use serde::{Deserialize, Serialize};

use crate::contact::{BoltState, BondHistory, ContactHistory, FoundContacts, JointLaw, LawId, NeighbourList, Release};
use crate::geometry::Vector;
use crate::mechanics::{ColumnState, PlasticStrain};

/// A static stage in which all but a few blocks are at rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MostRest {
    /// Time (s) since which they are.
    pub since: f64,
    /// Kinetic energies (J/m) of the few blocks and of all others, summed over the reports since then.
    pub kinetic: [f64; 2],
}

/// Delay of friction in a dynamic stage (Eq. 84).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FrictionDelay {
    /// Time (s) by which friction follows the normal force.
    pub time: f64,
    /// Gap (m) up to which faces that hop count as in touch.
    pub hop: f64,
}

/// Everything that changes in time and that a checkpoint holds.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Stage in progress.
    pub stage: u32,
    /// Time at the start of the stage (s).
    pub stage_start: f64,
    /// Start of each stage up to this one (s): ground motion counts its time from there.
    pub stage_starts: Vec<f64>,
    /// How long most of the rock has been at rest in a static stage; none while it moves.
    pub most_rest: Option<MostRest>,
    /// Internal steps done in the stage.
    pub stage_step: u64,
    /// Internal steps done in all stages.
    pub step: u64,
    /// Part of the next internal step that is done already (s); 0 on the grid of internal steps.
    pub part: f64,
    /// Part of an internal step by which the last kick was shifted: the last sub-step (s); 0 after an implicit step,
    /// whose velocities are those of its end.
    pub dt_last: f64,
    /// Displacement of each physical cover (m).
    pub displacement: Vec<Vector>,
    /// Velocity of each physical cover half a step ago (m/s). Implicit: that of the end of the last step, and in a
    /// static stage, where every step starts from rest, the mean of the last step.
    pub velocity: Vec<Vector>,
    /// Contacts of the last step, ordered by node and side.
    pub contacts: Vec<ContactHistory>,
    /// Bond of each of them; empty in a model whose joints do not soften.
    pub bonds: Vec<BondHistory>,
    /// How each section of a rock bridge lets go; none while it holds.
    pub sections: Vec<Option<Release>>,
    /// The same as they were found; empty in a model whose joints soften, and in implicit runs.
    pub found: FoundContacts,
    /// How friction is delayed in a dynamic stage; none before its first step, and in static stages.
    pub friction_delay: Option<FrictionDelay>,
    /// Near pairs of the last search.
    pub neighbours: NeighbourList,
    /// Force of each support (N/m).
    pub support_force: Vec<f64>,
    /// Displacement along each support's direction at which it carries only its preload (m).
    pub support_rest: Vec<f64>,
    /// The section of each block that is nearest to its strength; empty in a model whose rock does not break.
    pub worst_sections: Vec<WorstSection>,
    /// Sections of rock that have broken, in their order.
    pub cuts: Vec<Cut>,
    /// Whether each fixity holds.
    pub fix_active: Vec<bool>,
    /// Blocks that have been excavated.
    pub removed: Vec<bool>,
    /// Joint laws as they are now.
    pub laws: Vec<JointLaw>,
    /// Law that each law of the case has been switched to.
    pub law_switch: Vec<LawId>,
    /// Damping ratio of dynamic stages, if it is no longer that of the case.
    pub damping: Option<f64>,
    /// Density of water (kg/m³); 0 where there is none.
    pub water_density: f64,
    /// Water in the joints, if it flows.
    pub seepage: Option<Seepage>,
    /// Displacements from which those of outputs count (m); empty while they count from the start.
    pub since: Vec<Vector>,
    /// Displacements at the start of a static stage (m).
    pub stage_displacement: Vec<Vector>,
    /// Forces out of balance at the start of a static stage (N/m).
    pub stage_force: Vec<Vector>,
    /// Inputs of the host.
    pub drive: Drive,
    /// Bolts.
    pub bolts: Vec<BoltState>,
    /// Plastic strain of each element (Eq. 55); empty when no rock yields.
    pub plastic: Vec<PlasticStrain>,
    /// Free-field columns.
    pub columns: Vec<ColumnState>,
    /// Acceleration of each physical cover (m/s²) at the end of the last implicit step; empty in explicit runs.
    pub acceleration: Vec<Vector>,
    /// Implicit: time for which inertia counts in the next static sub-step, over its length; 0 before the first.
    pub static_stretch: f64,
    /// Events so far.
    pub events: Events,
    /// Energy ledger.
    pub ledger: Ledger,
    /// Counters of the whole run.
    pub counters: Counters,
}

clone_without_allocating! {
    State {
        stage stage_start stage_starts most_rest stage_step step part dt_last displacement velocity contacts
        bonds sections found friction_delay neighbours support_force support_rest worst_sections cuts fix_active removed
        laws law_switch damping water_density seepage since stage_displacement stage_force drive bolts plastic columns
        acceleration static_stretch events ledger counters
    }
}

impl State {
    /// Displacements of the covers (m) from which those of outputs count; none while they count from the start.
    pub fn counted_from(&self) -> Option<&[Vector]> {
        Some(&self.since[..]).filter(|since| !since.is_empty())
    }

    /// Time (s) that is left of the internal step in progress.
    pub fn rest_of_step(&self, model: &Model) -> f64 {
        model.dt - self.part
    }

    /// Contacts whose bond still has strength, with it.
    pub fn held_bonds(&self) -> impl Iterator<Item = (&ContactHistory, &BondHistory)> {
        self.contacts.iter().zip(&self.bonds).filter(|(contact, bond)| contact.intact && bond.lengths[1] > 0.0)
    }
}

/// Rock that contacts crushed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Crushing {
    /// Times that a contact began to crush it.
    pub times: u64,
    /// Energy (J/m) that it took; part of what contacts dissipate.
    pub energy: f64,
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
    /// Rock that contacts crushed.
    pub crushing: Crushing,
    /// Bonded length (m) that has broken, of joints that soften.
    pub broken: f64,
    /// Largest penetration of all steps (m).
    pub penetration_max: f64,
    /// Shortest sub-step (s).
    pub dt_min: f64,
    /// Longest sub-step (s).
    pub dt_max: f64,
    /// Searches for near edges.
    pub searches: u64,
    /// Contacts solved, summed over sub-steps and sweeps.
    pub contacts_solved: u64,
    /// Implicit: numeric factorisations.
    pub factorisations: u64,
}
