//! What a step would take on more threads than the machine has: its tasks are recorded on one thread, with the bits and
//! the cuts of several, and scheduled on any number.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::mem::size_of;
use std::time::Instant;

use serde::Serialize;

use super::schedule::{Limits, schedule, span, work};
use super::{BenchError, Machine, Model, in_pool};
use enmm::contact::{ContactHistory, NearPair, VertexEdge};
use enmm::model::Simulation;
use enmm_fork::{Task, record};

/// Numbers of threads that are predicted.
const THREADS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];
/// Steps that are recorded, after one that takes up the state anew.
const STEPS: usize = 8;
/// Times that they are recorded and timed: each task counts with its least duration.
const REPEATS: usize = 12;
/// Forks that are timed; the share of them that is quicker than the one that counts, since a machine with other work
/// seldom has its second thread there; and the work (s) of each of their two branches.
const FORKS: usize = 50_000;
const QUICKER: f64 = 0.01;
const BRANCH: f64 = 20e-6;
/// Bytes that a sweep moves for a contact in its first round; it is in the cache in the second.
const SWEPT_BYTES: f64 = 224.0;
/// Bytes that a step moves for an element, and for a cover in both of its passes.
const CHUNK_BYTES: [f64; 2] = [14.0, 210.0];
/// Stretches of serial work that are named.
const STRETCHES: usize = 6;

/// A step of a model on several numbers of threads.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Prediction {
    /// Name of the model.
    pub model: String,
    /// Tasks of a step.
    pub tasks: usize,
    /// Work of all tasks together (ms per step).
    pub work_ms: f64,
    /// The longest chain of tasks that wait for each other (ms per step).
    pub span_ms: f64,
    /// What it costs a second thread to take a branch (µs), as measured.
    pub fork_us: f64,
    /// Bytes per second of memory on one thread and on all, as measured.
    pub bandwidth: [f64; 2],
    /// The numbers of threads.
    pub threads: Vec<Predicted>,
    /// The longest serial stretches: between which parallel parts, and ms per step.
    pub serial: Vec<(String, f64)>,
    /// Bytes (MB) and time (ms) per step by parallel part, on one thread.
    pub parts: Vec<(&'static str, f64, f64)>,
}

/// A step on a number of threads.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Predicted {
    /// Threads.
    pub threads: usize,
    /// ms per step when memory sets no limit.
    pub free_ms: f64,
    /// ms per step when all threads together have the bandwidth of this machine.
    pub bound_ms: f64,
    /// ms per step as measured, where the machine has so many cores.
    pub measured_ms: Option<f64>,
}

/// Records some steps of a model and predicts what one takes on more threads.
///
/// # Errors
/// A model that cannot be built or fails.
pub fn predict(model: &Model) -> Result<Prediction, BenchError> {
    let machine = Machine::here(true);
    let memory = machine.bandwidth.last().map_or([f64::INFINITY; 2], |level| [level.one, level.all]);
    let (steps, bytes) = in_pool(1, || recorded(model))??;
    let measured = |threads| (threads <= machine.cores).then(|| timed(model, threads)).transpose();
    let fork = if machine.cores > 1 { in_pool(2, fork_seconds)? } else { 0.0 };
    let per_step = 1e3 / STEPS as f64;
    let mut by_part = BTreeMap::new();
    steps.iter().for_each(|tasks| add_parts(tasks, None, &mut by_part));
    let rate = |name: &str| bytes.get(name).zip(by_part.get(name)).map_or(0.0, |(bytes, seconds)| bytes / seconds);
    let total = |n, bandwidth: f64| -> f64 {
        let limits = Limits { threads: n, taking: fork, bandwidth, rate: &rate };
        steps.iter().map(|tasks| schedule(tasks, &limits)).sum::<f64>() * per_step
    };
    let threads = THREADS.map(|n| {
        let bandwidth = if n == 1 { f64::INFINITY } else { memory[1] };
        let (free_ms, bound_ms) = (total(n, f64::INFINITY), total(n, bandwidth));
        Ok(Predicted { threads: n, free_ms, bound_ms, measured_ms: measured(n)? })
    });
    Ok(Prediction {
        model: model.to_string(),
        tasks: steps.iter().map(|tasks| count(tasks)).sum::<usize>() / STEPS,
        work_ms: steps.iter().map(|tasks| work(tasks)).sum::<f64>() * per_step,
        span_ms: steps.iter().map(|tasks| span(tasks)).sum::<f64>() * per_step,
        fork_us: 1e6 * fork,
        bandwidth: memory,
        threads: threads.into_iter().collect::<Result<_, BenchError>>()?,
        serial: serial_stretches(&steps, per_step),
        parts: by_part
            .iter()
            .map(|(&name, seconds)| (name, bytes.get(name).copied().unwrap_or(0.0) / STEPS as f64, seconds * per_step))
            .map(|(name, bytes, ms)| (name, 1e-6 * bytes, ms))
            .collect(),
    })
}

/// A model in the state from which steps are timed.
fn ready(model: &Model) -> Result<Simulation, BenchError> {
    let mut simulation = model.build()?;
    model.warm(&mut simulation)?;
    Ok(simulation)
}

/// A number of each parallel part.
type ByPart = BTreeMap<&'static str, f64>;

/// The tasks of some steps, each with its least duration, and the bytes that the parallel parts move in all of them.
fn recorded(model: &Model) -> Result<(Vec<Vec<Task>>, ByPart), BenchError> {
    let mut simulation = ready(model)?;
    let start = simulation.state().clone();
    let mut least: Vec<Vec<Task>> = Vec::new();
    let mut bytes = BTreeMap::new();
    for _ in 0..REPEATS {
        simulation.restore(start.clone());
        simulation.advance(false)?;
        let before = simulation.state().counters.contacts_solved;
        let mut steps = Vec::new();
        for _ in 0..STEPS {
            let (done, tasks) = record(|| simulation.advance(false).map(|_| ()));
            done?;
            steps.push(tasks);
        }
        let solved = (simulation.state().counters.contacts_solved - before) as f64;
        bytes = moved(&simulation, solved);
        if least.is_empty() {
            least = steps;
        } else {
            least.iter_mut().zip(&steps).for_each(|(least, tasks)| take_least(least, tasks));
        }
    }
    Ok((least, bytes))
}

/// Bytes that the parallel parts move in all recorded steps when nothing is in a cache that another part left there.
fn moved(simulation: &Simulation, solved: f64) -> ByPart {
    let (model, state) = (simulation.model(), simulation.state());
    let steps = STEPS as f64;
    let [contacts, near] = [simulation.workspace().contacts.len(), state.neighbours.pairs.len()].map(|n| n as f64);
    let [elements, covers] = [model.covers.element_count(), model.covers.cover_count()].map(|n| n as f64);
    let [contact, history] = [size_of::<VertexEdge>(), size_of::<ContactHistory>()].map(|n| n as f64);
    BTreeMap::from([
        ("chunks", steps * (CHUNK_BYTES[0] * elements + CHUNK_BYTES[1] * covers)),
        ("vertex rule", steps * near * size_of::<NearPair>() as f64),
        ("contacts", steps * contacts * contact),
        ("sweep", solved * SWEPT_BYTES / 2.0 + steps * contacts * (contact + SWEPT_BYTES)),
        ("forces", steps * contacts * (contact + SWEPT_BYTES)),
        ("histories", steps * contacts * (contact + history)),
    ])
}

/// Gives tasks the lesser of two durations; both records are of the same steps.
fn take_least(least: &mut [Task], other: &[Task]) {
    for (least, other) in least.iter_mut().zip(other) {
        match (least, other) {
            (Task::Work(least), Task::Work(other)) => *least = least.min(*other),
            (Task::Fork(_, least), Task::Fork(_, other)) => {
                least.iter_mut().zip(other).for_each(|(least, other)| take_least(least, other));
            }
            _ => {}
        }
    }
}

/// Milliseconds per step of the same steps on so many threads, each step at its quickest.
fn timed(model: &Model, threads: usize) -> Result<f64, BenchError> {
    in_pool(threads, || {
        let mut simulation = ready(model)?;
        let start = simulation.state().clone();
        let mut least = [f64::INFINITY; STEPS];
        for _ in 0..REPEATS {
            simulation.restore(start.clone());
            simulation.advance(false)?;
            for least in &mut least {
                let clock = Instant::now();
                simulation.advance(false)?;
                *least = least.min(clock.elapsed().as_secs_f64());
            }
        }
        Ok(1e3 * least.iter().sum::<f64>() / STEPS as f64)
    })?
}

/// What a fork with two branches on two threads takes beyond one of them (s), in a quiet moment.
fn fork_seconds() -> f64 {
    let spin = || {
        let clock = Instant::now();
        while clock.elapsed().as_secs_f64() < BRANCH {
            black_box(());
        }
    };
    let one = || {
        let clock = Instant::now();
        rayon::join(spin, spin);
        clock.elapsed().as_secs_f64() - BRANCH
    };
    let mut costs: Vec<f64> = (0..FORKS).map(|_| one()).collect();
    costs.sort_by(f64::total_cmp);
    costs[(QUICKER * FORKS as f64) as usize].max(0.0)
}

fn count(tasks: &[Task]) -> usize {
    let of = |task: &Task| match task {
        Task::Work(_) => 1,
        Task::Fork(_, branches) => branches.iter().map(|tasks| count(tasks)).sum(),
    };
    tasks.iter().map(of).sum()
}

/// Adds up the work (s) by the innermost fork that it is in.
fn add_parts(tasks: &[Task], of: Option<&'static str>, parts: &mut ByPart) {
    for task in tasks {
        match task {
            Task::Work(seconds) => of.into_iter().for_each(|name| *parts.entry(name).or_insert(0.0) += seconds),
            Task::Fork(name, branches) => branches.iter().for_each(|tasks| add_parts(tasks, Some(name), parts)),
        }
    }
}

/// The longest stretches outside all forks, by the forks before and after them.
fn serial_stretches(steps: &[Vec<Task>], per_step: f64) -> Vec<(String, f64)> {
    let mut stretches: BTreeMap<String, f64> = BTreeMap::new();
    for tasks in steps {
        let name = |task: Option<&Task>, edge: &str| match task {
            Some(Task::Fork(name, _)) => (*name).to_owned(),
            _ => edge.to_owned(),
        };
        for (k, task) in tasks.iter().enumerate() {
            if let Task::Work(seconds) = task {
                let before = name(k.checked_sub(1).and_then(|k| tasks.get(k)), "begin");
                let key = format!("{before} … {}", name(tasks.get(k + 1), "end"));
                *stretches.entry(key).or_insert(0.0) += seconds * per_step;
            }
        }
    }
    let mut longest: Vec<(String, f64)> = stretches.into_iter().collect();
    longest.sort_by(|a, b| b.1.total_cmp(&a.1));
    longest.truncate(STRETCHES);
    longest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failed(error: impl std::fmt::Display) -> ! {
        panic!("{error}")
    }

    #[test]
    fn recorded_steps_have_the_bits_of_others_and_many_tasks() {
        let model = Model::Slope(500, 4);
        let mut plain = ready(&model).unwrap_or_else(|e| failed(e));
        let mut cut = ready(&model).unwrap_or_else(|e| failed(e));
        plain.advance(false).unwrap_or_else(|e| failed(e));
        let step = || record(|| cut.advance(false).map(|_| ()));
        let (done, tasks) = in_pool(1, step).unwrap_or_else(|e| failed(e));
        done.unwrap_or_else(|e| failed(e));
        assert!(plain.state() == cut.state(), "states differ");
        assert!(count(&tasks) > 10 && work(&tasks) > 0.0, "{} tasks", count(&tasks));
        let mut parts = BTreeMap::new();
        add_parts(&tasks, None, &mut parts);
        assert!(
            ["vertex rule", "contacts", "sweep", "histories"].iter().all(|name| parts.contains_key(name)),
            "{parts:?}"
        );
        let limits = |threads| Limits { threads, taking: 0.0, bandwidth: f64::INFINITY, rate: &|_| 0.0 };
        let (all, chain) = (work(&tasks), span(&tasks));
        for threads in THREADS {
            let seconds = schedule(&tasks, &limits(threads));
            let least = chain.max(all / threads as f64);
            // Whoever is free takes what is ready: no more than the work in even parts and the chain behind it.
            assert!(seconds > 0.999 * least && seconds < 1.001 * (all / threads as f64 + chain), "{threads} threads");
        }
    }

    #[test]
    fn the_lesser_of_two_durations_counts() {
        let tasks = |a, b| vec![Task::Work(a), Task::Fork("part", vec![vec![Task::Work(b)]])];
        let mut least = tasks(1.0, 4.0);
        take_least(&mut least, &tasks(2.0, 3.0));
        assert_eq!(least, tasks(1.0, 3.0));
    }
}
