//! The rock of one element, or of eight elements in lanes, as pure functions: deformation, stress and energy, elastic
//! and beyond the yield surface. The room knows no covers, no blocks and no time.

mod deformation;
mod elasticity;
mod hoek_brown;
mod plasticity;
mod weakness;

pub use deformation::{Deformation, PreStress, StressField};
pub use elasticity::{Elasticity, critical_dt};
pub use hoek_brown::HoekBrown;
pub use plasticity::{Criterion, MohrCoulomb, PlasticStrain, Strained, YieldSurface, YieldingRock, equivalent_strain};
pub use weakness::Weakness;
