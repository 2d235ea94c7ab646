//! Water that flows in joints as the film of a model has it.

use enmm_observe::{FlowLine, WaterInJoints};
use enmm_report::{Water, WaterDrain, WaterInlet};

use enmm::model::Simulation;

use crate::flow::FlowRecord;

/// Water in the joints of a model now; none where it does not flow.
pub fn water(simulation: &Simulation) -> Option<Water> {
    let flow = WaterInJoints::of(simulation)?;
    let stage = simulation.state().seepage.as_ref()?.balances.last()?.stage as usize;
    let stage = &simulation.case().stages[stage].name;
    let mut nodes: Vec<(u32, [f64; 3])> = flow.lines.iter().flat_map(ends).collect();
    nodes.sort_by_key(|(node, _)| *node);
    nodes.dedup_by_key(|(node, _)| *node);
    let place = |node: u32| nodes.partition_point(|(other, _)| *other < node) as u32;
    let piece = |line: &FlowLine| {
        let [a, b] = line.nodes.map(place);
        (a, b, line.block, short(line.flow))
    };
    let drains = flow.drains.iter().map(|drain| WaterDrain {
        name: drain.name.clone(),
        points: drain.points.iter().map(|point| [point.x, point.y]).collect(),
        flow: drain.flow,
    });
    let records = FlowRecord::all(simulation);
    let last = records.iter().rposition(|record| record.stage == *stage).map_or(0, |last| last + 1);
    let first = last.saturating_sub(simulation.model().flow.as_ref()?.inlet_count());
    let inlet = |record: &FlowRecord| WaterInlet {
        name: record.name.clone(),
        enters: record.enters,
        leaves: record.leaves,
        runs_off: record.runs_off,
    };
    Some(Water {
        stage: stage.clone(),
        pieces: flow.lines.iter().map(piece).collect(),
        nodes: nodes.into_iter().map(|(_, node)| node).collect(),
        seeps: flow
            .seeps
            .iter()
            .map(|seep| [millimetres(seep.place.x), millimetres(seep.place.y), seep.flow])
            .collect(),
        drains: drains.collect(),
        inlets: records[first..last].iter().map(inlet).collect(),
    })
}

/// Nodes at both ends, with places and pressure heads (m).
fn ends(line: &FlowLine) -> [(u32, [f64; 3]); 2] {
    let heads = line.pressure_heads();
    [0, 1].map(|k| (line.nodes[k], [line.reference[k].x, line.reference[k].y, heads[k]].map(millimetres)))
}

/// A length (m) to a millimetre: the page draws no finer, and short numbers make small pages.
fn millimetres(length: f64) -> f64 {
    (length * 1e3).round() / 1e3
}

/// A number in four digits.
fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
