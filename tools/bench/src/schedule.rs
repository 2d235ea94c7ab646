//! Tasks that wait for each other on a number of threads: a thread that is free takes the last task that it has made
//! ready itself, else the oldest of another, which costs it time.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use enmm_fork::Task;

/// What threads share.
pub struct Limits<'a> {
    /// Threads.
    pub threads: usize,
    /// What it costs (s) to take a task that another thread has made ready.
    pub taking: f64,
    /// Bytes per second of all threads together.
    pub bandwidth: f64,
    /// Bytes per second of one thread in a part.
    pub rate: &'a dyn Fn(&str) -> f64,
}

impl Limits<'_> {
    /// How many times longer tasks of a part take when so many of them run at once.
    fn slower(&self, part: Option<&str>, tasks: usize) -> f64 {
        let demand = part.map_or(0.0, |part| (self.rate)(part) * self.threads.min(tasks) as f64);
        (demand / self.bandwidth).max(1.0)
    }
}

/// Seconds of all tasks together.
pub fn work(tasks: &[Task]) -> f64 {
    let of = |task: &Task| match task {
        Task::Work(seconds) => *seconds,
        Task::Fork(_, branches) => branches.iter().map(|tasks| work(tasks)).sum(),
    };
    tasks.iter().map(of).sum()
}

/// Seconds of the longest chain of tasks.
pub fn span(tasks: &[Task]) -> f64 {
    let of = |task: &Task| match task {
        Task::Work(seconds) => *seconds,
        Task::Fork(_, branches) => branches.iter().map(|tasks| span(tasks)).fold(0.0, f64::max),
    };
    tasks.iter().map(of).sum()
}

/// A task of the graph: its duration, what waits for it, and for how many it waits.
#[derive(Default)]
struct Node {
    seconds: f64,
    then: Vec<usize>,
    waits: usize,
}

/// Adds tasks behind a node; returns the last.
fn add(tasks: &[Task], part: Option<(&str, usize)>, after: usize, limits: &Limits, nodes: &mut Vec<Node>) -> usize {
    let mut last = after;
    for task in tasks {
        last = match task {
            Task::Work(seconds) => {
                let slower = limits.slower(part.map(|part| part.0), part.map_or(1, |part| part.1));
                link(&[last], seconds * slower, nodes)
            }
            Task::Fork(name, branches) => {
                // Branches within branches run beside those of other ones of the same part.
                let beside = part.filter(|part| part.0 == *name).map_or(1, |part| part.1) * branches.len();
                let ends: Vec<usize> =
                    branches.iter().map(|tasks| add(tasks, Some((name, beside)), last, limits, nodes)).collect();
                link(&ends, 0.0, nodes)
            }
        };
    }
    last
}

fn link(after: &[usize], seconds: f64, nodes: &mut Vec<Node>) -> usize {
    let node = nodes.len();
    after.iter().for_each(|&k| nodes[k].then.push(node));
    nodes.push(Node { seconds, then: Vec::new(), waits: after.len() });
    node
}

/// Seconds until all tasks are done.
pub fn schedule(tasks: &[Task], limits: &Limits) -> f64 {
    let mut nodes = vec![Node::default()];
    add(tasks, None, 0, limits, &mut nodes);
    // Times in whole picoseconds have an order.
    let ticks = |seconds: f64| (1e12 * seconds) as u64;
    // Nodes that are ready, the oldest first, each with the thread that made it so.
    let mut ready = vec![(0, 0)];
    let mut idle: Vec<usize> = (0..limits.threads).collect();
    let mut running = BinaryHeap::new();
    let mut now = 0;
    loop {
        // First all take what is their own, then the others what is left.
        for may_take in [false, true] {
            idle.retain(|&thread| {
                let own = ready.iter().rposition(|&(_, maker)| maker == thread);
                let Some(k) = own.or((may_take && !ready.is_empty()).then_some(0)) else { return true };
                let (node, maker) = ready.remove(k);
                let cost = if maker == thread { 0.0 } else { limits.taking };
                running.push(Reverse((now + ticks(nodes[node].seconds + cost), node, thread)));
                false
            });
        }
        let Some(Reverse((end, node, thread))) = running.pop() else { return 1e-12 * now as f64 };
        now = end;
        idle.push(thread);
        // The last branch of a fork is the first that its thread takes.
        for next in std::mem::take(&mut nodes[node].then) {
            nodes[next].waits -= 1;
            if nodes[next].waits == 0 {
                ready.push((next, thread));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(threads: usize) -> Limits<'static> {
        Limits { threads, taking: 0.0, bandwidth: f64::INFINITY, rate: &|_| 0.0 }
    }

    /// One second, four branches of 3, 1, 1, 1 s, and half a second.
    fn tasks() -> Vec<Task> {
        let branches = [3.0, 1.0, 1.0, 1.0].map(|seconds| vec![Task::Work(seconds)]);
        vec![Task::Work(1.0), Task::Fork("part", branches.into()), Task::Work(0.5)]
    }

    #[test]
    fn one_thread_takes_the_work_and_many_the_span() {
        assert_eq!([work(&tasks()), span(&tasks())], [7.5, 4.5]);
        for (threads, seconds) in [(1, 7.5), (2, 4.5), (4, 4.5)] {
            assert!((schedule(&tasks(), &limits(threads)) - seconds).abs() < 1e-9, "{threads} threads");
        }
    }

    #[test]
    fn forks_within_forks_share_the_threads() {
        let fork = |inner: Vec<Task>| Task::Fork("part", vec![inner.clone(), inner]);
        let nested = vec![fork(vec![fork(vec![Task::Work(1.0)]), Task::Work(2.0)])];
        for (threads, seconds) in [(1, 8.0), (2, 4.0), (4, 3.0)] {
            assert!((schedule(&nested, &limits(threads)) - seconds).abs() < 1e-9, "{threads} threads");
        }
    }

    #[test]
    fn forks_and_bandwidth_cost_time() {
        let dear = Limits { taking: 0.25, ..limits(2) };
        // The thread of the fork takes the three short branches from the last on, another the long one.
        assert!((schedule(&tasks(), &dear) - 4.75).abs() < 1e-9);
        // Four branches at 2 B/s each share 4 B/s.
        let narrow = Limits { bandwidth: 4.0, rate: &|_| 2.0, ..limits(4) };
        assert!((schedule(&tasks(), &narrow) - (1.0 + 6.0 + 0.5)).abs() < 1e-9);
        assert!((schedule(&tasks(), &Limits { threads: 2, ..narrow }) - 4.5).abs() < 1e-9);
    }
}
