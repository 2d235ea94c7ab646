//! The order in which contacts are judged: a function of the near pairs, hence of the state, never of the threads.
//!
//! Blocks are cut into runs of like work, which are the leaves of a binary tree. What lies within a run is judged
//! before what lies between two runs, so that both halves of any part of the tree can be swept at once. Within a part
//! pairs of blocks come by colour: no two of a colour share a free block, and a few of them are judged abreast, so that
//! a contact seldom waits for the one before it.

use crate::contact::{Boundary, Candidate, VertexEdge};
use crate::geometry::NONE;
use crate::mechanics::Metric;

/// Near pairs of nodes and sides above which a run of blocks is cut.
const LEAF: usize = 1024;
/// Most runs of blocks.
const LEAVES_MAX: usize = 4096;
/// Pairs of blocks of one colour that are judged abreast.
const ABREAST: usize = 4;

/// Where every near pair of a node and a side has its turn.
#[derive(Debug, Clone, Default)]
pub struct SweepOrder {
    /// Near nodes and sides, sorted.
    keys: Vec<u64>,
    /// Turn of each.
    turn: Vec<u32>,
    /// Turn after the last one of each part of the tree, parts in the order in which they are swept.
    part_end: Vec<u32>,
    /// First block of each run of blocks, and the number of blocks.
    leaf_block: Vec<u32>,
    entries: Vec<Entry>,
    manifolds: Vec<Manifold>,
    leaf: Vec<u32>,
    colours: Vec<u64>,
    taken: Vec<u32>,
}

/// A near node and side, by the blocks that they belong to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    part: u32,
    blocks: [u32; 2],
    key: u32,
}

/// All near nodes and sides of two blocks: a range of the entries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Manifold {
    part: u32,
    colour: u32,
    held: bool,
    first: u32,
    end: u32,
}

impl SweepOrder {
    /// Bytes of the order and of what it is made with.
    pub fn bytes(&self) -> usize {
        let order = size_of_val(self.keys.as_slice()) + size_of_val(self.turn.as_slice());
        let making = size_of_val(self.entries.as_slice()) + size_of_val(self.manifolds.as_slice());
        order + making + size_of_val(self.colours.as_slice())
    }

    /// Whether it has to be made.
    pub fn is_empty(&self) -> bool {
        self.part_end.is_empty()
    }

    /// Makes the next step order anew.
    pub fn clear(&mut self) {
        self.part_end.clear();
    }

    /// First block of each run of blocks, and the number of blocks at the end.
    pub fn leaf_block(&self) -> &[u32] {
        &self.leaf_block
    }

    /// Orders near pairs, sorted by node and side.
    pub fn order(&mut self, boundary: &Boundary, candidates: &[Candidate], metric: &Metric) {
        self.keys.clear();
        self.entries.clear();
        for run in candidates.chunk_by(|a, b| [a.node, a.side] == [b.node, b.side]) {
            let point = boundary.node_point[run[0].node as usize] as usize;
            let (own, other) = (boundary.block[point], boundary.block[run[0].edge as usize]);
            let key = self.keys.len() as u32;
            self.keys.push(key_of(run[0].node, run[0].side));
            self.entries.push(Entry { part: 0, blocks: [own.min(other), own.max(other)], key });
        }
        self.cut(metric);
        for entry in &mut self.entries {
            entry.part = part_of(entry.blocks.map(|b| self.leaf[b as usize]));
        }
        self.entries.sort_unstable();
        self.colour(metric);
        self.take_turns();
    }

    /// Cuts the blocks into runs of like work.
    fn cut(&mut self, metric: &Metric) {
        let blocks = metric.total.len();
        self.leaf.clear();
        self.leaf.resize(blocks, 0);
        for entry in &self.entries {
            let [a, b] = entry.blocks.map(|b| b as usize);
            self.leaf[if metric.is_free(a) { a } else { b }] += 1;
        }
        let leaves = self.entries.len().div_ceil(LEAF).next_power_of_two().min(LEAVES_MAX);
        let total = self.entries.len().max(1);
        let mut before = 0;
        self.leaf_block.clear();
        for (block, leaf) in self.leaf.iter_mut().enumerate() {
            let work = *leaf as usize;
            *leaf = (before * leaves / total).min(leaves - 1) as u32;
            self.leaf_block.resize((*leaf as usize + 1).max(self.leaf_block.len()), block as u32);
            before += work;
        }
        self.leaf_block.resize(leaves + 1, blocks as u32);
    }

    /// Gives every pair of blocks the first colour that no earlier pair of its part has given to one of its blocks.
    fn colour(&mut self, metric: &Metric) {
        self.manifolds.clear();
        self.colours.clear();
        self.colours.resize(metric.total.len(), 0);
        let (mut first, mut part_first) = (0, 0);
        for run in self.entries.chunk_by(|a, b| (a.part, a.blocks) == (b.part, b.blocks)) {
            let (part, blocks) = (run[0].part, run[0].blocks.map(|b| b as usize));
            if self.manifolds.last().is_some_and(|m| m.part != part) {
                let old = &self.entries[part_first as usize..first as usize];
                old.iter().flat_map(|e| e.blocks).for_each(|b| self.colours[b as usize] = 0);
                part_first = first;
            }
            let free = blocks.map(|b| metric.is_free(b));
            let used: u64 = (0..2).filter(|&k| free[k]).map(|k| self.colours[blocks[k]]).fold(0, |a, b| a | b);
            let colour = (!used).trailing_zeros().min(u64::BITS - 1);
            (0..2).filter(|&k| free[k]).for_each(|k| self.colours[blocks[k]] |= 1 << colour);
            let end = first + run.len() as u32;
            self.manifolds.push(Manifold { part, colour, held: free != [true; 2], first, end });
            first = end;
        }
        self.manifolds.sort_unstable();
    }

    /// Counts turns through parts and colours, a few manifolds abreast.
    fn take_turns(&mut self) {
        self.turn.clear();
        self.turn.resize(self.keys.len(), 0);
        self.part_end.clear();
        let mut turn = 0;
        for class in self.manifolds.chunk_by(|a, b| (a.part, a.colour, a.held) == (b.part, b.colour, b.held)) {
            self.part_end.resize(class[0].part as usize, turn);
            for abreast in class.chunks(ABREAST) {
                let longest = abreast.iter().map(|m| m.end - m.first).max().unwrap_or(0);
                for k in 0..longest {
                    for entry in abreast.iter().map(|m| m.first + k).zip(abreast).filter(|(e, m)| *e < m.end) {
                        self.turn[self.entries[entry.0 as usize].key as usize] = turn;
                        turn += 1;
                    }
                }
            }
        }
        let leaves = self.leaf_block.len() - 1;
        self.part_end.resize(2 * leaves - 1, turn);
    }

    /// The contacts of a step in the order of their turns, and the number of them up to the end of each part.
    pub fn arrange(&mut self, contacts: &[VertexEdge], sequence: &mut Vec<u32>, ends: &mut Vec<u32>) {
        self.taken.clear();
        self.taken.resize(self.turn.len(), NONE);
        let mut k = 0;
        for (index, contact) in contacts.iter().enumerate() {
            let key = key_of(contact.history.node, contact.history.side);
            while self.keys[k] < key {
                k += 1;
            }
            self.taken[self.turn[k] as usize] = index as u32;
        }
        // Which turns are taken is hard to foresee: no branch depends on it.
        sequence.resize(contacts.len() + 1, NONE);
        ends.clear();
        let (mut from, mut count) = (0, 0);
        for &end in &self.part_end {
            for &index in &self.taken[from as usize..end as usize] {
                sequence[count] = index;
                count += usize::from(index != NONE);
            }
            ends.push(count as u32);
            from = end;
        }
        sequence.truncate(count);
    }
}

/// What near nodes and sides are sorted by.
fn key_of(node: u32, side: u32) -> u64 {
    u64::from(node) << u32::BITS | u64::from(side)
}

/// The smallest part of the tree that holds two leaves, by its place in the order in which parts are swept: both halves
/// before the whole.
fn part_of([a, b]: [u32; 2]) -> u32 {
    let level = u32::BITS - (a ^ b).leading_zeros();
    let last = (((a >> level) + 1) << level) - 1;
    2 * last - last.count_ones() + level
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_come_before_the_whole() {
        let places: Vec<u32> =
            [[0, 0], [1, 1], [0, 1], [2, 2], [3, 3], [2, 3], [1, 2]].into_iter().map(part_of).collect();
        assert_eq!(places, [0, 1, 2, 3, 4, 5, 6]);
        assert_eq!(part_of([0, 7]), 14);
    }
}
