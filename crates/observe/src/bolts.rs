//! Bolts at one instant.

use enmm::geometry::{Point, Vector};
use enmm::model::{BoltCondition, BoltSegment, BoltState, Quantity, Simulation};

/// A free length of a bolt between two material points now.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BoltLine {
    /// Both ends (m), the end at the head first.
    pub ends: [Point; 2],
    /// Both ends in the reference configuration (m).
    pub reference: [Point; 2],
    /// Numbers of the blocks of both ends.
    pub blocks: [u32; 2],
    /// Index of the bolt in the case.
    pub bolt: u32,
    /// Tension (N per metre of depth).
    pub force: f64,
    /// Lasting elongation of the bar (m).
    pub plastic_elongation: f64,
    /// Slip (m) of a grouted bar along the rock at both ends, towards its far end; 0 without a bond.
    pub slip: [f64; 2],
    /// Its condition.
    pub condition: BoltCondition,
}

/// Numbers of a free length of a bolt as outputs show them.
pub const BOLT_QUANTITIES: [Quantity<BoltLine>; 1] =
    [Quantity::plain("force", "N/m", "Tension per metre of depth", |bolt| bolt.force)];

/// All bolts, in the order of the model.
pub fn bolts(simulation: &Simulation) -> Vec<BoltLine> {
    let (model, state) = (simulation.model(), simulation.state());
    let stars = &model.covers.star_position;
    let line = |(segment, now): (&BoltSegment, &BoltState)| {
        let end = |k: usize| {
            let sample = |field: &[Vector]| -> Vector {
                segment.covers[k].iter().zip(segment.weights[k]).map(|(&i, w)| field[i] * w).sum()
            };
            sample(stars) + sample(&state.displacement)
        };
        BoltLine {
            ends: [end(0), end(1)],
            reference: segment.points,
            blocks: segment.blocks.map(|block| model.labels[block]),
            bolt: segment.bolt,
            force: now.force,
            plastic_elongation: now.rest - now.natural,
            slip: now.slip,
            condition: now.condition(),
        }
    };
    model.bolts.iter().zip(&state.bolts).map(line).collect()
}
