//! Water at one instant.

use enmm::geometry::Point;
use enmm::model::Simulation;
use enmm::model::tables::{EdgeId, FlowPiece, Wet};

/// A wet edge of the boundary now.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WetEdge {
    /// Both ends (m), rock on the left.
    pub ends: [Point; 2],
    /// Number of its block.
    pub block: u32,
    /// Pressure of the water (Pa) at both ends.
    pub pressure: [f64; 2],
}

/// All edges of the boundary that the water reaches at its level now, and both faces of joints as far as water flows
/// in them.
pub fn wet_edges(simulation: &Simulation) -> Vec<WetEdge> {
    let mut edges = still_edges(simulation);
    edges.extend(flow_edges(simulation));
    edges
}

/// Parts of faces of joints that water which flows presses on: not of those that have parted.
fn flow_edges(simulation: &Simulation) -> Vec<WetEdge> {
    let (model, state) = (simulation.model(), simulation.state());
    let (boundary, weight) = (&model.boundary, water_weight(simulation));
    let positions = if model.flow.is_some() { simulation.positions() } else { Vec::new() };
    let there = |piece: &FlowPiece| piece.edges.iter().all(|&edge| !state.removed[boundary.block[edge]]);
    let face = |piece: &FlowPiece, side: usize, Wet { span, heads }: Wet| {
        let (edge, [from, to]) = (piece.edges[side], piece.spans[side]);
        let [a, b] = [edge, boundary.after(edge)].map(|k| positions[k]);
        let ends = span.map(|share| a + (b - a) * (from + (to - from) * share));
        let (ends, heads) = if from <= to { (ends, heads) } else { ([ends[1], ends[0]], [heads[1], heads[0]]) };
        WetEdge { ends, block: model.labels[boundary.block[edge]], pressure: heads.map(|head| weight * head) }
    };
    let pushing = simulation.wet_pieces().filter(|(piece, _, has_parted)| !has_parted && there(piece));
    pushing.flat_map(|(piece, part, _)| [0, 1].map(|side| face(piece, side, part))).collect()
}

/// All edges of the boundary that still water reaches.
fn still_edges(simulation: &Simulation) -> Vec<WetEdge> {
    let (model, state) = (simulation.model(), simulation.state());
    let Some(water) = &model.water else { return Vec::new() };
    let weight = water_weight(simulation);
    let surface = water_surface(simulation);
    let positions = simulation.positions();
    let pressure = |p: Point| weight * (height_at(&surface, p.x) - p.y).max(0.0);
    let wet = |&edge: &EdgeId| {
        let ends = [edge, model.boundary.after(edge)].map(|k| positions[k]);
        WetEdge { ends, block: model.labels[model.boundary.block[edge]], pressure: ends.map(pressure) }
    };
    let there = |edge: &&EdgeId| !state.removed[model.boundary.block[**edge]];
    let edges = water.edges.iter().filter(there).map(wet);
    edges.filter(|edge| edge.pressure.iter().any(|&p| p > 0.0)).collect()
}

/// Weight of the water now (N/m³); 0 without water.
pub fn water_weight(simulation: &Simulation) -> f64 {
    let drive = &simulation.state().drive;
    let gravity = drive.gravity(drive.share(simulation.time())).norm();
    simulation.state().water_density * gravity
}

/// The surface of the water now, from left to right (m), level beyond both ends; empty without water.
pub fn water_surface(simulation: &Simulation) -> Vec<Point> {
    let Some(water) = &simulation.model().water else { return Vec::new() };
    let drive = &simulation.state().drive;
    let level = drive.water_level(drive.share(simulation.time()));
    water.surfaces[simulation.state().stage as usize].moved_to(level)
}

/// Height (m) of a broken line from left to right at `x` (m), level beyond its ends.
pub fn height_at(line: &[Point], x: f64) -> f64 {
    let after = line.partition_point(|p| p.x <= x);
    match (after.checked_sub(1).map(|k| line[k]), line.get(after)) {
        (Some(p), Some(q)) => p.y + (q.y - p.y) * (x - p.x) / (q.x - p.x),
        (Some(p), None) => p.y,
        (None, Some(q)) => q.y,
        (None, None) => f64::NEG_INFINITY,
    }
}
