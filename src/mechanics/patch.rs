//! Patches: runs of whole small blocks, or parts of a large one, whose covers fit into the fastest cache, with their
//! elements in groups of eight of one gradient set and one rock.
//!
//! Elements that touch covers of two parts of a block belong to both, so that every part finds the whole force on its
//! own covers and no two threads write to the same place.

use std::ops::Range;

use enmm_lanes::{LANES, SLOTS, Slot};

use crate::cover::Covers;

use super::PreStress;

/// Covers after which a patch of whole blocks takes no further one.
const PATCH: usize = 512;
/// Most covers of a patch; a larger block is cut into parts.
const PART: usize = 1024;
/// Element of a lane that stands for none.
const NO_ELEMENT: u32 = u32::MAX;

/// Whole blocks, or a part of one.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Blocks: those that begin here.
    pub blocks: Range<usize>,
    /// The large block of which this is a part.
    pub part_of: Option<u32>,
    /// Covers whose forces are found here.
    pub covers: Range<usize>,
    halo: Range<usize>,
    batches: Range<usize>,
}

/// Groups of elements of one gradient set and one rock.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// Gradient set.
    pub set: u8,
    /// Rock.
    pub rock: u16,
    groups: Range<usize>,
}

/// Eight elements; missing ones have no area.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Group {
    /// Slots of the first, second and third covers.
    pub slots: [[Slot; LANES]; 3],
    /// Cut areas (m²).
    pub area: [f64; LANES],
}

/// All patches of a model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Patches {
    list: Vec<Patch>,
    halo: Vec<u32>,
    batches: Vec<Batch>,
    groups: Vec<Group>,
    /// In-situ stress xx, yy, xy (Pa) of each group's lanes; empty when there is none.
    pre_stress: Vec<[[f64; LANES]; 3]>,
    /// Elements of each group's lanes.
    elements: Vec<[u32; LANES]>,
}

impl Patches {
    /// Cuts the blocks of a model into patches.
    pub fn new(covers: &Covers, element_rock: &[u16], pre_stress: &[PreStress]) -> Self {
        let mut cutter = Cutter {
            covers,
            element_rock,
            pre_stress,
            slot_of: vec![NO_ELEMENT; covers.cover_count()],
            patches: Self::default(),
        };
        let (mut first, count) = (0, covers.block_count());
        while first < count {
            if covers.covers_of(first).len() > PART {
                cutter.push_large(first);
                first += 1;
                continue;
            }
            let start = covers.block_covers[first] as usize;
            let fits = |b: &usize| covers.block_covers[b + 1] as usize - start <= PATCH;
            let end = first + 1 + (first + 1..count).take_while(fits).count();
            cutter.push_blocks(first..end);
            first = end;
        }
        cutter.patches
    }

    /// Number of patches.
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
            + size_of_val(&*self.groups)
            + size_of_val(&*self.pre_stress)
            + size_of_val(&*self.elements)
    }

    /// A patch.
    pub fn get(&self, patch: usize) -> &Patch {
        &self.list[patch]
    }

    /// Covers of other patches that elements of a patch touch: their slots follow those of the patch's own.
    pub fn halo(&self, patch: &Patch) -> &[u32] {
        &self.halo[patch.halo.clone()]
    }

    /// Batches of a patch.
    pub fn batches(&self, patch: &Patch) -> &[Batch] {
        &self.batches[patch.batches.clone()]
    }

    /// Groups of a batch.
    pub fn groups(&self, batch: &Batch) -> &[Group] {
        &self.groups[batch.groups.clone()]
    }

    /// In-situ stress (Pa) of the groups of a batch; empty when the model has none.
    pub fn pre_stress(&self, batch: &Batch) -> &[[[f64; LANES]; 3]] {
        self.pre_stress.get(batch.groups.clone()).unwrap_or_default()
    }

    /// Elements of a batch with their slots.
    pub fn elements(&self, batch: &Batch) -> impl Iterator<Item = (usize, [Slot; 3])> {
        let ids = &self.elements[batch.groups.clone()];
        self.groups(batch).iter().zip(ids).flat_map(|(group, ids)| {
            let there = ids.iter().enumerate().filter(|(_, id)| **id != NO_ELEMENT);
            there.map(|(lane, id)| (*id as usize, group.slots.map(|corner| corner[lane])))
        })
    }

    /// Patches that are parts of one block, from `first` on.
    pub fn parts(&self, first: usize) -> Range<usize> {
        let block = self.list[first].part_of;
        let count = self.list[first..].iter().take_while(|p| block.is_some() && p.part_of == block).count();
        first..first + count
    }

    /// First patches of the blocks that are cut into parts.
    pub fn cut_blocks(&self) -> impl Iterator<Item = usize> {
        (0..self.list.len()).filter(|&k| self.list[k].part_of.is_some() && !self.list[k].blocks.is_empty())
    }
}

/// Patches in the making.
struct Cutter<'a> {
    covers: &'a Covers,
    element_rock: &'a [u16],
    pre_stress: &'a [PreStress],
    slot_of: Vec<u32>,
    patches: Patches,
}

impl Cutter<'_> {
    fn push_blocks(&mut self, blocks: Range<usize>) {
        let elements = self.covers.elements_of(blocks.start).start..self.covers.elements_of(blocks.end - 1).end;
        let own = self.covers.covers_of(blocks.start).start..self.covers.covers_of(blocks.end - 1).end;
        let ids = elements.map(|e| e as u32).collect();
        self.push(Patch { blocks, part_of: None, covers: own, halo: 0..0, batches: 0..0 }, ids);
    }

    /// Equal parts in the order of the covers.
    fn push_large(&mut self, block: usize) {
        let own = self.covers.covers_of(block);
        let count = own.len().div_ceil(PART);
        let start = |part: usize| own.start + own.len() * part / count;
        let part_of = |cover: u32| (1..count).take_while(|&p| start(p) <= cover as usize).count();
        let part_of_cover: Vec<usize> = own.clone().map(|i| part_of(i as u32)).collect();
        let mut elements = vec![Vec::new(); count];
        for e in self.covers.elements_of(block) {
            let mut parts = self.covers.element_covers[e].map(|i| part_of_cover[i as usize - own.start]);
            parts.sort_unstable();
            elements[parts[0]].push(e as u32);
            (1..3).filter(|&k| parts[k] != parts[k - 1]).for_each(|k| elements[parts[k]].push(e as u32));
        }
        for (part, elements) in elements.into_iter().enumerate() {
            let blocks = if part == 0 { block..block + 1 } else { block + 1..block + 1 };
            let covers = start(part)..start(part + 1);
            let patch = Patch { blocks, part_of: Some(block as u32), covers, halo: 0..0, batches: 0..0 };
            self.push(patch, elements);
        }
    }

    fn push(&mut self, mut patch: Patch, mut elements: Vec<u32>) {
        let first_halo = self.patches.halo.len();
        let own = patch.covers.len();
        for (slot, cover) in patch.covers.clone().enumerate() {
            self.slot_of[cover] = slot as u32;
        }
        for &e in &elements {
            for cover in self.covers.element_covers[e as usize] {
                let slot = &mut self.slot_of[cover as usize];
                if *slot == NO_ELEMENT {
                    *slot = (own + self.patches.halo.len() - first_halo) as u32;
                    self.patches.halo.push(cover);
                }
            }
        }
        patch.halo = first_halo..self.patches.halo.len();
        let first_batch = self.patches.batches.len();
        let (covers, element_rock) = (self.covers, self.element_rock);
        let kind = |e: u32| (covers.element_triangle[e as usize].set, element_rock[e as usize]);
        elements.sort_by_key(|&e| (kind(e), e));
        for batch in elements.chunk_by(|&a, &b| kind(a) == kind(b)) {
            self.push_batch(kind(batch[0]), batch);
        }
        patch.batches = first_batch..self.patches.batches.len();
        for cover in patch.covers.clone() {
            self.slot_of[cover] = NO_ELEMENT;
        }
        for k in patch.halo.clone() {
            self.slot_of[self.patches.halo[k] as usize] = NO_ELEMENT;
        }
        self.patches.list.push(patch);
    }

    fn push_batch(&mut self, (set, rock): (u8, u16), elements: &[u32]) {
        let first = self.patches.groups.len();
        for eight in elements.chunks(LANES) {
            let (mut group, mut pre, mut ids) = (Group::default(), [[0.0; LANES]; 3], [NO_ELEMENT; LANES]);
            for (lane, &e) in eight.iter().enumerate() {
                for (slots, cover) in group.slots.iter_mut().zip(self.covers.element_covers[e as usize]) {
                    slots[lane] = Slot::new(self.slot_of[cover as usize] as usize);
                }
                group.area[lane] = self.covers.element_area[e as usize];
                ids[lane] = e;
                if let Some(stress) = self.pre_stress.get(e as usize) {
                    (0..3).for_each(|k| pre[k][lane] = stress[k]);
                }
            }
            self.patches.groups.push(group);
            self.patches.elements.push(ids);
            if !self.pre_stress.is_empty() {
                self.patches.pre_stress.push(pre);
            }
        }
        self.patches.batches.push(Batch { set, rock, groups: first..self.patches.groups.len() });
    }
}

const _: () = assert!(PART + PATCH < SLOTS);
