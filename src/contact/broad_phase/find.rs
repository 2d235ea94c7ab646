//! Finds the near edges of nodes in the grid.

use std::ops::Range;

use enmm_lanes::{Kernel, LANES, Lanes};

use crate::contact::{Boundary, EdgeId, NodeId};
use crate::cover::BlockId;

use super::grid::{Grid, Stretch};
use super::within::{Boxes, Marks, NOWHERE, Span, Within};
use super::{NearPair, SearchView};

/// Greatest number of consecutive nodes that search together.
const FEW: usize = 8;
/// Stretches up to which a list is sorted by ranks.
const SHORT: usize = 32;

/// Near pairs of some nodes, and buffers.
#[derive(Debug, Clone, Default)]
pub struct Run {
    pub near_pairs: Vec<NearPair>,
    /// Stretches round a few nodes, and their boxes.
    around: Vec<u32>,
    boxes: Vec<Boxes>,
    /// Stretches near one node.
    near: Vec<u32>,
}

impl Run {
    pub fn bytes(&self) -> usize {
        let lists = size_of_val(self.around.as_slice()) + size_of_val(self.near.as_slice());
        let around = lists + size_of_val(self.boxes.as_slice());
        size_of_val(self.near_pairs.as_slice()) + around
    }
}

/// Finds the near edges of some nodes: compiled for every kind of lanes.
pub struct Find<'a> {
    pub grid: &'a Grid,
    pub view: &'a SearchView<'a>,
    pub nodes: Range<usize>,
    pub run: &'a mut Run,
}

impl Kernel for Find<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let within = Within::new(lanes, self.view.cutoff);
        self.run.near_pairs.clear();
        while !self.nodes.is_empty() {
            let (few, block, span) = self.next_few();
            if !self.view.removed[block] {
                self.look_round(&within, block, span);
                for node in NodeId::range(few) {
                    self.near_edges(&within, node, block);
                }
            }
        }
    }
}

impl Find<'_> {
    /// The next few nodes of one block: indices, block and bounding box.
    #[inline(always)]
    fn next_few(&mut self) -> (Range<usize>, BlockId, Span) {
        let (boundary, frames) = (self.view.boundary, self.view.frames);
        let Range { start, end } = self.nodes;
        let point = |node: usize| boundary.nodes.point[node];
        let block = boundary.block[point(start)];
        let others = (start + 1..end.min(start + FEW)).take_while(|&node| boundary.block[point(node)] == block);
        let (mut span, mut last) = (Span::at(frames.position(point(start))), start);
        for node in others {
            (span, last) = (span.with(frames.position(point(node))), node);
        }
        self.nodes.start = last + 1;
        (start..last + 1, block, span)
    }

    /// Lists the stretches that a box of a block may meet, with their boxes.
    #[inline(always)]
    fn look_round<L: Lanes>(&mut self, within: &Within<L>, block: BlockId, span: Span) {
        let (grid, fixed) = (self.grid, self.view.fixed);
        let Run { around, boxes, .. } = &mut *self.run;
        around.clear();
        let mut marks = Marks::default();
        let mut list = |eight: u32, lane: usize| {
            let stretch = grid.stretch_at[eight as usize * LANES + lane];
            let Stretch { block: other, partial, .. } = grid.stretches[stretch as usize];
            if (other != block || partial) && !(fixed[block] && fixed[other]) {
                around.push(stretch);
            }
        };
        for row in grid.round(span) {
            for eight in row {
                marks.push(eight as u32, within.boxes(span, &grid.boxes[eight]), &mut list);
            }
        }
        marks.see(&mut list);
        sort(around);
        let eights = around.len().div_ceil(LANES);
        boxes.resize(eights, NOWHERE);
        for k in 0..eights * LANES {
            let span = around.get(k).map_or(Span::NOWHERE, |&stretch| grid.stretches[stretch as usize].span);
            span.put(&mut boxes[k / LANES], k % LANES);
        }
    }

    /// Appends the near edges of a node.
    #[inline(always)]
    fn near_edges<L: Lanes>(&mut self, within: &Within<L>, node: NodeId, block: BlockId) {
        let (boundary, grid) = (self.view.boundary, self.grid);
        let Run { near_pairs, around, boxes, near } = &mut *self.run;
        let p = self.view.frames.position(boundary.nodes.point[node]);
        let mut marks = Marks::default();
        near.clear();
        let mut list = |eight: u32, lane: usize| near.push(around[eight as usize * LANES + lane]);
        for (eight, boxes) in boxes.iter().enumerate() {
            marks.push(eight as u32, within.boxes(Span::at(p), boxes), &mut list);
        }
        marks.see(&mut list);
        let mut add = |edge: u32, k: usize| {
            let edge = EdgeId::new(edge as usize + k);
            near_pairs.push(NearPair { node, side: boundary.side[edge], edge });
        };
        for &stretch in near.iter() {
            let stretch = &grid.stretches[stretch as usize];
            let mut edges = grid.near_edges(within, p, stretch);
            if stretch.block == block {
                edges &= may_meet(boundary, node, stretch.edge);
            }
            marks.push(stretch.edge.number(), edges, &mut add);
        }
        marks.see(&mut add);
    }
}

/// Sorts distinct numbers; a few of them by counting how many are smaller than each.
#[inline(always)]
fn sort(list: &mut [u32]) {
    if list.len() > SHORT {
        return list.sort_unstable();
    }
    let (mut values, mut ranks) = ([0; SHORT], [0u32; SHORT]);
    values[..list.len()].copy_from_slice(list);
    for value in list.iter() {
        ranks.iter_mut().zip(&values).for_each(|(rank, other)| *rank += u32::from(value < other));
    }
    for (value, rank) in values.iter().zip(&ranks).take(list.len()) {
        list[*rank as usize] = *value;
    }
}

/// Which of eight consecutive edges a node of their own block can touch.
fn may_meet(boundary: &Boundary, node: NodeId, first: EdgeId) -> u8 {
    let sides = [boundary.side[boundary.nodes.point[node]], boundary.side_of_node_before(node)];
    let edges = (first.index()..boundary.len()).take(LANES).enumerate();
    let may = |edge: usize| boundary.partial[edge] && !sides.contains(&boundary.side[edge]);
    if boundary.node_partial(node) { edges.fold(0, |bits, (k, edge)| bits | u8::from(may(edge)) << k) } else { 0 }
}
