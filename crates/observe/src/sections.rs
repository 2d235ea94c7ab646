//! Sections of blocks that are nearest to breaking, in rock that can break.

use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;

/// The section of a block that is nearest to its strength, as far as it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RockSection {
    /// Number of the block.
    pub block: u32,
    /// Share of its strength.
    pub share: f64,
    /// Its ends where the block is now (m).
    pub ends: [Point; 2],
}

/// Those of all blocks that are there, but for blocks far from their strength, of which a bound alone is known.
pub fn rock_sections(simulation: &Simulation) -> Vec<RockSection> {
    let (model, state) = (simulation.model(), simulation.state());
    let blocks = model.covers.blocks().zip(&state.worst_sections);
    let known = blocks.filter(|(block, worst)| !state.removed[*block] && worst.ends[0] != worst.ends[1]);
    let section = |(block, worst): (_, &enmm::model::tables::WorstSection)| {
        let of = simulation.motion_of(block);
        let (sine, cosine) = libm::sincos(of.rotation);
        let moved = |place: Point| {
            let arm = place + of.displacement - of.centroid;
            of.centroid + Vector::new(cosine * arm.x - sine * arm.y, sine * arm.x + cosine * arm.y)
        };
        RockSection { block: of.id, share: of.strength_share, ends: worst.ends.map(moved) }
    };
    known.map(section).collect()
}
