//! Contacts of the last step, by node, and those of them in penetration. The vertex rule asks them who carried force,
//! and subtracts the compression of their springs from depths.

use std::ops::Range;

use crate::contact::{Boundary, ContactHistory, ContactState, NodeId, SideId, buckets};
use crate::geometry::Vector;

use super::{Frames, VertexRule};

/// Index of the contacts of the last step by node; their list is ordered by node and side.
#[doc(alias = "persistent manifold")]
#[derive(Debug, Clone, Default)]
pub struct ContactCache {
    /// First contact of each node, and the number of contacts.
    first: Vec<u32>,
}

impl ContactCache {
    /// Bytes of the buffer.
    pub fn bytes(&self) -> usize {
        size_of_val(self.first.as_slice())
    }

    /// Indexes contacts by their nodes, of which there are `nodes`.
    pub fn index(&mut self, history: &[ContactHistory], nodes: usize) {
        self.first.clear();
        for (k, contact) in history.iter().enumerate() {
            self.first.resize(self.first.len().max(contact.node.index() + 1), k as u32);
        }
        self.first.resize(nodes + 1, history.len() as u32);
    }

    /// Contacts of the nodes from the first to the one after the last.
    #[inline(always)]
    pub(in crate::contact) fn of_nodes(&self, [first, end]: [usize; 2]) -> Range<usize> {
        self.first[first] as usize..self.first[end] as usize
    }

    /// Contacts of a node.
    #[inline(always)]
    pub(in crate::contact) fn of_node(&self, node: NodeId) -> Range<usize> {
        self.of_nodes([node.index(), node.index() + 1])
    }
}

/// A contact of the last step that is in penetration at the current positions.
#[derive(Debug, Clone, Copy)]
struct PenetratingContact {
    /// Side that the node is in.
    side: SideId,
    /// Sides before and after the node.
    own: [SideId; 2],
    /// Compression (m) of the spring: the depth of the node, as far as the contact carries force.
    closure: f64,
    /// Direction out of the side.
    outward: Vector,
}

/// The contacts of the last step that are in penetration, by node and by node segment.
#[doc(alias = "overlap")]
#[doc(alias = "bearing")]
#[derive(Debug, Clone, Default)]
pub struct PenetratingContacts {
    /// Index of the first contact of each node, and the number of contacts.
    first: Vec<u32>,
    /// Contacts, ordered by node and side.
    penetrating: Vec<PenetratingContact>,
    /// Index of the first contact on the segment after each node, and the number of contacts.
    first_after: Vec<u32>,
    /// Contacts by segment.
    after: Vec<u32>,
    /// Segment of each.
    segment: Vec<NodeId>,
}

impl PenetratingContacts {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        let indices = self.first.len() + self.first_after.len() + self.after.len() + self.segment.len();
        size_of::<u32>() * indices + size_of_val(self.penetrating.as_slice())
    }

    /// Finds which contacts are in penetration and sorts them by segment; within one they keep their order.
    pub fn index(&mut self, boundary: &Boundary, frames: &Frames, history: &[ContactHistory]) {
        self.find(boundary, frames, history);
        let Self { first_after, after, segment, .. } = self;
        buckets::sort(segment.len(), boundary.node_count(), |k| segment[k].index(), first_after, after);
    }

    fn find(&mut self, boundary: &Boundary, frames: &Frames, history: &[ContactHistory]) {
        let Self { first, penetrating, segment, .. } = self;
        first.clear();
        penetrating.clear();
        segment.clear();
        for contact in history {
            let (node, edge) = (contact.node, frames.edge(contact.edge));
            let gap = (frames.node(node).position - edge.start).dot(&edge.normal());
            let closure = (-gap).max(0.0) * contact.share;
            if closure > 0.0 {
                first.resize(first.len().max(node.index() + 1), penetrating.len() as u32);
                segment.push(boundary.node_before[contact.edge]);
                let own = boundary.sides_of_node(node);
                penetrating.push(PenetratingContact { side: contact.side, own, closure, outward: edge.normal() });
            }
        }
        first.resize(boundary.node_count() + 1, penetrating.len() as u32);
    }

    /// Contacts of a node.
    #[inline(always)]
    fn of_node(&self, node: NodeId) -> &[PenetratingContact] {
        &self.penetrating[self.first[node] as usize..self.first[node.index() + 1] as usize]
    }

    /// Contacts on the segment after a node.
    #[inline(always)]
    fn after(&self, node: NodeId) -> impl Iterator<Item = &PenetratingContact> {
        let slots = self.first_after[node] as usize..self.first_after[node.index() + 1] as usize;
        self.after[slots].iter().map(|&k| &self.penetrating[k as usize])
    }
}

impl VertexRule<'_> {
    /// Whether a node carried force against a side in the last step.
    pub(super) fn carries(&self, node: NodeId, side: SideId) -> bool {
        let known = &self.history[self.cache.of_node(node)];
        known.iter().any(|h| h.side == side && h.state != ContactState::Open)
    }

    /// Compression (m) of the contact of a node with a side; 0 if there was none in the last step.
    #[inline(always)]
    pub(super) fn closure_with(&self, node: NodeId, side: SideId) -> f64 {
        let contacts = self.penetrating.of_node(node);
        contacts.iter().find(|contact| contact.side == side).map_or(0.0, |contact| contact.closure)
    }

    /// Compression (m), along a direction, of the contacts of a node and of the faces next to it, except those with the
    /// sides `others`: the node would move so far if their springs were unloaded.
    #[inline(always)]
    pub(super) fn closure_along(&self, node: NodeId, direction: Vector, others: [SideId; 2]) -> f64 {
        let mut depth = 0.0f64;
        for contact in self.penetrating.of_node(node) {
            if !others.contains(&contact.side) {
                depth = depth.max(contact.closure * contact.outward.dot(&direction));
            }
        }
        for node in [self.boundary.nodes.previous[node], node] {
            for contact in self.penetrating.after(node) {
                if !contact.own.iter().any(|side| others.contains(side)) {
                    depth = depth.max(-contact.closure * contact.outward.dot(&direction));
                }
            }
        }
        depth
    }
}
