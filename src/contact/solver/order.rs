//! The order in which contacts are solved: a function of the near pairs, hence of the state, never of the threads.
//!
//! All contacts of two blocks are a block pair. Blocks are cut into runs of like work, which are the leaves of a binary
//! tree. What lies within a run is solved before what lies between two runs, so that both halves of any part of the
//! tree can be swept at once. Within a part block pairs come in groups of up to eight that are solved side by side: no
//! two of a group share a free block, or a cover of a held one.

use std::cmp::Reverse;

use enmm_lanes::LANES;

use crate::contact::{Boundary, EdgeId, FoundContact, NearPair, NearSides, buckets};
use crate::cover::{BlockId, CoverId};

use super::SolverView;
use super::wide_pairs::WidePairs;

/// Near pairs of nodes and sides above which a run of blocks is cut.
const LEAF: usize = 4096;
/// Most runs of blocks.
const LEAVES_MAX: usize = 4096;

/// In what block pair every near side is.
#[doc(alias = "islands")]
#[derive(Debug, Clone, Default)]
pub struct SolverOrder {
    /// Block pair of each near side.
    block_pair: Vec<u32>,
    /// Block pairs, part by part in the order in which these are solved.
    block_pairs: Vec<BlockPair>,
    /// First block of each run of blocks, and the number of blocks.
    leaf_block: Vec<BlockId>,
    /// Near sides by the lower of both blocks, then by the other one.
    by_block: Vec<u32>,
    leaf: Vec<u32>,
    /// Bodies of the block pairs, pair by pair: a free block by its number, a cover of a held one by its number after
    /// those of all blocks, among the covers that contacts touch.
    pushed: Vec<u32>,
    /// Of a step: the number of contacts of each block pair, then the slot of its next.
    count: Vec<u32>,
    /// Block pairs of a part that have contacts.
    touching: Vec<u32>,
    groups: Groups,
}

/// Near sides and the blocks that they are between.
struct NearBlocks<'a> {
    boundary: &'a Boundary,
    near_pairs: &'a [NearPair],
    near_sides: &'a NearSides,
}

impl<'a> NearBlocks<'a> {
    fn count(&self) -> usize {
        self.near_sides.as_slice().len()
    }

    /// Near edges of a near side.
    fn edges(&self, near_side: u32) -> &'a [NearPair] {
        self.near_sides.pairs_of(self.near_pairs, near_side as usize)
    }

    /// Blocks of node and side, the lower one first.
    fn blocks(&self, near_side: usize) -> [BlockId; 2] {
        let near = self.near_sides.as_slice()[near_side];
        let points = [self.boundary.nodes.point[near.node], self.near_pairs[near.first as usize].edge];
        let [own, other] = points.map(|point| self.boundary.block[point]);
        [own.min(other), own.max(other)]
    }
}

/// All near sides of two blocks, a free one first when there is one.
#[derive(Debug, Clone, Copy)]
struct BlockPair {
    subdomain: u32,
    /// Those near sides, among all of them by block.
    first: u32,
    end: u32,
    /// Range of its bodies in `pushed`: the first, and the one after the last.
    pushed: [u32; 2],
    blocks: [BlockId; 2],
}

impl BlockPair {
    /// Its near sides, among all of them by block.
    fn near_sides(&self) -> std::ops::Range<usize> {
        self.first as usize..self.end as usize
    }
}

/// Groups of block pairs that share nothing that they push.
#[doc(alias = "graph colouring")]
#[derive(Debug, Clone, Default)]
struct Groups {
    /// Block pairs of each, those with the most contacts first.
    members: Vec<Members>,
    /// Which of 64 groups push each block and cover, a bit each.
    pushing: Vec<u64>,
    /// Block pairs that none of the 64 groups could take.
    left: Vec<u32>,
    /// Covers of held blocks that the block pair in hand pushes.
    covers: Vec<CoverId>,
    /// Those that any pushes, by their numbers after those of all blocks.
    held: Vec<u32>,
}

/// Up to eight block pairs.
#[derive(Debug, Clone, Default)]
struct Members {
    block_pairs: [u32; LANES],
    count: usize,
}

/// Block pairs of a step in the order in which they are solved.
#[derive(Debug, Clone, Default)]
pub struct Sequence {
    /// Eight side by side.
    pub wide_pairs: Vec<WidePairs>,
    /// The number of them up to the end of each part.
    pub ends: Vec<u32>,
    /// First position of each row in `contacts`, and the number of them. A row has as many contacts as there are block
    /// pairs with so many, in the first lanes.
    pub row_start: Vec<u32>,
    /// Contacts in the order in which they are solved.
    pub contacts: Vec<u32>,
    /// Slot of each contact: its row times the number of lanes, and its lane.
    pub slots: Vec<u32>,
}

impl SolverOrder {
    /// Bytes of the order and of what it is made with.
    pub fn bytes(&self) -> usize {
        let Self { block_pair, by_block, leaf, pushed, count, touching, leaf_block, groups, .. } = self;
        let lists = [block_pair, by_block, leaf, pushed, count, touching, &groups.left, &groups.held];
        let order = size_of_val(self.block_pairs.as_slice()) + size_of_val(leaf_block.as_slice());
        let groups = size_of_val(groups.members.as_slice()) + size_of_val(groups.pushing.as_slice());
        let lists = lists.map(|list| size_of_val(list.as_slice())).iter().sum::<usize>();
        order + lists + groups
    }

    /// Whether it has to be made.
    pub fn is_empty(&self) -> bool {
        self.leaf_block.is_empty()
    }

    /// Makes the next step renew the order.
    pub fn clear(&mut self) {
        self.leaf_block.clear();
    }

    /// First block of each run of blocks, and the number of blocks at the end.
    pub fn leaf_block(&self) -> &[BlockId] {
        &self.leaf_block
    }

    /// Orders near sides.
    pub fn order(&mut self, boundary: &Boundary, near_pairs: &[NearPair], near_sides: &NearSides, view: &SolverView) {
        let near_sides = NearBlocks { boundary, near_pairs, near_sides };
        self.cut(&near_sides, view);
        self.list_block_pairs(&near_sides, view);
        self.list_pushed(&near_sides, view);
        self.block_pair.resize(self.by_block.len(), 0);
        for (index, block_pair) in (0u32..).zip(&self.block_pairs) {
            for &near_side in &self.by_block[block_pair.near_sides()] {
                self.block_pair[near_side as usize] = index;
            }
        }
    }

    /// Cuts the blocks into runs of like work.
    fn cut(&mut self, near_sides: &NearBlocks, view: &SolverView) {
        let mass_matrix = view.mass_matrix;
        let blocks = mass_matrix.total.len();
        self.leaf.clear();
        self.leaf.resize(blocks, 0);
        for near_side in 0..near_sides.count() {
            let [a, b] = near_sides.blocks(near_side);
            self.leaf[if mass_matrix.is_free(a) { a } else { b }] += 1;
        }
        let leaves = near_sides.count().div_ceil(LEAF).next_power_of_two().min(LEAVES_MAX);
        let total = near_sides.count().max(1);
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

    /// Lists the block pairs, part by part, and in each by their blocks.
    fn list_block_pairs(&mut self, near_sides: &NearBlocks, view: &SolverView) {
        let Self { by_block, block_pairs, count: start, leaf, .. } = self;
        let blocks = view.mass_matrix.total.len();
        buckets::sort(near_sides.count(), blocks, |k| near_sides.blocks(k)[0].index(), start, by_block);
        block_pairs.clear();
        for (first, end) in start.windows(2).map(|range| (range[0], range[1])) {
            let other = |near_side: u32| near_sides.blocks(near_side as usize)[1];
            let of_block = &mut by_block[first as usize..end as usize];
            of_block.sort_unstable_by_key(|&near_side| (other(near_side), near_side));
            let mut first = first;
            for run in of_block.chunk_by(|&a, &b| other(a) == other(b)) {
                let blocks = near_sides.blocks(run[0] as usize);
                let end = first + run.len() as u32;
                let subdomain = subdomain_of(blocks.map(|block| leaf[block]));
                block_pairs.push(BlockPair { subdomain, first, end, pushed: [0; 2], blocks });
                first = end;
            }
        }
        block_pairs.sort_unstable_by_key(|block_pair| (block_pair.subdomain, block_pair.blocks));
    }

    /// Lists what the block pairs push.
    fn list_pushed(&mut self, near_sides: &NearBlocks, view: &SolverView) {
        let Self { by_block, block_pairs, pushed, groups, .. } = self;
        let blocks = view.mass_matrix.total.len();
        pushed.clear();
        for block_pair in block_pairs {
            let ([a, b], first_pushed) = (block_pair.blocks, pushed.len());
            let free = [a, b].map(|block| view.mass_matrix.is_free(block));
            pushed
                .extend([(a, free[0]), (b, free[1])].iter().filter(|(_, free)| *free).map(|(block, _)| block.number()));
            if free != [true; 2] {
                groups.covers.clear();
                for &near_side in &by_block[block_pair.near_sides()] {
                    held_covers(near_sides.boundary, near_sides.edges(near_side), view, &mut groups.covers);
                }
                groups.covers.sort_unstable();
                groups.covers.dedup();
                pushed.extend(groups.covers.iter().map(|cover| blocks as u32 + cover.number()));
            }
            block_pair.pushed = [first_pushed as u32, pushed.len() as u32];
            block_pair.blocks = if free[0] { [a, b] } else { [b, a] };
        }
        groups.number_covers(blocks, pushed);
    }

    /// Puts the block pairs and the contacts of a step in the order in which they are solved.
    pub fn arrange(&mut self, found: &[FoundContact], view: &SolverView, sequence: &mut Sequence) {
        let Sequence { wide_pairs, ends, row_start, contacts, slots } = sequence;
        self.count_contacts(found, slots);
        wide_pairs.clear();
        ends.clear();
        row_start.clear();
        let (mut first, mut position) = (0, 0);
        for part in self.block_pairs.chunk_by(|a, b| a.subdomain == b.subdomain) {
            ends.resize(part[0].subdomain as usize, wide_pairs.len() as u32);
            let all = first..first + part.len() as u32;
            first = all.end;
            self.touching.clear();
            self.touching.extend(all.filter(|&m| self.count[m as usize] > 0));
            self.touching.sort_unstable_by_key(|&m| (Reverse(self.count[m as usize]), m));
            self.groups.form(&mut self.touching, &self.block_pairs, &self.pushed);
            for group in &self.groups.members {
                let some = &group.block_pairs[..group.count];
                let first_row = row_start.len() as u32;
                let counts = some.iter().map(|&m| self.count[m as usize]);
                for row in 0..self.count[some[0] as usize] {
                    row_start.push(position);
                    position += counts.clone().filter(|&count| count > row).count() as u32;
                }
                let block_pairs = some.iter().map(|&m| (self.block_pairs[m as usize].blocks, self.count[m as usize]));
                wide_pairs.push(WidePairs::new(first_row, block_pairs, view));
                for (&m, lane) in some.iter().zip(0..) {
                    self.count[m as usize] = first_row * LANES as u32 + lane;
                }
            }
        }
        ends.resize(2 * (self.leaf_block.len() - 1) - 1, wide_pairs.len() as u32);
        row_start.push(position);
        contacts.resize(position as usize, 0);
        for (slot, contact) in slots.iter_mut().zip(0..) {
            let next = &mut self.count[*slot as usize];
            *slot = *next;
            *next += LANES as u32;
            let position = row_start[(*slot / LANES as u32) as usize] + *slot % LANES as u32;
            contacts[position as usize] = contact;
        }
    }

    /// Finds the block pair of each contact, and the number of contacts of each block pair.
    fn count_contacts(&mut self, found: &[FoundContact], block_pairs: &mut Vec<u32>) {
        self.count.clear();
        self.count.resize(self.block_pairs.len(), 0);
        block_pairs.clear();
        block_pairs.extend(found.iter().map(|contact| self.block_pair[contact.near_side as usize]));
        block_pairs.iter().for_each(|&block_pair| self.count[block_pair as usize] += 1);
    }
}

impl Groups {
    /// Renumbers the few covers of fixed blocks that contacts touch.
    fn number_covers(&mut self, blocks: usize, pushed: &mut [u32]) {
        let Self { held, pushing, .. } = self;
        held.clear();
        held.extend(pushed.iter().filter(|&&k| k as usize >= blocks));
        held.sort_unstable();
        held.dedup();
        for k in pushed.iter_mut().filter(|k| **k as usize >= blocks) {
            *k = (blocks + held.partition_point(|held| held < k)) as u32;
        }
        pushing.clear();
        pushing.resize(blocks + held.len(), 0);
    }

    /// Puts block pairs one by one into the first group with a free lane that pushes nothing of theirs. Those for which
    /// 64 groups have no place go into the next 64. Block pairs of like length come together when the longest are
    /// first. Nothing is left of `block_pairs`.
    fn form(&mut self, block_pairs: &mut Vec<u32>, all: &[BlockPair], pushed: &[u32]) {
        let Self { members, pushing, left, .. } = self;
        let pushed_by = |m: u32| {
            let [first, end] = all[m as usize].pushed;
            &pushed[first as usize..end as usize]
        };
        members.clear();
        while !block_pairs.is_empty() {
            let first = members.len();
            let mut open = u64::MAX;
            for &m in &*block_pairs {
                let taken = pushed_by(m).iter().fold(0, |bits, &k| bits | pushing[k as usize]);
                let group = (open & !taken).trailing_zeros();
                if group == u64::BITS {
                    left.push(m);
                    continue;
                }
                members.resize(members.len().max(first + group as usize + 1), Members::default());
                let Members { block_pairs, count } = &mut members[first + group as usize];
                block_pairs[*count] = m;
                *count += 1;
                if *count == LANES {
                    open &= !(1 << group);
                }
                pushed_by(m).iter().for_each(|&k| pushing[k as usize] |= 1 << group);
            }
            block_pairs.iter().flat_map(|&m| pushed_by(m)).for_each(|&k| pushing[k as usize] = 0);
            std::mem::swap(block_pairs, left);
            left.clear();
        }
    }
}

/// Adds the covers of held blocks that a node and the near edges of a side may push.
fn held_covers(boundary: &Boundary, edges: &[NearPair], view: &SolverView, covers: &mut Vec<CoverId>) {
    let is_held = |point: EdgeId| !view.mass_matrix.is_free(boundary.block[point]);
    let node = boundary.nodes.point[edges[0].node];
    if is_held(node) {
        covers.extend(boundary.covers[node]);
    }
    for edge in edges.iter().map(|near_pair| near_pair.edge).filter(|&edge| is_held(edge)) {
        covers.extend(boundary.covers_on(edge));
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

    /// A block that touches a hundred others, and pairs of neighbours in a row of blocks.
    #[test]
    fn a_group_pushes_nothing_twice_and_every_pair_is_in_one() {
        let neighbours = (0..399).map(|k| [k, k + 1]);
        let pushed: Vec<[u32; 2]> = (0..100).map(|k| [3 * k, 400]).chain(neighbours).collect();
        let of = |k: u32| BlockPair {
            subdomain: 0,
            first: 0,
            end: 0,
            pushed: [2 * k, 2 * k + 2],
            blocks: [BlockId::default(); 2],
        };
        let all: Vec<BlockPair> = (0..pushed.len() as u32).map(of).collect();
        let mut groups = Groups { pushing: vec![0; 401], ..Groups::default() };
        groups.form(&mut (0..all.len() as u32).collect(), &all, pushed.as_flattened());
        let members = || groups.members.iter().map(|group| &group.block_pairs[..group.count]);
        for group in members() {
            let mut pushed: Vec<u32> = group.iter().flat_map(|&k| pushed[k as usize]).collect();
            pushed.sort_unstable();
            assert!(!group.is_empty() && pushed.windows(2).all(|two| two[0] < two[1]), "{group:?}");
        }
        let mut taken: Vec<u32> = members().flatten().copied().collect();
        taken.sort_unstable();
        assert_eq!(taken, Vec::from_iter(0..all.len() as u32));
        // That block needs a hundred groups; they take the 399 other pairs as well.
        assert_eq!(groups.members.len(), 100);
        assert!(groups.pushing.iter().all(|&groups| groups == 0));
    }

    #[test]
    fn halves_come_before_the_whole() {
        let slots: Vec<u32> =
            [[0, 0], [1, 1], [0, 1], [2, 2], [3, 3], [2, 3], [1, 2]].into_iter().map(subdomain_of).collect();
        assert_eq!(slots, [0, 1, 2, 3, 4, 5, 6]);
        assert_eq!(subdomain_of([0, 7]), 14);
    }
}
