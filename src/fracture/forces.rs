//! Forces on blocks from outside in a step: contacts, supports, bolts and loads.

use crate::contact::{Boundary, EdgeId, NodeId, VertexEdge};
use crate::cover::{self, BlockId, CoverId, Weights};
use crate::geometry::{Point, Vector};
use crate::mechanics::Forces;
use crate::state::{Model, State, Workspace};
use crate::step::{self, Regime};

/// Cosine above which the faces of a node are one.
const ALONG: f64 = 0.9;

/// A force on a block, at a point or spread over a piece of its boundary.
#[derive(Debug, Clone, Copy)]
pub struct BlockForce {
    /// The force (N/m).
    pub force: Vector,
    /// Where it acts now (m).
    pub at: Point,
    /// Its covers.
    pub covers: [CoverId; 3],
    /// Their weights there.
    pub weights: Weights,
    /// Ends of the piece in the reference configuration (m); of a force at a point it is that twice.
    pub piece: [Point; 2],
}

/// The forces on those blocks that are looked at.
pub struct BlockForces<'a> {
    model: &'a Model,
    state: &'a State,
    /// Place of each block among those that are looked at.
    place: Vec<Option<usize>>,
    forces: Vec<Vec<BlockForce>>,
}

impl<'a> BlockForces<'a> {
    /// Those of the last step on some blocks, which began at a time (s).
    pub fn of_step(
        (model, state, workspace): (&'a Model, &'a State, &Workspace),
        blocks: &[BlockId],
        (regime, time): (Regime, f64),
    ) -> Vec<Vec<BlockForce>> {
        let mut place = vec![None; model.covers.block_count()];
        blocks.iter().enumerate().for_each(|(k, block)| place[block.index()] = Some(k));
        let mut all = Self { model, state, place, forces: vec![Vec::new(); blocks.len()] };
        workspace.contacts.iter().for_each(|contact| all.push_contact(contact));
        for row in &workspace.supports.rows {
            let support = &model.supports[row.support as usize];
            all.at_point(&support.covers, &support.weights, support.direction * row.force);
        }
        for row in &workspace.supports.bolts {
            all.at_point(&row.pair.covers[0], &row.pair.weights[0], row.direction * -row.force);
            all.at_point(&row.pair.covers[1], &row.pair.weights[1], row.direction * row.force);
        }
        step::push_forces(model, state, regime, time, &mut all);
        all.forces
    }

    /// Takes the force of a contact on node and edge, over its length on both.
    fn push_contact(&mut self, contact: &VertexEdge) {
        let on_node = contact.normal * contact.history.normal_force + contact.tangent() * contact.history.shear_force;
        if on_node == Vector::zeros() {
            return;
        }
        let boundary = &self.model.boundary;
        let pair = contact.pair(boundary);
        let edge = way(boundary, contact.history.edge);
        let node = piece_of_node(boundary, contact.history.node, contact.point, contact.length);
        let at = self.reference(&pair.covers[1], &pair.weights[1]);
        let reach = edge * (0.5 * contact.length);
        self.push(&pair.covers[0], &pair.weights[0], on_node, node);
        self.push(&pair.covers[1], &pair.weights[1], -on_node, [at - reach, at + reach]);
    }

    fn push(&mut self, covers: &[CoverId; 3], weights: &Weights, force: Vector, piece: [Point; 2]) {
        let block = self.model.covers.cover_block[covers[0]];
        if let Some(k) = self.place[block.index()] {
            let moved = cover::sample(covers, weights, &self.state.displacement);
            let at = self.reference(covers, weights) + moved;
            self.forces[k].push(BlockForce { force, at, covers: *covers, weights: *weights, piece });
        }
    }

    /// Place of a material point in the reference configuration (m).
    fn reference(&self, covers: &[CoverId; 3], weights: &Weights) -> Point {
        cover::sample(covers, weights, &self.model.covers.star_position)
    }
}

/// Unit vector along an edge in the reference configuration.
fn way(boundary: &Boundary, edge: EdgeId) -> Vector {
    (boundary.reference[boundary.after(edge)] - boundary.reference[edge]).normalize()
}

/// The piece of a length (m) that a node stands for: to both sides of it, but at a corner the corner alone.
fn piece_of_node(boundary: &Boundary, node: NodeId, point: EdgeId, length: f64) -> [Point; 2] {
    let at = boundary.reference[point];
    let [before, after] = boundary.edges_of_node(node).map(|edge| way(boundary, edge));
    if before.dot(&after) > ALONG {
        return [at - before * (0.5 * length), at + after * (0.5 * length)];
    }
    [at, at]
}

impl Forces for BlockForces<'_> {
    fn at_point(&mut self, covers: &[CoverId; 3], weights: &Weights, force: Vector) {
        let at = self.reference(covers, weights);
        self.push(covers, weights, force, [at, at]);
    }

    fn on_piece(&mut self, covers: &[CoverId; 3], ends: &[Weights; 2], force: Vector) {
        let middle = [0, 1, 2].map(|k| 0.5 * (ends[0][k] + ends[1][k]));
        let piece = ends.map(|weights| self.reference(covers, &weights));
        self.push(covers, &middle, force, piece);
    }

    fn on_edge(&mut self, covers: &[[CoverId; 3]; 2], weights: &[Weights; 2], forces: [Vector; 2]) {
        let [a, b] = [0, 1].map(|e| self.reference(&covers[e], &weights[e]));
        let middle = (a + b) * 0.5;
        self.push(&covers[0], &weights[0], forces[0], [a, middle]);
        self.push(&covers[1], &weights[1], forces[1], [middle, b]);
    }

    // It acts by mass, as gravity does, and is no part of what a section carries.
    fn on_rock(&mut self, _: CoverId, _: Vector) {}
}
