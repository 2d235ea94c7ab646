//! Mechanics of the rock: masses, strain, stress, constitutive laws, loads, damping and energies, as pure functions
//! over slices. The room `step` calls them; they know nothing of contact or files.

mod averaging;
pub mod block_lanes;
pub mod chunk;
mod column;
mod elasticity;
pub mod element_lanes;
mod hoek_brown;
mod internal;
mod load;
mod mass;
mod motion;
mod plasticity;
pub mod pressure;
mod record;
mod turn;

pub use averaging::{Averages, Averaging, Strained, list};
pub use chunk::{Chunk, Chunks};
pub use column::{Column, ColumnDrive, ColumnPosition, ColumnState, Foot};
pub use elasticity::{Elasticity, critical_dt};
pub use hoek_brown::HoekBrown;
pub use internal::{Deformation, PreStress, StressField};
pub use load::{Load, LoadAction, LoadedFace, TimeTable, push_block, spread};
pub use mass::MassMatrix;
pub use motion::{
    BlockCovers, BlockMotion, BlockStart, Damping, KickStep, damp, kinetic_energy, rigid_motion, rigid_velocity,
    turning,
};
pub use plasticity::{Criterion, MohrCoulomb, PlasticStrain, YieldSurface, YieldingRock, equivalent_strain};
pub use record::Record;
pub use turn::Turn;
