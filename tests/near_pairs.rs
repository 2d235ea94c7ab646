//! The search finds the near pairs that all nodes against all edges give, on any number of threads.

use crate::common::{example, simulation};
use enmm::geometry::{Vector, segment};
use enmm::internals::contact::{Frames, NeighbourList, SearchGrid, SearchView, SideId};
use enmm::model::Simulation;
use enmm::model::tables::{BlockId, Boundary, EdgeId, NodeId};

/// Whether a node and an edge can touch: not two fixed blocks, and in one block only both sides of a partial cut.
fn may_meet(boundary: &Boundary, fixed: &[bool], node: NodeId, edge: EdgeId) -> bool {
    let [before, after] = boundary.edges_of_node(node);
    let (own, other) = (boundary.block[after], boundary.block[edge]);
    let partial = |edge: EdgeId| boundary.partial[edge];
    let is_own = own == other;
    !(fixed[own] && fixed[other])
        && (!is_own || partial(edge) && (partial(before) || partial(after)))
        && (!is_own || [before, after].iter().all(|&side| boundary.side[side] != boundary.side[edge]))
}

/// Nodes and edges that are near, by all against all.
fn all_against_all(view: &SearchView) -> Vec<(NodeId, SideId, EdgeId)> {
    let boundary = view.boundary;
    let counts = |point: EdgeId| !view.removed[boundary.block[point]];
    let edges: Vec<_> = boundary.edges().filter(|&edge| counts(edge)).collect();
    let mut pairs = Vec::new();
    for node in NodeId::all(boundary.node_count()).filter(|&node| counts(boundary.nodes.point[node])) {
        let p = view.frames.position(boundary.nodes.point[node]);
        for &edge in &edges {
            let (a, b) = (view.frames.position(edge), view.frames.position(boundary.after(edge)));
            if segment::distance(p, a, b) < view.cutoff && may_meet(boundary, view.fixed, node, edge) {
                pairs.push((node, boundary.side[edge], edge));
            }
        }
    }
    pairs
}

/// Blocks pushed their own ways, some of them far off.
fn push(simulation: &Simulation, share: f64) -> Frames {
    let slope = simulation.model();
    let away = |block: BlockId| {
        let angle = 0.7 * f64::from(block.number());
        let far = if block.index() % 50 == 7 { 30.0 } else { 1.0 };
        Vector::new(angle.cos(), angle.sin()) * (share * far * slope.covers.mesh.size)
    };
    let (boundary, places) = (&slope.boundary, &simulation.workspace().frames);
    let mut frames = Frames::default();
    frames.update(boundary, |point| places.position(point) + away(boundary.block[point]), true);
    frames
}

#[test]
fn the_search_finds_what_all_against_all_find() {
    let mut simulation = simulation(&example("fractured_slope"));
    simulation.advance(false).unwrap_or_else(|e| panic!("{e}"));
    let boundary = &simulation.model().boundary;
    assert!(boundary.partial.contains(&true), "there must be partial cuts");
    let fixed = &simulation.workspace().mass_matrix.fixed;
    let removed: Vec<bool> = (0..fixed.len()).map(|block| block % 40 == 3).collect();
    let cutoff = 0.25 * simulation.model().covers.mesh.size;
    let mut grids: [(SearchGrid, NeighbourList); 2] = Default::default();
    for share in [0.0, 0.1, 0.3] {
        let frames = push(&simulation, share);
        let view = |serial| SearchView { boundary, frames: &frames, cutoff, removed: &removed, fixed, serial };
        let expected = all_against_all(&view(true));
        assert!(expected.len() > 5000, "{} pairs", expected.len());
        for (serial, (grid, neighbours)) in [true, false].into_iter().zip(&mut grids) {
            grid.search(&view(serial), neighbours);
            let found: Vec<_> = neighbours.pairs.iter().map(|c| (c.node, c.side, c.edge)).collect();
            assert!(found == expected, "{} pairs at {share}, not {}", found.len(), expected.len());
        }
        assert!(grids[0].1 == grids[1].1, "a run of all nodes and many runs differ at {share}");
    }
}
