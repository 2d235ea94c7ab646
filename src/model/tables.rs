//! Names of the tables that a built model and its state hold, for those who read them: observers of a model, analyses
//! of its stability, and reports of what it costs.

pub use crate::contact::{
    Boundary, ContactHistory, DetectionRule, EdgeId, Facing, Facings, LawId, NodeId, Resistance, SideId, VertexEdge,
};
pub use crate::cover::{BlockId, BoundaryPiece, CoverId, ElementId, Outlines};
pub use crate::flow::{FlowNet, FlowPiece, Inlet, Outcrop, Wet, wet};
pub use crate::mechanics::{Resultants, SectionFailure};
pub use crate::monitor::{Faces, JointMonitor, LinePlace, Monitors, StressFit};
pub use crate::state::{Cut, Model, Seconds, Workspace, WorstSection};
