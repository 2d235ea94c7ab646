//! How what the user wrote ([`Case`]) is built, and the façade that callers hold ([`Simulation`]).

pub mod assemble;
mod bonds;
mod breaking;
mod failure;
pub mod fit;
mod flowing;
mod grounds;
mod inlets;
mod looks;
pub mod mechanism;
mod monitors;
mod observe;
mod openings;
pub mod overlap;
mod parted;
mod rest;
mod restless;
mod seepage;
mod seepage_time;
pub mod settle;
mod simulation;
mod stage;
pub mod tables;
mod tune;

pub use bonds::{BondState, bond_states};
pub use enmm_case as case;
pub use enmm_case::Case;

pub use assemble::{BuildStage, Built, ExplicitAlone, Integrators};
pub use failure::{Farthest, SlopeFailure};
pub use fit::Unfit;
pub use flowing::{Flowing, FlowingInlet, FlowingPiece};
pub use inlets::{INLET_QUANTITIES, InletState, JointFlow, JointWater};
pub use mechanism::{Mechanism, RigidMotion};
pub use observe::{
    BLOCK_QUANTITIES, BlockContacts, BlockState, ContactView, MONITOR_QUANTITIES, MonitorState, STRENGTH_QUANTITIES,
};
pub use parted::Parted;
pub use restless::Restless;
pub use seepage::FlowSurvey;
pub use simulation::Simulation;
pub use tune::Tunable;

pub use crate::contact::{BoltCondition, BoltSegment, BoltState, ContactState};
pub use crate::monitor::{
    JOINT_MONITOR_QUANTITIES, JointMonitorState, LinePoint, MONITOR_STRESS_QUANTITIES, Stress, stress,
};
pub use crate::state::bytes::{self, BytesError};
pub use crate::state::{
    BALANCE, BoltEnergies, Counters, Drive, ENERGIES, Event, EventKind, FlowBalance, Inputs, Ledger, Port, PortKind,
    Quantity, Rounds, Seepage, StageWater, State,
};
pub use crate::step::{StepError, StepReport, Wanted};
