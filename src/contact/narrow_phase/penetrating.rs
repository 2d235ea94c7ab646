//! What bears a node: how deep its contacts with other blocks have let it in.

use crate::contact::{Boundary, ContactHistory};
use crate::geometry::Vector;

use super::{Frames, NarrowPhase};

/// A contact of the last step that is in penetration at the present slots.
#[derive(Debug, Clone, Copy)]
struct PenetratingContact {
    /// Side that the node is in.
    side: u32,
    /// Sides before and after the node.
    own: [u32; 2],
    /// How deep (m) the node is, as far as the contact bears.
    closure: f64,
    /// Direction out of the side.
    outward: Vector,
}

/// The contacts of the last step that are in penetration, by their nodes and by the node segments that they lie on.
#[doc(alias = "overlap")]
#[doc(alias = "bearing")]
#[derive(Debug, Clone, Default)]
pub struct PenetratingContacts {
    /// First of each node, and their number.
    first: Vec<u32>,
    /// Bearings, ordered by node and side.
    penetrating: Vec<PenetratingContact>,
    /// First slot of those on the segment after each node, and their number.
    first_after: Vec<u32>,
    /// Bearings by segment.
    after: Vec<u32>,
    /// Segment of each.
    segment: Vec<u32>,
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
        first_after.clear();
        first_after.resize(boundary.node_count() + 1, 0);
        segment.iter().for_each(|&node| first_after[node as usize] += 1);
        let mut end = 0;
        for count in first_after.iter_mut() {
            end += *count;
            *count = end;
        }
        after.resize(segment.len(), 0);
        for (k, &node) in segment.iter().enumerate().rev() {
            let slot = &mut first_after[node as usize];
            *slot -= 1;
            after[*slot as usize] = k as u32;
        }
    }

    fn find(&mut self, boundary: &Boundary, frames: &Frames, history: &[ContactHistory]) {
        let Self { first, penetrating, segment, .. } = self;
        first.clear();
        penetrating.clear();
        segment.clear();
        for contact in history {
            let (node, edge) = (contact.node as usize, &frames.edges[contact.edge as usize]);
            let gap = (frames.nodes[node].position - edge.start).dot(&edge.normal());
            let closure = (-gap).max(0.0) * contact.share;
            if closure > 0.0 {
                first.resize(first.len().max(node + 1), penetrating.len() as u32);
                segment.push(boundary.node_before[contact.edge as usize]);
                let own = boundary.sides_of_node(node);
                penetrating.push(PenetratingContact { side: contact.side, own, closure, outward: edge.normal() });
            }
        }
        first.resize(boundary.node_count() + 1, penetrating.len() as u32);
    }

    /// Those of a node.
    #[inline(always)]
    fn of_node(&self, node: usize) -> &[PenetratingContact] {
        &self.penetrating[self.first[node] as usize..self.first[node + 1] as usize]
    }

    /// Those on the segment after a node.
    #[inline(always)]
    fn after(&self, node: usize) -> impl Iterator<Item = &PenetratingContact> {
        let slots = self.first_after[node] as usize..self.first_after[node + 1] as usize;
        self.after[slots].iter().map(|&k| &self.penetrating[k as usize])
    }
}

impl NarrowPhase<'_> {
    /// Contacts of a node in the last step.
    #[inline(always)]
    pub(super) fn known(&self, node: usize) -> &[ContactHistory] {
        &self.history[self.cache.of_node(node)]
    }

    /// How deep (m) a contact of a node with a side is, as far as it bears; 0 where it was none in the last step.
    #[inline(always)]
    pub(super) fn closure_with(&self, node: usize, side: u32) -> f64 {
        self.penetrating
            .of_node(node)
            .iter()
            .find(|contact| contact.side == side)
            .map_or(0.0, |contact| contact.closure)
    }

    /// How deep (m), along a direction, the contacts of a node and of the faces next to it have let it in, but for
    /// those with the sides `others`: how far it would move that way with their springs unloaded.
    #[inline(always)]
    pub(super) fn let_in(&self, node: usize, direction: Vector, others: [u32; 2]) -> f64 {
        let mut depth = 0.0f64;
        for contact in self.penetrating.of_node(node) {
            if !others.contains(&contact.side) {
                depth = depth.max(contact.closure * contact.outward.dot(&direction));
            }
        }
        for node in [self.boundary.node_previous[node] as usize, node] {
            for contact in self.penetrating.after(node) {
                if !contact.own.iter().any(|side| others.contains(side)) {
                    depth = depth.max(-contact.closure * contact.outward.dot(&direction));
                }
            }
        }
        depth
    }
}
