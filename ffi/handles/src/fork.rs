//! A fork waits until no other thread is inside a table, so that the forked process has no lock whose owner is gone.

use std::any::Any;
use std::cell::RefCell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Something that threads share under a lock.
pub(crate) trait Shared: Sync {
    /// Takes the lock; it is free again when the result is dropped.
    fn hold(&'static self) -> Box<dyn Any>;
}

/// All that a fork waits for, in the order in which it takes the locks.
static SHARED: Mutex<Vec<&'static dyn Shared>> = Mutex::new(Vec::new());

/// Locks that a fork holds; they are given free from the last to the first.
struct Held {
    tables: Vec<Box<dyn Any>>,
    _list: MutexGuard<'static, Vec<&'static dyn Shared>>,
}

thread_local! {
    /// Locks of the fork that this thread is about to make.
    static HELD: RefCell<Option<Held>> = const { RefCell::new(None) };
}

/// Has every later fork of this process wait for `shared`, from before its first use on.
pub(crate) fn wait_for(shared: &'static dyn Shared, waited_for: &AtomicBool) {
    if waited_for.load(Ordering::Acquire) {
        return;
    }
    call_at_forks();
    let mut list = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
    if !waited_for.swap(true, Ordering::AcqRel) {
        list.push(shared);
    }
}

/// Takes all locks, once: two threads that begin at the same time may both have asked to be called.
fn before() {
    let hold = |held: &RefCell<Option<Held>>| {
        if held.borrow().is_none() {
            let list = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
            let tables = list.iter().map(|shared| shared.hold()).collect();
            held.replace(Some(Held { tables, _list: list }));
        }
    };
    // A thread that is being torn down keeps no locks.
    let _ = HELD.try_with(hold);
}

/// Gives all locks free, in the process that forks and in the new one.
fn after() {
    let release = |held: &RefCell<Option<Held>>| {
        if let Some(mut held) = held.take() {
            while held.tables.pop().is_some() {}
        }
    };
    let _ = HELD.try_with(release);
}

#[cfg(all(unix, not(miri)))]
fn call_at_forks() {
    static ASKED: AtomicBool = AtomicBool::new(false);
    extern "C" fn prepare() {
        before();
    }
    extern "C" fn release() {
        after();
    }
    if !ASKED.load(Ordering::Acquire) {
        // SAFETY: the functions take and give locks of this thread, which the thread that forks may do on both sides.
        // The C library drops them when it unloads this one.
        let refused = unsafe { libc::pthread_atfork(Some(prepare), Some(release), Some(release)) };
        // Without memory for three addresses the process goes on as it would without them.
        ASKED.store(refused == 0, Ordering::Release);
    }
}

#[cfg(any(not(unix), miri))]
fn call_at_forks() {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Table;

    #[test]
    fn a_fork_waits_for_the_tables_and_then_lets_go() {
        static TABLE: Table<i32> = Table::new(0x10);
        let handle = TABLE.insert(1).expect("room");
        before();
        before();
        let other = std::thread::spawn(move || *TABLE.find(handle).expect("alive"));
        std::thread::sleep(std::time::Duration::from_millis(20));
        assert!(!other.is_finished(), "a fork holds the table");
        after();
        after();
        assert_eq!(other.join().expect("no panic"), 1);
    }
}
