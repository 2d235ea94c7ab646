//! Work that is shared between threads: by rayon, or one task after the other while each is timed.
//!
//! A recording shows how much of a piece of work may run at once, and what is serial, on a machine that has not as many
//! threads. It is of the calling thread alone: others share their work as ever. Without one, a call costs a look at a
//! variable of the thread.
#![forbid(unsafe_code)]

use std::cell::RefCell;
use std::time::Instant;

use rayon::iter::ParallelIterator;

/// Threads for which recorded work is cut.
const RECORDED: usize = 64;

/// A piece of recorded work.
#[derive(Debug, Clone, PartialEq)]
pub enum Task {
    /// Work of one thread (s).
    Work(f64),
    /// Sequences of tasks that may run at once; the next task waits for all.
    Fork(&'static str, Vec<Vec<Task>>),
}

/// What has been recorded and is not finished.
struct Recording {
    since: Instant,
    /// Sequences that have begun, the innermost last.
    sequences: Vec<Vec<Task>>,
    /// Finished sequences of the forks that have begun.
    forks: Vec<Vec<Vec<Task>>>,
}

thread_local! {
    static RECORDING: RefCell<Option<Recording>> = const { RefCell::new(None) };
}

impl Recording {
    /// Adds a task to the innermost sequence.
    fn push(&mut self, task: Task) {
        if let Some(tasks) = self.sequences.last_mut() {
            tasks.push(task);
        }
    }

    /// Books the time since the last task as work of the innermost sequence.
    fn book(&mut self) {
        let seconds = self.since.elapsed().as_secs_f64();
        self.push(Task::Work(seconds));
    }
}

/// Changes the recording, the time of which goes into no task.
fn change(by: impl FnOnce(&mut Recording)) {
    RECORDING.with_borrow_mut(|recording| {
        if let Some(recording) = recording {
            by(recording);
            recording.since = Instant::now();
        }
    });
}

/// Whether the calling thread is recorded: work is then cut as for several threads.
pub fn is_recorded() -> bool {
    RECORDING.with_borrow(Option::is_some)
}

/// Threads for which work is cut: those of the pool, and of a recorded thread as many as a large machine has.
pub fn threads() -> usize {
    if is_recorded() { RECORDED } else { rayon::current_num_threads() }
}

/// Does the work and records its tasks; it should run in a pool of one thread.
pub fn record<R>(work: impl FnOnce() -> R) -> (R, Vec<Task>) {
    let fresh = Recording { since: Instant::now(), sequences: vec![Vec::new()], forks: Vec::new() };
    RECORDING.set(Some(fresh));
    let result = work();
    change(Recording::book);
    let recorded = RECORDING.take();
    (result, recorded.and_then(|mut recording| recording.sequences.pop()).unwrap_or_default())
}

/// Does two pieces of work at once.
pub fn join<A: Send, B: Send>(
    name: &'static str,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if is_recorded() { fork(name, || (branch(first), branch(second))) } else { rayon::join(first, second) }
}

/// Does the work on all items at once.
pub fn each<I: ParallelIterator>(name: &'static str, items: I, work: impl Fn(I::Item) + Sync + Send) {
    if is_recorded() {
        fork(name, || items.for_each(|item| branch(|| work(item))));
    } else {
        items.for_each(work);
    }
}

/// Does work that is shared in even parts of `grain` of its `length` items.
pub fn spread(name: &'static str, length: usize, grain: usize, work: impl FnOnce()) {
    if !is_recorded() {
        return work();
    }
    change(Recording::book);
    let clock = Instant::now();
    work();
    let parts = length.div_ceil(grain).max(1);
    let part = vec![Task::Work(clock.elapsed().as_secs_f64() / parts as f64)];
    change(|recording| recording.push(Task::Fork(name, vec![part; parts])));
}

fn fork<R>(name: &'static str, work: impl FnOnce() -> R) -> R {
    change(|recording| {
        recording.book();
        recording.forks.push(Vec::new());
    });
    let result = work();
    change(|recording| {
        let branches = recording.forks.pop().unwrap_or_default();
        recording.push(Task::Fork(name, branches));
    });
    result
}

fn branch<R>(work: impl FnOnce() -> R) -> R {
    change(|recording| recording.sequences.push(Vec::new()));
    let result = work();
    change(|recording| {
        recording.book();
        let tasks = recording.sequences.pop().unwrap_or_default();
        if let Some(branches) = recording.forks.last_mut() {
            branches.push(tasks);
        }
    });
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    /// The names and numbers of branches of the forks, in their order.
    fn forks(tasks: &[Task]) -> Vec<(&'static str, usize)> {
        let of = |task: &Task| match task {
            Task::Work(seconds) => {
                assert!(*seconds >= 0.0);
                Vec::new()
            }
            Task::Fork(name, branches) => {
                let within = branches.iter().flat_map(|tasks| forks(tasks));
                std::iter::once((*name, branches.len())).chain(within).collect()
            }
        };
        tasks.iter().flat_map(of).collect()
    }

    #[test]
    fn work_is_done_once_with_and_without_a_record() {
        let work = || {
            let mut squares = [1, 2, 3, 4];
            each("squares", squares.par_iter_mut(), |x| *x *= *x);
            let (a, b) = join("halves", || squares[..2].iter().sum::<i32>(), || squares[2..].iter().sum::<i32>());
            let mut sum = 0;
            spread("sum", 10, 4, || sum = a + b);
            sum
        };
        assert_eq!(work(), 30);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
        let (sum, tasks) = pool.install(|| record(work));
        assert_eq!(sum, 30);
        assert_eq!(forks(&tasks), [("squares", 4), ("halves", 2), ("sum", 3)]);
        assert!(!is_recorded());
    }

    #[test]
    fn forks_within_forks_are_branches_of_theirs() {
        let inner = || join("inner", || (), || ());
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
        let (_, tasks) = pool.install(|| record(|| join("outer", inner, || ())));
        let [Task::Work(_), Task::Fork("outer", branches), Task::Work(_)] = &tasks[..] else { panic!("{tasks:?}") };
        assert_eq!([forks(&branches[0]).len(), forks(&branches[1]).len()], [1, 0]);
    }
}
