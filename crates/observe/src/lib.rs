//! A model as it is seen at one instant: elements, blocks, joints, bolts, supports, water and sums over the model.
//!
//! Pictures, frames, the film and the summary read a model through these types, so that a joint opens by the same
//! number everywhere. Each kind with numbers has one table of [`Quantity`]: name, unit, meaning and value.
//!
//! | what | type | numbers |
//! |---|---|---|
//! | elements | [`Snapshot`] | [`STRESS_QUANTITIES`] |
//! | blocks | [`BlockState`] | [`BLOCK_QUANTITIES`], [`STRENGTH_QUANTITIES`] |
//! | joints | [`JointPiece`] | [`JOINT_QUANTITIES`] |
//! | bolts | [`BoltLine`] | [`BOLT_QUANTITIES`] |
//! | supports | [`SupportPoint`] | |
//! | water | [`WetEdge`] | |
//! | joints in which water flows | [`FlowLine`] | [`FLOW_QUANTITIES`] |
//! | energies and works | [`Ledger`] | [`ENERGIES`] |
//! | sums at the end of a step | [`StepReport`] | [`REPORT_QUANTITIES`] |
//! | sums for hosts | [`Totals`] | [`TOTALS`] |
//! | ports | [`PortState`] | [`PORT_QUANTITIES`] |
//! | monitors | [`MonitorState`], [`stress::Stress`] | [`MONITOR_QUANTITIES`], [`MONITOR_STRESS_QUANTITIES`] |
//! | monitors of joints | [`JointMonitorState`] | [`JOINT_MONITOR_QUANTITIES`] |
//! | heads, rain and drains | [`InletState`] | [`INLET_QUANTITIES`] |
//!
//! Blocks, energies, ports, monitors, heads and sums for hosts are worked out by the engine, because the C library and
//! the FMUs read them between two steps.
#![forbid(unsafe_code)]

mod bolts;
mod bonds;
mod edges;
mod flow;
mod flow_doubts;
mod joints;
mod loops;
mod sections;
mod snapshot;
pub mod stress;
mod supports;
mod totals;
mod water;

pub use enmm::cosimulation::{PORT_QUANTITIES, PortState, TOTALS, Totals};
pub use enmm::model::{
    BLOCK_QUANTITIES, BlockState, BoltCondition, ContactState, ENERGIES, INLET_QUANTITIES, InletState,
    JOINT_MONITOR_QUANTITIES, JointMonitorState, Ledger, MONITOR_QUANTITIES, MONITOR_STRESS_QUANTITIES, MonitorState,
    Quantity, STRENGTH_QUANTITIES, StepReport,
};

pub use bolts::{BOLT_QUANTITIES, BoltLine, bolts};
pub use bonds::{BondState, bond_states};
pub use edges::edge_states;
pub use flow::{DrainFlow, FLOW_QUANTITIES, FlowLine, Seep, WaterInJoints};
pub use flow_doubts::{LiftedBlock, flow_doubts, lifted_blocks};
pub use joints::{JOINT_QUANTITIES, JointPiece, Joints, SlipSince};
pub use loops::{loops, node_loops};
pub use sections::{RockSection, broken_sections, rock_sections};
pub use snapshot::{Boundary, Polygons, Snapshot, moved_since, references};
pub use stress::STRESS_QUANTITIES;
pub use supports::{SupportKind, SupportPoint, supports};
pub use totals::REPORT_QUANTITIES;
pub use water::{WetEdge, height_at, water_surface, water_weight, wet_edges};
