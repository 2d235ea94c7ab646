//! Handles that show whether their object still exists, without ever being dereferenced.
//!
//! A handle holds the generation of its slot in the upper half, the slot above the lowest eight bits, and there a tag
//! of the kind of thing. A slot that is given free gets the next generation, so that an old handle finds nothing; a
//! slot whose generations are used up is never used again.

use std::sync::{Arc, PoisonError, RwLock};

use super::failure::Failure;
use crate::types::enmm_status;

const _: () = assert!(usize::BITS == 64, "handles need 64 bits");

const SLOT_BITS: u32 = 24;
const TAG_BITS: u32 = 8;

/// A table of things of one kind.
pub struct Table<T> {
    tag: u8,
    kind: &'static str,
    slots: RwLock<Slots<T>>,
}

struct Slots<T> {
    /// Generation and thing of each slot.
    list: Vec<(u32, Option<Arc<T>>)>,
    free: Vec<usize>,
}

impl<T> Table<T> {
    /// An empty table; `tag` is part of its handles, `kind` of messages.
    pub const fn new(tag: u8, kind: &'static str) -> Self {
        Self { tag, kind, slots: RwLock::new(Slots { list: Vec::new(), free: Vec::new() }) }
    }

    /// Takes a thing and returns its handle.
    ///
    /// # Errors
    /// When millions of things are alive.
    pub fn insert(&self, thing: T) -> Result<usize, Failure> {
        let mut slots = self.slots.write().unwrap_or_else(PoisonError::into_inner);
        let slot = match slots.free.pop() {
            Some(slot) => slot,
            None if slots.list.len() < 1 << SLOT_BITS => {
                slots.list.push((1, None));
                slots.list.len() - 1
            }
            None => {
                let message = format!("too many {}s are alive; destroy those that are no longer needed", self.kind);
                return Err(Failure::new(enmm_status::ENMM_INVALID_ARGUMENT, message));
            }
        };
        slots.list[slot].1 = Some(Arc::new(thing));
        Ok((slots.list[slot].0 as usize) << 32 | slot << TAG_BITS | usize::from(self.tag))
    }

    /// The thing of a handle.
    ///
    /// # Errors
    /// The handle is NULL, or dead, or was never one of this table.
    pub fn find(&self, handle: usize) -> Result<Arc<T>, Failure> {
        let (slot, generation) = self.split(handle)?;
        let slots = self.slots.read().unwrap_or_else(PoisonError::into_inner);
        match slots.list.get(slot) {
            Some((own, Some(thing))) if *own == generation => Ok(Arc::clone(thing)),
            _ => Err(self.dead()),
        }
    }

    /// Gives a slot free; the thing goes when the last call that uses it ends.
    ///
    /// # Errors
    /// As [`Table::find`].
    pub fn remove(&self, handle: usize) -> Result<(), Failure> {
        let (slot, generation) = self.split(handle)?;
        let mut slots = self.slots.write().unwrap_or_else(PoisonError::into_inner);
        let found = slots.list.get_mut(slot).filter(|(own, thing)| *own == generation && thing.is_some());
        let Some((own, thing)) = found else { return Err(self.dead()) };
        let thing = thing.take();
        let next = own.checked_add(1);
        if let Some(next) = next {
            *own = next;
            slots.free.push(slot);
        }
        drop(slots);
        drop(thing);
        Ok(())
    }

    fn split(&self, handle: usize) -> Result<(usize, u32), Failure> {
        if handle == 0 {
            let message = format!("the {} is NULL; create it first and check the status", self.kind);
            return Err(Failure::new(enmm_status::ENMM_NULL_ARGUMENT, message));
        }
        if handle & ((1 << TAG_BITS) - 1) != usize::from(self.tag) {
            return Err(self.dead());
        }
        Ok(((handle & 0xffff_ffff) >> TAG_BITS, (handle >> 32) as u32))
    }

    fn dead(&self) -> Failure {
        let message =
            format!("the {0} is dead: it was destroyed, or this never was a {0}; use a living one", self.kind);
        Failure::new(enmm_status::ENMM_DEAD_HANDLE, message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_dies_with_its_thing_and_not_with_its_slot() {
        let table = Table::new(0x10, "thing");
        let first = table.insert(1).expect("room");
        assert_eq!(*table.find(first).expect("alive"), 1);
        table.remove(first).expect("alive");
        let second = table.insert(2).expect("room");
        assert_ne!(first, second);
        assert_eq!((first ^ second) & 0xffff_ffff, 0, "the slot is used again");
        let status = |handle| table.find(handle).expect_err("no such thing").status;
        assert_eq!(status(first), enmm_status::ENMM_DEAD_HANDLE);
        assert_eq!(table.remove(first).expect_err("dead").status, enmm_status::ENMM_DEAD_HANDLE);
        assert_eq!(status(0), enmm_status::ENMM_NULL_ARGUMENT);
        for made_up in [1, 0x10, second ^ 0x30, second + (1 << 8), second + (1 << 32), usize::MAX] {
            assert_eq!(status(made_up), enmm_status::ENMM_DEAD_HANDLE, "{made_up:#x}");
        }
        assert_eq!(*table.find(second).expect("alive"), 2);
    }

    #[test]
    fn a_thing_in_use_outlives_its_handle() {
        let table = Table::new(0x10, "thing");
        let handle = table.insert(7).expect("room");
        let used = table.find(handle).expect("alive");
        table.remove(handle).expect("alive");
        assert_eq!((*used, Arc::strong_count(&used)), (7, 1));
    }
}
