//! Contact between blocks, in the order of a step: boundary, broad phase (near pairs), narrow phase (contacts by the
//! vertex rule), joint laws and springs, supports and bolts, and the solver (open–close iteration). Knows nothing of
//! files or FMI.

mod bolt;
mod bonded;
mod boundary;
mod broad_phase;
mod buckets;
mod climb;
mod constants;
mod facing;
mod found;
mod frame;
mod grout;
mod law;
mod narrow_phase;
mod pair;
mod section;
mod solver;
mod spring;
mod support;
mod vertex_edge;
mod vertex_rule;

pub use bolt::{BoltCondition, BoltRow, BoltSegment, BoltState, BoltView};
pub use bonded::GroutBuffers;
pub use boundary::{Boundary, Corner, EdgeId, NodeId, SideEnd, SideId};
pub use broad_phase::{NearPair, NeighbourList, SearchGrid, SearchView};
pub use climb::Slide;
pub use constants::DetectionRule;
pub use facing::{Facing, Facings};
pub use found::{FoundContact, FoundContacts};
pub use frame::Frames;
pub use grout::Grout;
pub use law::{Bond, Closure, Damaged, JointLaw, LawId, LiftLoad, Lifted, Limits, Roughness, SectionBond, Softening};
pub use narrow_phase::{AcceptedPairs, NarrowPhase, NearSides, find_contacts, prefiltered};
pub use pair::Pair;
pub use section::{Failure, Hold, Release, Section, SectionForces, SectionId, Sections};
#[doc(hidden)]
pub use solver::reference;
pub use solver::{Approach, BlockImpulse, OpenClose, OtherConstraints, SolverOptions, SolverReport};
pub use spring::{SoftSpring, Spring};
pub use support::{Resistance, Support, SupportRow};
pub use vertex_edge::{
    BondHistory, ContactHistory, ContactSetting, ContactState, Crushed, Meeting, Unloaded, VertexEdge,
};
pub use vertex_rule::{ContactCache, ContactCandidate, PenetratingContacts, VertexRule};
