//! Sections of rock that can break: those nearest to it, and those that have broken.

use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;
use enmm::model::tables::{BlockId, Cut, WorstSection};

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
    let section = |(block, worst): (BlockId, &WorstSection)| RockSection {
        block: model.labels[block],
        share: simulation.strength_share(block),
        ends: moved(simulation, block, worst.ends),
    };
    known.map(section).collect()
}

/// Both faces of every section that has broken so far, each where its block is now (m); those of blocks that have been
/// dug are left out.
pub fn broken_sections(simulation: &Simulation) -> Vec<[Point; 2]> {
    let faces = |cut: &Cut| [(cut.block, cut.ends), (cut.part, cut.ends)];
    let there = |label| simulation.block_labelled(label).filter(|block| !simulation.state().removed[*block]);
    let face = |(label, ends)| there(label).map(|block| moved(simulation, block, ends));
    simulation.cuts().iter().flat_map(faces).filter_map(face).collect()
}

/// Places of the reference configuration (m) after the rigid motion of a block.
fn moved(simulation: &Simulation, block: BlockId, places: [Point; 2]) -> [Point; 2] {
    let of = simulation.motion_of(block);
    let (sine, cosine) = libm::sincos(of.rotation);
    places.map(|place| {
        let arm = place + of.displacement - of.centroid;
        of.centroid + Vector::new(cosine * arm.x - sine * arm.y, sine * arm.x + cosine * arm.y)
    })
}
