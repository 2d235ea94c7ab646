//! Chunks of the model for the loops over elements and covers. A chunk is a run of whole small blocks, or a part of a
//! large block, whose covers fit into the fastest cache. Its elements are in groups of eight with one gradient set and
//! one rock.
//!
//! The parts of a large block are tiles of the lattice. Most of their elements are in rows of eight: the covers at the
//! bases have consecutive slots, and so have those at the tips. Such a group needs no gather and no scatter.
//!
//! An element with covers in two parts of a block belongs to both parts. So every part computes the whole force on its
//! own covers, and no two threads write to the same cover.

use std::ops::Range;

use enmm_lanes::{LANES, SLOTS, Slot};

use crate::cover::{BlockId, CoverId, Covers, ElementId};
use crate::geometry::Vector;

use super::{Averaging, PatchPlaces, PlasticPlaces, PreStress};

/// Number of covers from which a chunk of whole blocks is full.
const PATCH: usize = 512;
/// Greatest number of covers of a chunk; a larger block is cut into parts.
const PART: usize = Covers::TILE;
/// Least number of elements of a row of eight; gather and scatter is faster for fewer.
const ROW_MIN: usize = 4;

/// Whole blocks, or a part of one.
#[doc(alias = "tile")]
#[doc(alias = "cache block")]
#[derive(Debug, Clone, PartialEq)]
pub struct Chunk {
    /// Blocks: those that begin here.
    pub blocks: Range<usize>,
    /// The large block of which this is a part.
    pub part_of: Option<BlockId>,
    /// Covers whose forces this chunk computes.
    pub covers: Range<usize>,
    halo: Range<usize>,
    batches: Range<usize>,
}

impl Chunk {
    /// Blocks with covers here, each with these covers.
    pub fn parts<'a>(&self, covers: &'a Covers) -> impl Iterator<Item = (BlockId, Range<usize>)> + use<'a> {
        let here = self.covers.clone();
        let blocks = self.part_of.map_or(self.blocks.clone(), |b| b.index()..b.index() + 1);
        BlockId::range(blocks).map(move |block| {
            let own = covers.covers_of(block);
            (block, own.start.max(here.start)..own.end.min(here.end))
        })
    }
}

/// Elements of one gradient set and one rock.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// Gradient set.
    pub set: u8,
    /// Rock.
    pub rock: u16,
    rows: Range<usize>,
    groups: Range<usize>,
}

/// Eight elements anywhere in a chunk; empty lanes have no area.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Group {
    /// Slots of the first, second and third covers.
    pub slots: [[Slot; LANES]; 3],
    /// Cut areas (m²).
    pub area: [f64; LANES],
}

/// Corners of an up and of a down triangle as a row has them: left and right end of the base, tip.
const ROW_CORNERS: [[usize; 3]; 2] = [[0, 1, 2], [1, 0, 2]];

/// Eight elements in a row of the lattice; empty lanes have no area and slots of any covers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Row {
    /// Slots of the covers of the first lane at the left end of its base and at its tip; the right end has the next
    /// slot.
    pub first: [Slot; 2],
    /// Cut areas (m²).
    pub area: [f64; LANES],
}

/// In-situ stress xx, yy, xy (Pa) of eight elements.
pub type PreStresses = [[f64; LANES]; 3];

/// Some groups of eight elements of one kind.
#[derive(Debug, Clone, Copy)]
pub struct SomeEights<'a, E> {
    /// The groups.
    pub list: &'a [E],
    /// In-situ stress of each; empty when the model has none.
    pub pre_stress: &'a [PreStresses],
    /// Where lanes find what belongs to rock that yields; empty for rows, and when no rock yields.
    pub yielding: &'a [YieldPlaces],
}

/// Elements of eight lanes; none in an empty one.
type LaneElements = [Option<ElementId>; LANES];

/// Where eight elements find their patches and plastic strain; an empty lane has those of any.
pub type YieldPlaces = (PatchPlaces, PlasticPlaces);

/// Groups of eight elements of one kind, with the data that only some groups or models need.
#[derive(Debug, Clone, PartialEq)]
struct Eights<E> {
    list: Vec<E>,
    /// In-situ stress of each; empty when there is none.
    pre_stress: Vec<PreStresses>,
    /// Elements of the lanes; none in an empty one.
    elements: Vec<LaneElements>,
    /// Places of each; empty for rows, and when no rock yields.
    yielding: Vec<YieldPlaces>,
}

impl<E> Default for Eights<E> {
    fn default() -> Self {
        Self { list: Vec::new(), pre_stress: Vec::new(), elements: Vec::new(), yielding: Vec::new() }
    }
}

impl<E> Eights<E> {
    fn bytes(&self) -> usize {
        size_of_val(&*self.list)
            + size_of_val(&*self.pre_stress)
            + size_of_val(&*self.elements)
            + size_of_val(&*self.yielding)
    }

    fn get(&self, range: &Range<usize>) -> SomeEights<'_, E> {
        SomeEights {
            list: &self.list[range.clone()],
            pre_stress: self.pre_stress.get(range.clone()).unwrap_or_default(),
            yielding: self.yielding.get(range.clone()).unwrap_or_default(),
        }
    }

    /// Elements with their slots.
    fn elements(
        &self,
        range: &Range<usize>,
        slots: impl Fn(&E, usize) -> [Slot; 3] + Copy,
    ) -> impl Iterator<Item = (ElementId, [Slot; 3])> {
        self.list[range.clone()]
            .iter()
            .zip(&self.elements[range.clone()])
            .flat_map(move |(eight, ids)| lanes_of(ids).map(move |(lane, id)| (id, slots(eight, lane))))
    }
}

/// All chunks of a model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chunks {
    list: Vec<Chunk>,
    halo: Vec<CoverId>,
    batches: Vec<Batch>,
    rows: Eights<Row>,
    groups: Eights<Group>,
}

impl Chunks {
    /// Cuts the blocks of a model into chunks.
    pub fn new(covers: &Covers, element_rock: &[u16], pre_stress: &[PreStress], averaging: &Averaging) -> Self {
        let mut cutter = Cutter {
            covers,
            element_rock,
            pre_stress,
            averaging,
            slot_of: vec![0; covers.cover_count()],
            chunks: Self::default(),
        };
        let (mut first, count) = (0, covers.block_count());
        while first < count {
            let block = BlockId::new(first);
            if covers.covers_of(block).len() > PART {
                cutter.push_large(block);
                first += 1;
                continue;
            }
            let start = covers.block_ranges.covers[first] as usize;
            let fits = |b: &usize| covers.block_ranges.covers[b + 1] as usize - start <= PATCH;
            let end = first + 1 + (first + 1..count).take_while(fits).count();
            cutter.push_blocks(first..end);
            first = end;
        }
        cutter.chunks
    }

    /// Number of chunks.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Memory (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.list)
            + size_of_val(&*self.halo)
            + size_of_val(&*self.batches)
            + self.rows.bytes()
            + self.groups.bytes()
    }

    /// All chunks.
    pub fn iter(&self) -> impl Iterator<Item = &Chunk> {
        self.list.iter()
    }

    /// A chunk.
    pub fn get(&self, chunk: usize) -> &Chunk {
        &self.list[chunk]
    }

    /// Covers of other chunks that elements of a chunk touch: their slots follow those of the chunk's own.
    pub fn halo(&self, chunk: &Chunk) -> &[CoverId] {
        &self.halo[chunk.halo.clone()]
    }

    /// Batches of a chunk.
    pub fn batches(&self, chunk: &Chunk) -> &[Batch] {
        &self.batches[chunk.batches.clone()]
    }

    /// Number of groups of eight elements in a chunk.
    pub fn eights(&self, chunk: &Chunk) -> usize {
        self.batches(chunk).iter().map(|batch| batch.rows.len() + batch.groups.len()).sum()
    }

    /// Rows of a batch.
    pub fn rows(&self, batch: &Batch) -> SomeEights<'_, Row> {
        self.rows.get(&batch.rows)
    }

    /// Groups of a batch.
    pub fn groups(&self, batch: &Batch) -> SomeEights<'_, Group> {
        self.groups.get(&batch.groups)
    }

    /// Gradients of the second and the third weight of the rows of a batch, and of its groups.
    pub fn gradients(&self, batch: &Batch, g: &[Vector; 3]) -> [[Vector; 2]; 2] {
        let [_, second, third] = ROW_CORNERS[batch.set as usize];
        [[g[second], g[third]], [g[1], g[2]]]
    }

    /// Elements of a batch with their slots.
    pub fn elements(&self, batch: &Batch) -> impl Iterator<Item = (ElementId, [Slot; 3])> {
        let corners = ROW_CORNERS[batch.set as usize];
        let in_row = move |row: &Row, lane: usize| {
            let [base, tip] = row.first.map(|first| first.index() + lane);
            corners.map(|k| Slot::new([base, base + 1, tip][k]))
        };
        let anywhere = |group: &Group, lane: usize| group.slots.map(|corner| corner[lane]);
        self.rows.elements(&batch.rows, in_row).chain(self.groups.elements(&batch.groups, anywhere))
    }

    /// Chunks that are parts of one block, from `first` on.
    pub fn parts(&self, first: usize) -> Range<usize> {
        let block = self.list[first].part_of;
        let count = self.list[first..].iter().take_while(|p| block.is_some() && p.part_of == block).count();
        first..first + count
    }

    /// First chunks of the blocks that are cut into parts.
    pub fn cut_blocks(&self) -> impl Iterator<Item = usize> {
        (0..self.list.len()).filter(|&k| self.list[k].part_of.is_some() && !self.list[k].blocks.is_empty())
    }
}

/// Builder of the chunks.
struct Cutter<'a> {
    covers: &'a Covers,
    element_rock: &'a [u16],
    pre_stress: &'a [PreStress],
    averaging: &'a Averaging,
    slot_of: Vec<u32>,
    chunks: Chunks,
}

impl Cutter<'_> {
    fn push_blocks(&mut self, blocks: Range<usize>) {
        let [first, last] = [blocks.start, blocks.end - 1].map(BlockId::new);
        let elements = self.covers.elements_of(first).start..self.covers.elements_of(last).end;
        let own = self.covers.covers_of(first).start..self.covers.covers_of(last).end;
        let ids = ElementId::range(elements).collect();
        self.push(Chunk { blocks, part_of: None, covers: own, halo: 0..0, batches: 0..0 }, ids);
    }

    /// Cuts a block into runs of whole tiles, in the order of the covers; a tile with too many covers is cut as well. A
    /// block without tiles is cut into equal parts.
    fn parts_of(&self, block: BlockId) -> Vec<Range<usize>> {
        let own = self.covers.covers_of(block);
        if !self.covers.is_tiled(block) {
            let count = own.len().div_ceil(PART);
            let start = |part: usize| own.start + own.len() * part / count;
            return (0..count).map(|part| start(part)..start(part + 1)).collect();
        }
        let own: Vec<CoverId> = CoverId::range(own).collect();
        let mut parts: Vec<Range<usize>> = Vec::new();
        for tile in own.chunk_by(|&a, &b| self.covers.tile(a) == self.covers.tile(b)) {
            for piece in tile.chunks(PART) {
                match parts.last_mut() {
                    Some(last) if last.len() + piece.len() <= PART => last.end += piece.len(),
                    _ => parts.push(piece[0].index()..piece[0].index() + piece.len()),
                }
            }
        }
        parts
    }

    fn push_large(&mut self, block: BlockId) {
        let parts = self.parts_of(block);
        let first = self.covers.covers_of(block).start;
        let part_of_cover: Vec<usize> =
            parts.iter().enumerate().flat_map(|(k, part)| part.clone().map(move |_| k)).collect();
        let mut elements = vec![Vec::new(); parts.len()];
        for e in ElementId::range(self.covers.elements_of(block)) {
            let mut touched = self.covers.element_covers[e].map(|i| part_of_cover[i.index() - first]);
            touched.sort_unstable();
            elements[touched[0]].push(e);
            (1..3).filter(|&k| touched[k] != touched[k - 1]).for_each(|k| elements[touched[k]].push(e));
        }
        for (part, (covers, elements)) in parts.into_iter().zip(elements).enumerate() {
            let blocks = block.index() + usize::from(part > 0)..block.index() + 1;
            let chunk = Chunk { blocks, part_of: Some(block), covers, halo: 0..0, batches: 0..0 };
            self.push(chunk, elements);
        }
    }

    /// Covers of other chunks that elements touch, row by row.
    fn find_halo(&mut self, chunk: &mut Chunk, elements: &[ElementId]) {
        let is_own = |i: &CoverId| chunk.covers.contains(&i.index());
        let touched = elements.iter().flat_map(|&e| self.covers.element_covers[e]);
        let mut halo: Vec<CoverId> = touched.filter(|i| !is_own(i)).collect();
        halo.sort_unstable_by_key(|&i| {
            let [column, row] = self.covers.star[i];
            (row, column, i)
        });
        halo.dedup();
        chunk.halo = self.chunks.halo.len()..self.chunks.halo.len() + halo.len();
        for (slot, cover) in CoverId::range(chunk.covers.clone()).chain(halo.iter().copied()).enumerate() {
            self.slot_of[cover] = slot as u32;
        }
        self.chunks.halo.append(&mut halo);
    }

    fn push(&mut self, mut chunk: Chunk, mut elements: Vec<ElementId>) {
        self.find_halo(&mut chunk, &elements);
        let first_batch = self.chunks.batches.len();
        let (covers, element_rock) = (self.covers, self.element_rock);
        let kind = |e: ElementId| (covers.element_triangle[e].set, element_rock[e]);
        elements.sort_by_key(|&e| (kind(e), e));
        let in_rows = chunk.part_of.is_some_and(|block| covers.is_tiled(block));
        for batch in elements.chunk_by(|&a, &b| kind(a) == kind(b)) {
            self.push_batch(kind(batch[0]), batch, in_rows);
        }
        chunk.batches = first_batch..self.chunks.batches.len();
        self.chunks.list.push(chunk);
    }

    fn push_batch(&mut self, (set, rock): (u8, u16), elements: &[ElementId], in_rows: bool) {
        let [first_row, first_group] = [self.chunks.rows.list.len(), self.chunks.groups.list.len()];
        // Rock that yields gathers more than its covers: one kernel does for all of its elements. Empty lanes of a
        // group have one cover three times, and so no strain.
        let in_rows = in_rows && !self.averaging.yields(rock);
        let others = if in_rows { self.push_rows(set, elements) } else { elements.to_vec() };
        for eight in others.chunks(LANES) {
            let mut ids = [None; LANES];
            ids.iter_mut().zip(eight).for_each(|(id, &e)| *id = Some(e));
            self.push_group(ids);
        }
        let (rows, groups) = (first_row..self.chunks.rows.list.len(), first_group..self.chunks.groups.list.len());
        self.chunks.batches.push(Batch { set, rock, rows, groups });
    }

    fn slots(&self, e: ElementId) -> [u32; 3] {
        self.covers.element_covers[e].map(|cover| self.slot_of[cover])
    }

    /// Slots of an element's covers at the left end of its base, at its right end and at the tip.
    fn row_slots(&self, set: u8, e: ElementId) -> [u32; 3] {
        let slots = self.slots(e);
        ROW_CORNERS[set as usize].map(|k| slots[k])
    }

    /// Rows of elements whose covers are in runs of slots; returns the other elements.
    fn push_rows(&mut self, set: u8, elements: &[ElementId]) -> Vec<ElementId> {
        let position = |&e: &ElementId| {
            let [left, right, tip] = self.row_slots(set, e);
            (right == left + 1, tip.wrapping_sub(left), left, e)
        };
        let mut sorted: Vec<_> = elements.iter().map(position).collect();
        sorted.sort_unstable();
        let (apart, mut rest) = sorted.split_at(sorted.partition_point(|s| !s.0));
        let mut others: Vec<ElementId> = apart.iter().map(|s| s.3).collect();
        while let Some(&(_, line, first, e)) = rest.first() {
            let within = rest.partition_point(|s| (s.1, s.2) < (line, first + LANES as u32));
            let mut ids = [None; LANES];
            let mut doubles = Vec::new();
            for &(.., slot, e) in &rest[..within] {
                match &mut ids[(slot - first) as usize] {
                    id @ None => *id = Some(e),
                    _ => doubles.push(e),
                }
            }
            let is_row = within - doubles.len() >= ROW_MIN;
            if is_row {
                self.push_row(self.row_slots(set, e), ids);
                others.append(&mut doubles);
            } else {
                others.push(e);
            }
            rest = &rest[if is_row { within } else { 1 }..];
        }
        others.sort_unstable();
        others
    }

    /// Adds a row whose first element has these slots.
    fn push_row(&mut self, first: [u32; 3], ids: LaneElements) {
        let [left, _, tip] = first.map(|slot| Slot::new(slot as usize));
        let (area, pre) = self.lanes(&ids);
        push_eight(&mut self.chunks.rows, Row { first: [left, tip], area }, pre, ids);
    }

    fn push_group(&mut self, ids: LaneElements) {
        let mut slots = <[[Slot; LANES]; 3]>::default();
        for (lane, e) in lanes_of(&ids) {
            (0..3).for_each(|k| slots[k][lane] = Slot::new(self.slots(e)[k] as usize));
        }
        let (area, pre) = self.lanes(&ids);
        push_eight(&mut self.chunks.groups, Group { slots, area }, pre, ids);
        if !self.averaging.is_empty() {
            let mut places = YieldPlaces::default();
            for (lane, e) in lanes_of(&ids) {
                places.0.set(lane, e, self.averaging);
                places.1.set(lane, e);
            }
            self.chunks.groups.yielding.push(places);
        }
    }

    /// Areas (m²) of eight elements, and their in-situ stress when the model has any.
    fn lanes(&self, ids: &LaneElements) -> ([f64; LANES], Option<PreStresses>) {
        let (mut area, mut pre) = ([0.0; LANES], [[0.0; LANES]; 3]);
        for (lane, e) in lanes_of(ids) {
            area[lane] = self.covers.element_area[e];
            if let Some(stress) = self.pre_stress.get(e.index()) {
                (0..3).for_each(|k| pre[k][lane] = stress[k]);
            }
        }
        (area, (!self.pre_stress.is_empty()).then_some(pre))
    }
}

/// Lanes that have an element, with it.
fn lanes_of(ids: &LaneElements) -> impl Iterator<Item = (usize, ElementId)> {
    ids.iter().enumerate().filter_map(|(lane, id)| Some((lane, (*id)?)))
}

fn push_eight<E>(eights: &mut Eights<E>, eight: E, pre: Option<PreStresses>, ids: LaneElements) {
    eights.list.push(eight);
    eights.pre_stress.extend(pre);
    eights.elements.push(ids);
}

const _: () = assert!(PART + PATCH < SLOTS);
