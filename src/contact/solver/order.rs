//! The order in which contacts are solved: a function of the near pairs, hence of the state, never of the threads.
//!
//! All contacts of two blocks are a block pair. Blocks are cut into runs of like work, which are the leaves of a binary
//! tree. What lies within a run is solved before what lies between two runs, so that both halves of any part of the
//! tree can be swept at once. Within a part block pairs come by colour: no two of a colour share a free block, or a
//! cover of a held one, so that eight of them are solved side by side.

use std::cmp::Reverse;

use enmm_lanes::LANES;

use crate::contact::{Boundary, EdgeId, NearPair, NearSides};
use crate::cover::{BlockId, CoverId};

use super::SolverView;
use super::wide_pairs::WidePairs;

/// Near pairs of nodes and sides above which a run of blocks is cut.
const LEAF: usize = 4096;
/// Most runs of blocks.
const LEAVES_MAX: usize = 4096;
/// The last colour: its block pairs may share what they push, and are solved one by one.
const OVERFLOW: u32 = u64::BITS - 1;

/// In what block pair every near side is.
#[doc(alias = "graph colouring")]
#[doc(alias = "islands")]
#[derive(Debug, Clone, Default)]
pub struct SolverOrder {
    /// Block pair of each near side.
    block_pair: Vec<u32>,
    /// Block pairs in the order in which they are solved.
    block_pairs: Vec<BlockPair>,
    /// First block of each run of blocks, and the number of blocks.
    leaf_block: Vec<BlockId>,
    entries: Vec<Entry>,
    leaf: Vec<u32>,
    colours: Colours,
    /// Of a step: the number of contacts of each block pair, then the slot of its next.
    count: Vec<u32>,
    /// Block pairs of a colour that have contacts.
    touching: Vec<u32>,
}

/// A near side, by the blocks that it and the node belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    subdomain: u32,
    blocks: [BlockId; 2],
    near_side: u32,
}

/// All near sides of two blocks, a free one first when there is one: a range of the entries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct BlockPair {
    subdomain: u32,
    colour: u32,
    first: u32,
    end: u32,
    blocks: [BlockId; 2],
}

/// Colours that free blocks and covers of held ones have got in a part, a bit each.
#[derive(Debug, Clone, Default)]
struct Colours {
    of_block: Vec<u64>,
    of_cover: Vec<u64>,
    /// Covers of held blocks of the block pair in hand, and all that have a colour.
    covers: Vec<CoverId>,
    seen: Vec<CoverId>,
}

/// Block pairs of a step in the order in which they are solved.
#[derive(Debug, Clone, Default)]
pub struct Sequence {
    /// Eight side by side.
    pub wide_pairs: Vec<WidePairs>,
    /// The number of them up to the end of each part.
    pub ends: Vec<u32>,
    /// First turn of each row, and the number of turns. A row has as many contacts as there are block pairs with so
    /// many, in the first lanes.
    pub first_turn: Vec<u32>,
    /// Contact of each turn.
    pub contacts: Vec<u32>,
    /// Slot of each contact: its row times the number of lanes, and its lane.
    pub slots: Vec<u32>,
}

impl SolverOrder {
    /// Bytes of the order and of what it is made with.
    pub fn bytes(&self) -> usize {
        let Self { block_pair, leaf, count, touching, leaf_block, .. } = self;
        let lists = [block_pair, leaf, count, touching];
        let order = size_of_val(self.block_pairs.as_slice()) + size_of_val(leaf_block.as_slice());
        let colours = size_of_val(self.colours.of_block.as_slice()) + size_of_val(self.colours.of_cover.as_slice());
        let lists = lists.map(|list| size_of_val(list.as_slice())).iter().sum::<usize>();
        order + lists + colours + size_of_val(self.entries.as_slice())
    }

    /// Whether it has to be made.
    pub fn is_empty(&self) -> bool {
        self.leaf_block.is_empty()
    }

    /// Makes the next step order anew.
    pub fn clear(&mut self) {
        self.leaf_block.clear();
    }

    /// First block of each run of blocks, and the number of blocks at the end.
    pub fn leaf_block(&self) -> &[BlockId] {
        &self.leaf_block
    }

    /// Orders near sides.
    pub fn order(&mut self, boundary: &Boundary, near_pairs: &[NearPair], near_sides: &NearSides, view: &SolverView) {
        self.entries.clear();
        self.entries.extend((0..).zip(near_sides.as_slice()).map(|(near_side, near)| {
            let points = [boundary.node_point[near.node], near_pairs[near.first as usize].edge];
            let [own, other] = points.map(|point| boundary.block[point]);
            Entry { subdomain: 0, blocks: [own.min(other), own.max(other)], near_side }
        }));
        self.cut(view);
        for entry in &mut self.entries {
            entry.subdomain = subdomain_of(entry.blocks.map(|b| self.leaf[b]));
        }
        self.entries.sort_unstable();
        self.colour(boundary, near_pairs, near_sides, view);
        self.block_pair.resize(self.entries.len(), 0);
        for (index, block_pair) in (0u32..).zip(&self.block_pairs) {
            for entry in &self.entries[block_pair.first as usize..block_pair.end as usize] {
                self.block_pair[entry.near_side as usize] = index;
            }
        }
    }

    /// Cuts the blocks into runs of like work.
    fn cut(&mut self, view: &SolverView) {
        let mass_matrix = view.mass_matrix;
        let blocks = mass_matrix.total.len();
        self.leaf.clear();
        self.leaf.resize(blocks, 0);
        for entry in &self.entries {
            let [a, b] = entry.blocks;
            self.leaf[if mass_matrix.is_free(a) { a } else { b }] += 1;
        }
        let leaves = self.entries.len().div_ceil(LEAF).next_power_of_two().min(LEAVES_MAX);
        let total = self.entries.len().max(1);
        let mut before = 0;
        self.leaf_block.clear();
        for (block, leaf) in BlockId::all(blocks).zip(&mut self.leaf) {
            let kind = *leaf as usize;
            *leaf = (before * leaves / total).min(leaves - 1) as u32;
            self.leaf_block.resize((*leaf as usize + 1).max(self.leaf_block.len()), block);
            before += kind;
        }
        self.leaf_block.resize(leaves + 1, BlockId::new(blocks));
    }

    /// Gives every block pair the first colour that no earlier one of its part has given to what they both push.
    fn colour(&mut self, boundary: &Boundary, near_pairs: &[NearPair], near_sides: &NearSides, view: &SolverView) {
        self.block_pairs.clear();
        self.colours.begin(view);
        let (mut first, mut subdomain_first) = (0, 0);
        for run in self.entries.chunk_by(|a, b| (a.subdomain, a.blocks) == (b.subdomain, b.blocks)) {
            let subdomain = run[0].subdomain;
            if self.block_pairs.last().is_some_and(|m| m.subdomain != subdomain) {
                self.colours.forget(&self.entries[subdomain_first as usize..first as usize]);
                subdomain_first = first;
            }
            let [a, b] = run[0].blocks;
            let blocks = if view.mass_matrix.is_free(a) { [a, b] } else { [b, a] };
            self.colours.covers.clear();
            for entry in run {
                self.colours.meet(boundary, near_sides.pairs_of(near_pairs, entry.near_side as usize), view);
            }
            let colour = self.colours.give(blocks, view);
            let end = first + run.len() as u32;
            self.block_pairs.push(BlockPair { subdomain, colour, first, end, blocks });
            first = end;
        }
        self.block_pairs.sort_unstable();
    }

    /// Puts the block pairs and the contacts of a step in the order of their turns.
    ///
    /// `near_sides` are those of the contacts.
    pub fn arrange(&mut self, near_sides: &[u32], view: &SolverView, sequence: &mut Sequence) {
        let Sequence { wide_pairs, ends, first_turn, contacts, slots } = sequence;
        self.count_contacts(near_sides, slots);
        wide_pairs.clear();
        ends.clear();
        first_turn.clear();
        let (mut first, mut turns) = (0, 0);
        for class in self.block_pairs.chunk_by(|a, b| (a.subdomain, a.colour) == (b.subdomain, b.colour)) {
            ends.resize(class[0].subdomain as usize, wide_pairs.len() as u32);
            let all = first..first + class.len() as u32;
            first = all.end;
            self.touching.clear();
            self.touching.extend(all.filter(|&m| self.count[m as usize] > 0));
            self.touching.sort_unstable_by_key(|&m| (Reverse(self.count[m as usize]), m));
            for some in self.touching.chunks(if class[0].colour == OVERFLOW { 1 } else { LANES }) {
                let first_row = first_turn.len() as u32;
                let counts = some.iter().map(|&m| self.count[m as usize]);
                for row in 0..self.count[some[0] as usize] {
                    first_turn.push(turns);
                    turns += counts.clone().filter(|&count| count > row).count() as u32;
                }
                let block_pairs = some.iter().map(|&m| (self.block_pairs[m as usize].blocks, self.count[m as usize]));
                wide_pairs.push(WidePairs::new(first_row, block_pairs, view));
                for (&m, lane) in some.iter().zip(0..) {
                    self.count[m as usize] = first_row * LANES as u32 + lane;
                }
            }
        }
        ends.resize(2 * (self.leaf_block.len() - 1) - 1, wide_pairs.len() as u32);
        first_turn.push(turns);
        contacts.resize(turns as usize, 0);
        for (slot, contact) in slots.iter_mut().zip(0..) {
            let next = &mut self.count[*slot as usize];
            *slot = *next;
            *next += LANES as u32;
            let turn = first_turn[(*slot / LANES as u32) as usize] + *slot % LANES as u32;
            contacts[turn as usize] = contact;
        }
    }

    /// Finds the block pair of each contact, and the number of contacts of each block pair.
    fn count_contacts(&mut self, near_sides: &[u32], block_pairs: &mut Vec<u32>) {
        self.count.clear();
        self.count.resize(self.block_pairs.len(), 0);
        block_pairs.clear();
        block_pairs.extend(near_sides.iter().map(|&near_side| self.block_pair[near_side as usize]));
        block_pairs.iter().for_each(|&block_pair| self.count[block_pair as usize] += 1);
    }
}

impl Colours {
    /// No colours yet.
    fn begin(&mut self, view: &SolverView) {
        self.seen.clear();
        self.of_block.clear();
        self.of_block.resize(view.mass_matrix.total.len(), 0);
        self.of_cover.clear();
        self.of_cover.resize(view.roots.len(), 0);
    }

    /// Another part begins after some entries.
    fn forget(&mut self, entries: &[Entry]) {
        entries.iter().flat_map(|entry| entry.blocks).for_each(|block| self.of_block[block] = 0);
        self.seen.drain(..).for_each(|cover| self.of_cover[cover] = 0);
    }

    /// Covers of held blocks that a node and the near edges of a side may push.
    fn meet(&mut self, boundary: &Boundary, edges: &[NearPair], view: &SolverView) {
        let is_held = |point: EdgeId| !view.mass_matrix.is_free(boundary.block[point]);
        let node = boundary.node_point[edges[0].node];
        if is_held(node) {
            self.covers.extend(boundary.covers[node]);
        }
        for edge in edges.iter().map(|near_pair| near_pair.edge).filter(|&edge| is_held(edge)) {
            self.covers.extend(boundary.covers_on(edge));
        }
    }

    /// The first colour that a block pair in hand may have.
    fn give(&mut self, blocks: [BlockId; 2], view: &SolverView) -> u32 {
        let free = blocks.map(|block| view.mass_matrix.is_free(block));
        let of_blocks = (0..2).filter(|&k| free[k]).map(|k| self.of_block[blocks[k]]);
        let of_covers = self.covers.iter().map(|&cover| self.of_cover[cover]);
        let used: u64 = of_blocks.chain(of_covers).fold(0, |a, b| a | b);
        let colour = (!used).trailing_zeros().min(OVERFLOW);
        (0..2).filter(|&k| free[k]).for_each(|k| self.of_block[blocks[k]] |= 1 << colour);
        self.covers.iter().for_each(|&cover| self.of_cover[cover] |= 1 << colour);
        self.seen.extend_from_slice(&self.covers);
        colour
    }
}

/// The smallest part of the tree that holds two leaves, by its slot in the order in which parts are swept: both halves
/// before the whole.
fn subdomain_of([a, b]: [u32; 2]) -> u32 {
    let level = u32::BITS - (a ^ b).leading_zeros();
    let last = (((a >> level) + 1) << level) - 1;
    2 * last - last.count_ones() + level
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_come_before_the_whole() {
        let slots: Vec<u32> =
            [[0, 0], [1, 1], [0, 1], [2, 2], [3, 3], [2, 3], [1, 2]].into_iter().map(subdomain_of).collect();
        assert_eq!(slots, [0, 1, 2, 3, 4, 5, 6]);
        assert_eq!(subdomain_of([0, 7]), 14);
    }
}
