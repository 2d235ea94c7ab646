//! Forces of water and ports on edges of the boundary at their current positions.

use crate::contact::EdgeId;
use crate::cover::{BlockId, ElementId};
use crate::geometry::{Point, Vector};
use crate::mechanics::{Forces, pressure};
use crate::state::{Model, Port, State, Water};

/// Boundary edges at their current positions.
pub(super) struct Faces<'a> {
    pub model: &'a Model,
    pub state: &'a State,
}

impl Faces<'_> {
    /// Pushes what still water reaches, below its `level` (m).
    pub fn push_water(&self, water: &Water, level: f64, weight: f64, force: &mut (impl Forces + ?Sized)) {
        let surface = &water.surfaces[self.state.stage as usize];
        let rise = level - surface.level;
        for &edge in &water.edges {
            let [a, b] = self.ends(edge);
            let forces = if surface.table.is_empty() {
                pressure::hydrostatic(a, b, level, weight)
            } else {
                pressure::under_table(a, b, &surface.table, rise, weight)
            };
            self.spread(edge, self.porous_sliver(edge), forces, force);
        }
    }

    /// Pushes the faces of a port.
    pub fn push_port(&self, port: &Port, traction: Vector, pressure: f64, force: &mut (impl Forces + ?Sized)) {
        if traction == Vector::zeros() && pressure == 0.0 {
            return;
        }
        let reference = &self.model.boundary.reference;
        for &edge in &port.edges {
            let length = (reference[self.model.boundary.after(edge)] - reference[edge]).norm();
            let dead = traction * (0.5 * length);
            if pressure == 0.0 {
                self.spread(edge, None, [dead; 2], force);
            } else {
                let [a, b] = self.ends(edge);
                self.spread(edge, None, pressure::uniform(a, b, pressure).map(|f| f + dead), force);
            }
        }
    }

    /// The sliver on which an edge lies, if it has pores.
    pub fn porous_sliver(&self, edge: EdgeId) -> Option<ElementId> {
        self.model.boundary.sliver(edge).filter(|&sliver| self.model.is_porous(sliver))
    }

    /// Block of an edge.
    pub fn block(&self, edge: EdgeId) -> BlockId {
        self.model.boundary.block[edge]
    }

    /// Whether the block of an edge has been dug out.
    pub fn is_gone(&self, edge: EdgeId) -> bool {
        self.state.removed[self.block(edge)]
    }

    /// Current positions of both ends of an edge (m).
    pub fn ends(&self, edge: EdgeId) -> [Point; 2] {
        let boundary = &self.model.boundary;
        let stars = &self.model.covers.star_position;
        [edge, boundary.after(edge)].map(|k| boundary.sample(k, stars) + boundary.sample(k, &self.state.displacement))
    }

    /// Spreads forces at both ends of an edge over their covers, or over those of its sliver, whose pores have a
    /// pressure that balances them.
    pub fn spread(
        &self,
        edge: EdgeId,
        sliver: Option<ElementId>,
        forces: [Vector; 2],
        force: &mut (impl Forces + ?Sized),
    ) {
        let Model { boundary, covers, .. } = self.model;
        if self.is_gone(edge) {
            return;
        }
        let ends = [edge, boundary.after(edge)].map(|k| match sliver {
            Some(sliver) => (covers.element_covers[sliver], covers.weights(sliver, boundary.reference[k])),
            None => (boundary.covers[k], boundary.weights[k]),
        });
        force.on_edge(&ends.map(|end| end.0), &ends.map(|end| end.1), forces);
    }
}
