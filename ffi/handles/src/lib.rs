//! Handles of models, states and instances, which hosts in C and importers of FMUs hold.
//!
//! A handle shows whether its object still exists without ever being dereferenced. It holds the generation of its slot
//! in the upper half, the slot above the lowest eight bits, and there a tag of the kind of object. A slot that is given
//! free gets the next generation, so that an old handle finds nothing; a slot whose generations are used up is never
//! used again.
//!
//! A process may fork while other threads use a table: see [`fork`].
#![deny(unsafe_op_in_unsafe_fn)]

pub mod fork;

use std::any::Any;
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

const _: () = assert!(usize::BITS == 64, "handles need 64 bits");

const SLOT_BITS: u32 = 24;
const TAG_BITS: u32 = 8;

/// The objects of one kind that are alive in this process.
pub struct Table<T> {
    tag: u8,
    slots: RwLock<Slots<T>>,
    /// Whether a fork waits for calls that use this table.
    waited_for: AtomicBool,
}

struct Slots<T> {
    /// Generation and object of each slot.
    list: Vec<(u32, Option<Arc<T>>)>,
    free: Vec<usize>,
}

/// Why a handle leads to no object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Missing {
    /// The handle is NULL.
    Null,
    /// The object was destroyed, or there never was one.
    Dead,
}

impl<T: Send + Sync + 'static> Table<T> {
    /// An empty table; `tag` is part of its handles.
    pub const fn new(tag: u8) -> Self {
        let slots = RwLock::new(Slots { list: Vec::new(), free: Vec::new() });
        Self { tag, slots, waited_for: AtomicBool::new(false) }
    }

    /// Takes an object and returns its handle.
    ///
    /// # Errors
    /// The object itself, when millions of others are alive.
    pub fn insert(&'static self, object: T) -> Result<usize, T> {
        fork::wait_for(self, &self.waited_for);
        let mut slots = self.write();
        let slot = match slots.free.pop() {
            Some(slot) => slot,
            None if slots.list.len() < 1 << SLOT_BITS => {
                slots.list.push((1, None));
                slots.list.len() - 1
            }
            None => return Err(object),
        };
        slots.list[slot].1 = Some(Arc::new(object));
        Ok((slots.list[slot].0 as usize) << 32 | slot << TAG_BITS | usize::from(self.tag))
    }

    /// The object of a handle.
    ///
    /// # Errors
    /// No object of this table has the handle.
    pub fn find(&self, handle: usize) -> Result<Arc<T>, Missing> {
        let (slot, generation) = self.split(handle)?;
        match self.read().list.get(slot) {
            Some((own, Some(object))) if *own == generation => Ok(Arc::clone(object)),
            _ => Err(Missing::Dead),
        }
    }

    /// Gives a slot free; the object goes when the last call that uses it ends.
    ///
    /// # Errors
    /// As [`Table::find`].
    pub fn remove(&self, handle: usize) -> Result<(), Missing> {
        let (slot, generation) = self.split(handle)?;
        let mut slots = self.write();
        let found = slots.list.get_mut(slot).filter(|(own, object)| *own == generation && object.is_some());
        let Some((own, object)) = found else { return Err(Missing::Dead) };
        let object = object.take();
        if let Some(next) = own.checked_add(1) {
            *own = next;
            slots.free.push(slot);
        }
        drop(slots);
        drop(object);
        Ok(())
    }

    /// Slot and generation. The handle of a table that never held an object is dead before its lock is taken, for which
    /// no fork waits yet.
    fn split(&self, handle: usize) -> Result<(usize, u32), Missing> {
        if handle == 0 {
            return Err(Missing::Null);
        }
        if handle & ((1 << TAG_BITS) - 1) != usize::from(self.tag) || !self.waited_for.load(Ordering::Acquire) {
            return Err(Missing::Dead);
        }
        Ok(((handle & 0xffff_ffff) >> TAG_BITS, (handle >> 32) as u32))
    }

    fn read(&self) -> RwLockReadGuard<'_, Slots<T>> {
        self.slots.read().unwrap_or_else(PoisonError::into_inner)
    }

    fn write(&self) -> RwLockWriteGuard<'_, Slots<T>> {
        self.slots.write().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T: Send + Sync + 'static> fork::Shared for Table<T> {
    fn hold(&'static self) -> Box<dyn Any> {
        Box::new(self.write())
    }
}

impl<T> fmt::Debug for Table<T> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "Table({:#x})", self.tag)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_dies_with_its_object_and_not_with_its_slot() {
        static TABLE: Table<i32> = Table::new(0x10);
        assert_eq!(TABLE.find(1 << 32 | 0x10).expect_err("nothing yet"), Missing::Dead);
        let first = TABLE.insert(1).expect("room");
        assert_eq!(*TABLE.find(first).expect("alive"), 1);
        TABLE.remove(first).expect("alive");
        let second = TABLE.insert(2).expect("room");
        assert_ne!(first, second);
        assert_eq!((first ^ second) & 0xffff_ffff, 0, "the slot is used again");
        let missing = |handle| TABLE.find(handle).expect_err("no such object");
        assert_eq!(missing(first), Missing::Dead);
        assert_eq!(TABLE.remove(first).expect_err("dead"), Missing::Dead);
        assert_eq!(missing(0), Missing::Null);
        for made_up in [1, 0x10, second ^ 0x30, second + (1 << 8), second + (1 << 32), usize::MAX] {
            assert_eq!(missing(made_up), Missing::Dead, "{made_up:#x}");
        }
        assert_eq!(*TABLE.find(second).expect("alive"), 2);
    }

    #[test]
    fn an_object_in_use_outlives_its_handle() {
        static TABLE: Table<i32> = Table::new(0x10);
        let handle = TABLE.insert(7).expect("room");
        let used = TABLE.find(handle).expect("alive");
        TABLE.remove(handle).expect("alive");
        assert_eq!((*used, Arc::strong_count(&used)), (7, 1));
    }

    #[test]
    fn threads_that_come_and_go_find_their_own_objects() {
        static TABLE: Table<usize> = Table::new(0x10);
        let churn = |of: usize| {
            for k in 0..if cfg!(miri) { 20 } else { 2000 } {
                let handle = TABLE.insert(of + k).expect("room");
                assert_eq!(*TABLE.find(handle).expect("alive"), of + k);
                TABLE.remove(handle).expect("alive");
                assert!(TABLE.find(handle).is_err());
            }
        };
        std::thread::scope(|scope| (0..4).for_each(|k| drop(scope.spawn(move || churn(k << 20)))));
    }
}
