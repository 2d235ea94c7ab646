//! What bears a node: how deep its contacts with other blocks have let it in.

use crate::contact::{Boundary, ContactHistory};
use crate::geometry::Vector;

use super::Narrow;

/// The contacts of the last step by the node segment that they lie on.
#[derive(Debug, Clone, Default)]
pub struct Bearings {
    /// First place of the contacts on the segment after each node, and their number.
    first: Vec<u32>,
    /// Contacts by segment.
    contacts: Vec<u32>,
}

impl Bearings {
    /// Bytes of the buffers.
    pub fn bytes(&self) -> usize {
        size_of_val(self.first.as_slice()) + size_of_val(self.contacts.as_slice())
    }

    /// Sorts contacts by segment; within one they keep their order.
    pub fn index(&mut self, boundary: &Boundary, history: &[ContactHistory]) {
        let Self { first, contacts } = self;
        let segment = |contact: &ContactHistory| boundary.node_before[contact.edge as usize] as usize;
        first.clear();
        first.resize(boundary.node_count() + 1, 0);
        history.iter().for_each(|contact| first[segment(contact)] += 1);
        let mut end = 0;
        for count in first.iter_mut() {
            end += *count;
            *count = end;
        }
        contacts.resize(history.len(), 0);
        for (k, contact) in history.iter().enumerate().rev() {
            let place = &mut first[segment(contact)];
            *place -= 1;
            contacts[*place as usize] = k as u32;
        }
    }

    /// Contacts on the segment after a node.
    #[inline(always)]
    fn after(&self, node: usize) -> &[u32] {
        &self.contacts[self.first[node] as usize..self.first[node + 1] as usize]
    }
}

impl Narrow<'_> {
    /// Contacts of a node in the last step.
    #[inline(always)]
    pub(super) fn known(&self, node: usize) -> &[ContactHistory] {
        &self.history[self.remembered.of_node(node)]
    }

    /// How deep (m) a contact is at the present places, as far as it bears, and the direction out of its side.
    #[inline(always)]
    fn closure(&self, contact: &ContactHistory) -> (f64, Vector) {
        let edge = &self.frames.edges[contact.edge as usize];
        let gap = (self.node_place(contact.node as usize) - edge.start).dot(&edge.normal());
        ((-gap).max(0.0) * contact.share, edge.normal())
    }

    /// How deep (m) a contact of a node with a side is, as far as it bears; 0 where it was none in the last step.
    pub(super) fn closure_with(&self, node: usize, side: u32) -> f64 {
        self.known(node).iter().find(|contact| contact.side == side).map_or(0.0, |contact| self.closure(contact).0)
    }

    /// The sides before and after a node: those that lie towards the start and the finish of a side that it faces.
    pub(super) fn sides_at(&self, node: usize) -> [u32; 2] {
        self.boundary.edges_of_node(node).map(|edge| self.boundary.side[edge as usize])
    }

    /// How deep (m), along a direction, the contacts of a node and of the faces next to it have let it in, but for
    /// those with the sides `others`: how far it would move that way with their springs unloaded.
    pub(super) fn let_in(&self, node: usize, direction: Vector, others: [u32; 2]) -> f64 {
        let boundary = self.boundary;
        let mut depth = 0.0f64;
        for contact in self.known(node) {
            if !others.contains(&contact.side) {
                let (closure, outward) = self.closure(contact);
                depth = depth.max(closure * outward.dot(&direction));
            }
        }
        for node in [boundary.node_previous[node] as usize, node] {
            for &contact in self.bearings.after(node) {
                let contact = &self.history[contact as usize];
                if !self.sides_at(contact.node as usize).iter().any(|side| others.contains(side)) {
                    let (closure, outward) = self.closure(contact);
                    depth = depth.max(-closure * outward.dot(&direction));
                }
            }
        }
        depth
    }
}
