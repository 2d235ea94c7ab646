//! Loops of the boundary: of all its points, and of its nodes alone.

use std::ops::Range;

use enmm::model::Simulation;
use enmm::model::tables::{BlockId, EdgeId, NodeId};

/// Every loop of the boundary: its block and its points, in the order of the points.
pub fn loops(simulation: &Simulation) -> Vec<(BlockId, Range<usize>)> {
    let boundary = &simulation.model().boundary;
    let mut loops = Vec::new();
    let mut k = 0;
    while k < boundary.len() {
        let first = EdgeId::new(k);
        let mut last = first;
        while boundary.after(last) != first {
            last = boundary.after(last);
        }
        let points = k..last.index() + 1;
        k = points.end;
        loops.push((boundary.block[first], points));
    }
    loops
}

/// The boundary points of the nodes by block and loop. There is one node at every corner and kink, and at least one in
/// a mesh size.
pub fn node_loops(simulation: &Simulation) -> Vec<Vec<Vec<EdgeId>>> {
    let model = simulation.model();
    let boundary = &model.boundary;
    let mut loops: Vec<Vec<Vec<EdgeId>>> = vec![Vec::new(); model.covers.block_count()];
    let mut first = 0;
    while first < boundary.node_count() {
        let mut node = NodeId::new(first);
        let mut points = Vec::new();
        loop {
            points.push(boundary.nodes.point[node]);
            node = boundary.nodes.next[node];
            if node.index() == first {
                break;
            }
        }
        first += points.len();
        loops[boundary.block[points[0]]].push(points);
    }
    loops
}
