//! Doubts about water that flows in joints: flow too fast for the cubic law, blocks that water lifts.

use enmm::geometry::{Point, Vector};
use enmm::model::Simulation;

use crate::flow::{FlowLine, WaterInJoints};
use crate::water::wet_edges;

/// Reynolds number ρq/μ from which the cubic law gives too much flow: joints are rough, and flow in them becomes
/// turbulent from some hundreds on.
const TURBULENT: f64 = 500.0;

/// A block that the water lifts with more than its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiftedBlock {
    /// Number of the block.
    pub block: u32,
    /// Its centroid (m).
    pub place: Point,
    /// Force of the water on all its faces, against gravity (N/m).
    pub uplift: f64,
    /// Its weight (N/m).
    pub weight: f64,
}

/// Blocks that can move and that the water around them lifts with more than their weight, the lightest for their uplift
/// first; none where water does not flow.
pub fn lifted_blocks(simulation: &Simulation) -> Vec<LiftedBlock> {
    let (model, state) = (simulation.model(), simulation.state());
    if model.flow.is_none() {
        return Vec::new();
    }
    let gravity = state.drive.gravity(state.drive.share(simulation.time()));
    let size = gravity.norm().max(f64::MIN_POSITIVE);
    let up = -gravity / size;
    let states = simulation.block_states();
    let mut uplift = vec![0.0; states.len()];
    for edge in wet_edges(simulation) {
        let along = edge.ends[1] - edge.ends[0];
        let inward = Vector::new(-along.y, along.x);
        let mean = 0.5 * (edge.pressure[0] + edge.pressure[1]);
        if let Some(block) = simulation.block_labelled(edge.block) {
            uplift[block.index()] += mean * inward.dot(&up);
        }
    }
    let free = states.iter().zip(&uplift).filter(|(block, _)| !block.removed && !block.fixed);
    let lifted = free.map(|(block, &uplift)| LiftedBlock {
        block: block.id,
        place: block.centroid,
        uplift,
        weight: block.mass * size,
    });
    let mut lifted: Vec<LiftedBlock> = lifted.filter(|block| block.uplift > block.weight).collect();
    lifted.sort_by(|a, b| (b.uplift / b.weight).total_cmp(&(a.uplift / a.weight)).then(a.block.cmp(&b.block)));
    lifted
}

/// Doubts about the flow in joints that was found last.
pub fn flow_doubts(simulation: &Simulation) -> Vec<String> {
    let Some(flow) = WaterInJoints::of(simulation) else { return Vec::new() };
    fast(simulation, &flow).into_iter().chain(lifted(simulation)).collect()
}

/// Flow that is too fast for the cubic law.
fn fast(simulation: &Simulation, flow: &WaterInJoints) -> Option<String> {
    let viscosity = simulation.model().flow.as_ref()?.viscosity;
    let reynolds = |line: &FlowLine| simulation.state().water_density * line.flow.abs() / viscosity;
    let count = flow.lines.iter().filter(|line| reynolds(line) > TURBULENT).count();
    let most = flow.lines.iter().max_by(|a, b| a.flow.abs().total_cmp(&b.flow.abs()))?;
    let place = (most.reference[0] + most.reference[1]) * 0.5;
    (count > 0).then(|| {
        format!(
            "water flows near ({:.3}, {:.3}) m with a Reynolds number ρq/μ of {:.0}, and in {count} of {} pieces of \
             joint with more than {TURBULENT}: flow is turbulent there, and the cubic law gives too much of it; give a \
             smaller hydraulic aperture, or take the flow for an upper limit",
            place.x,
            place.y,
            reynolds(most),
            flow.lines.len()
        )
    })
}

/// Blocks that would float.
fn lifted(simulation: &Simulation) -> Option<String> {
    let lifted = lifted_blocks(simulation);
    let LiftedBlock { block, place, uplift, weight } = lifted.first()?;
    let more = if lifted.len() > 1 {
        format!(", and {} blocks more in the same way", lifted.len() - 1)
    } else {
        String::new()
    };
    Some(format!(
        "water lifts block {block} near ({:.3}, {:.3}) m with {uplift:.4e} N/m, more than its weight of {weight:.4e} \
         N/m{more}: the rock around must hold it, or it rises; drain the joints below it, or lower the heads",
        place.x, place.y
    ))
}
