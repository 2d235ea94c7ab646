//! Mechanics of the rock: masses, strain, stress, constitutive laws, loads, damping and energies, as pure functions
//! over slices. The room `step` calls them; they know nothing of contact or files.

mod averaging;
pub mod block_lanes;
pub mod chunk;
mod column;
mod elastic;
pub mod element_lanes;
mod load;
mod mass;
mod motion;
pub mod pressure;
mod record;
mod section;
mod turn;
mod yield_lanes;

pub use crate::rock::{
    Criterion, Deformation, Elasticity, HoekBrown, MohrCoulomb, PlasticStrain, PreStress, Strained, StressField,
    Weakness, YieldSurface, YieldingRock, critical_dt, equivalent_strain,
};

pub use averaging::{Averages, Averaging, RUN, fill_runs};
pub use chunk::{Chunk, Chunks};
pub use column::{Column, ColumnDrive, ColumnPosition, ColumnState, Foot};
pub use elastic::ElasticElements;
pub use load::{Forces, Load, LoadAction, LoadedFace, TimeTable, push_block};
pub use mass::MassMatrix;
pub use motion::{
    BlockCovers, BlockMotion, BlockStart, Damping, KickStep, damp, kinetic_energy, motion_with_energy, rigid_motion,
    rigid_velocity, turning,
};
pub use record::Record;
pub use section::{CoverPart, Resultants, RockStrength, SectionCut, SectionFailure, bending_strength, crack_time};
pub use turn::Turn;
pub use yield_lanes::{ElementRow, PatchPlaces, PlasticPlaces};
