//! States of the edges of the boundary.

use enmm::geometry::{Point, Vector};
use enmm::model::tables::{Boundary, EdgeId, NodeId, VertexEdge};
use enmm::model::{ContactState, Simulation};

/// Cosine of the angle between a face and the normal of a contact on it from which the face lies flat on the other.
const FLAT: f64 = -0.94;

/// State of each edge of the boundary; none where neither a joint nor a contact is. A contact stands for the stretch
/// between two nodes in which it lies, and for the stretch beside its own node that lies flat on the other block.
pub fn edge_states(simulation: &Simulation) -> Vec<Option<ContactState>> {
    let positions = simulation.positions();
    let mut states = EdgeStates::new(&simulation.model().boundary, &positions);
    simulation.each_contact(|contact| states.see(contact));
    states.found
}

/// States of edges, as contacts give them one by one.
pub struct EdgeStates<'a> {
    boundary: &'a Boundary,
    positions: &'a [Point],
    /// State of each edge.
    pub found: Vec<Option<ContactState>>,
}

impl<'a> EdgeStates<'a> {
    /// All edges before any contact: those of joints are open.
    pub fn new(boundary: &'a Boundary, positions: &'a [Point]) -> Self {
        let found = boundary.trace.iter().map(|trace| trace.map(|_| ContactState::Open)).collect();
        Self { boundary, positions, found }
    }

    /// Takes a contact.
    pub fn see(&mut self, contact: &VertexEdge) {
        let (boundary, state) = (self.boundary, contact.history.state);
        if state == ContactState::Open {
            return;
        }
        let node = contact.history.node;
        self.mark(boundary.node_before[contact.history.edge], state);
        if self.lies_flat(boundary.nodes.point[node], contact) {
            self.mark(node, state);
        }
        if self.lies_flat(boundary.nodes.edge_before[node], contact) {
            self.mark(boundary.nodes.previous[node], state);
        }
    }

    /// Whether an edge lies flat on that of a contact.
    fn lies_flat(&self, edge: EdgeId, contact: &VertexEdge) -> bool {
        let along = self.positions[self.boundary.after(edge)] - self.positions[edge];
        Vector::new(along.y, -along.x).dot(&contact.normal) < FLAT * along.norm()
    }

    /// Marks the edges from a node to the next one.
    fn mark(&mut self, node: NodeId, state: ContactState) {
        let boundary = self.boundary;
        let mut edge = boundary.nodes.point[node];
        let end = boundary.nodes.point[boundary.nodes.next[node]];
        loop {
            if self.found[edge] != Some(ContactState::Slip) {
                self.found[edge] = Some(state);
            }
            edge = boundary.after(edge);
            if edge == end {
                break;
            }
        }
    }
}
