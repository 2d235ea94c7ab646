//! Nodes and the sides near them, as the narrow phase takes them: made once a search from the near pairs.

use enmm_lanes::{LANES, Places};

use crate::contact::frame::{EDGE_PAIRS, NODE_PAIRS};
use crate::contact::{Boundary, ContactHistory, NearPair, NodeId, SideId};

/// Near pairs in a run, which one thread takes: fixed, so that the order does not depend on threads.
const RUN: usize = 4096;

/// A node and a side near it: some near pairs in a row, one of each near edge of the side.
#[derive(Debug, Clone, Copy)]
pub struct NearSide {
    /// Node.
    pub node: NodeId,
    /// Side.
    pub side: SideId,
    /// Index of the first near pair.
    pub first: u32,
    /// Nodes before and after its near edges.
    pub ends: [NodeId; 2],
}

/// Eight near sides of one run with equally many near edges. Lanes without one repeat the first.
#[derive(Debug, Clone)]
pub(super) struct Batch {
    /// Near sides, counted from the first of the run.
    pub near_sides: [u32; LANES],
    /// Pairs of the nodes.
    pub nodes: Places,
    /// Near edges of each.
    pub edges: u32,
}

/// Ends of a run.
#[derive(Debug, Clone, Copy, Default)]
struct End {
    near_sides: usize,
    batches: usize,
    places: usize,
}

/// All near sides, ordered by node and side, in runs.
#[derive(Debug, Clone, Default)]
pub struct NearSides {
    near_sides: Vec<NearSide>,
    batches: Vec<Batch>,
    /// Pairs of the near edges, edge by edge of each batch.
    places: Vec<Places>,
    /// Where each run ends.
    ends: Vec<End>,
    /// Near sides of a run by their numbers of near edges.
    order: Vec<usize>,
    /// Number of near pairs.
    near_pairs: usize,
}

/// A run of near sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct NearRun<'a> {
    /// Near sides.
    pub near_sides: &'a [NearSide],
    /// Index of the first.
    pub first: usize,
    /// The same, eight side by side.
    pub batches: &'a [Batch],
    /// Pairs of the near edges, edge by edge of each batch.
    pub places: &'a [Places],
}

impl NearSides {
    /// Bytes of the lists.
    pub fn bytes(&self) -> usize {
        let Self { near_sides, batches, places, ends, order, .. } = self;
        let of_batches = size_of_val(&batches[..]) + size_of_val(&places[..]);
        size_of_val(&near_sides[..]) + of_batches + size_of_val(&ends[..]) + size_of_val(&order[..])
    }

    /// Makes the next step renew the list: the near pairs have changed.
    pub fn forget(&mut self) {
        self.near_sides.clear();
    }

    /// All of them.
    pub fn as_slice(&self) -> &[NearSide] {
        &self.near_sides
    }

    /// The near pairs of one of them.
    pub fn pairs_of<'a>(&self, near_pairs: &'a [NearPair], k: usize) -> &'a [NearPair] {
        pairs_of(&self.near_sides, near_pairs, k)
    }

    /// Lists the near sides of near pairs, unless they are listed.
    pub fn list(&mut self, boundary: &Boundary, near_pairs: &[NearPair]) {
        if !self.near_sides.is_empty() && self.near_pairs == near_pairs.len() {
            return;
        }
        let Self { near_sides, batches, places, ends, .. } = self;
        near_sides.clear();
        batches.clear();
        places.clear();
        ends.clear();
        let mut first = 0;
        for pairs in near_pairs.chunk_by(|a, b| (a.node, a.side) == (b.node, b.side)) {
            let [before, last] = [pairs[0], pairs[pairs.len() - 1]].map(|pair| boundary.node_before[pair.edge]);
            let ends = [before, boundary.nodes.next[last]];
            near_sides.push(NearSide { node: pairs[0].node, side: pairs[0].side, first, ends });
            first += pairs.len() as u32;
        }
        self.near_pairs = near_pairs.len();
        self.divide(near_pairs);
    }

    /// Divides the near sides into runs of whole nodes.
    fn divide(&mut self, near_pairs: &[NearPair]) {
        let mut start = 0;
        while start < self.near_sides.len() {
            let limit = self.near_sides[start].first as usize + RUN;
            let mut end = start + 1;
            while end < self.near_sides.len()
                && ((self.near_sides[end].first as usize) < limit
                    || self.near_sides[end].node == self.near_sides[end - 1].node)
            {
                end += 1;
            }
            self.batch(near_pairs, start..end);
            self.ends.push(End { near_sides: end, batches: self.batches.len(), places: self.places.len() });
            start = end;
        }
    }

    /// Puts the near sides of a run side by side, those with equally many near edges together.
    fn batch(&mut self, near_pairs: &[NearPair], run: std::ops::Range<usize>) {
        let Self { near_sides, batches, places, order, .. } = self;
        let count = |k: usize| pairs_of(near_sides, near_pairs, k).len();
        order.clear();
        order.extend(run.clone());
        order.sort_unstable_by_key(|&k| (count(k), k));
        for equal in order.chunk_by(|&a, &b| count(a) == count(b)) {
            for some in equal.chunks(LANES) {
                let lane = |k: usize| some[if k < some.len() { k } else { 0 }];
                let at: [usize; LANES] = std::array::from_fn(lane);
                let edges = count(some[0]);
                let nodes = at.map(|k| NODE_PAIRS as u32 * near_sides[k].node.number());
                batches.push(Batch {
                    near_sides: at.map(|k| (k - run.start) as u32),
                    nodes: Places::new(&nodes),
                    edges: edges as u32,
                });
                for edge in 0..edges {
                    let edge = |k: usize| pairs_of(near_sides, near_pairs, k)[edge].edge.number();
                    places.push(Places::new(&at.map(|k| EDGE_PAIRS as u32 * edge(k))));
                }
            }
        }
    }

    /// Number of runs.
    pub(super) fn runs(&self) -> usize {
        self.ends.len()
    }

    /// A run.
    pub(super) fn run(&self, k: usize) -> NearRun<'_> {
        let from = if k == 0 { End::default() } else { self.ends[k - 1] };
        let to = self.ends[k];
        NearRun {
            near_sides: &self.near_sides[from.near_sides..to.near_sides],
            first: from.near_sides,
            batches: &self.batches[from.batches..to.batches],
            places: &self.places[from.places..to.places],
        }
    }
}

fn pairs_of<'a>(near_sides: &[NearSide], near_pairs: &'a [NearPair], k: usize) -> &'a [NearPair] {
    let end = near_sides.get(k + 1).map_or(near_pairs.len(), |next| next.first as usize);
    &near_pairs[near_sides[k].first as usize..end]
}

impl NearRun<'_> {
    /// Nodes from the first to the one after the last.
    pub fn nodes(&self) -> [usize; 2] {
        let ends = self.near_sides.first().zip(self.near_sides.last());
        ends.map_or([0; 2], |(first, last)| [first.node.index(), last.node.index() + 1])
    }

    /// The near side of a contact of the last step, counted from the first of the run; `guess` is one to try first.
    pub fn of(&self, contact: &ContactHistory, guess: usize) -> Option<usize> {
        let key = (contact.node, contact.side);
        let is_it = |near: &NearSide| (near.node, near.side) == key;
        if self.near_sides.get(guess).is_some_and(is_it) {
            return Some(guess);
        }
        self.near_sides.binary_search_by_key(&key, |near| (near.node, near.side)).ok()
    }
}
