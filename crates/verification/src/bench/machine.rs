//! The machine and its limits: how fast it streams from each level of memory, and how fast it multiplies and adds.
//!
//! Both run on the widest lanes of the processor, as the engine does, and like it never fuse a product with a sum.

use std::fs;
use std::hint::black_box;
use std::time::Instant;

use enmm_lanes::{Kernel, LANES, Lanes, dispatch};
use serde::Serialize;

/// Levels of memory: name, and numbers in each of the three arrays that are streamed.
const LEVELS: [(&str, usize); 4] = [("L1", 1 << 10), ("L2", 20 << 10), ("L3", 400 << 10), ("DRAM", 6 << 20)];
/// Shortest time (s) of one measurement.
const SAMPLE: f64 = 1e-3;
/// Measurements, of which the fastest counts.
const SAMPLES: usize = 12;
/// Accumulators that do not wait for each other.
const CHAINS: usize = 16;

/// A machine.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Machine {
    /// Processor, as it calls itself.
    pub processor: Option<String>,
    /// Cores that the program may use.
    pub cores: usize,
    /// Caches of one core: level, kind, size.
    pub caches: Vec<String>,
    /// Bytes per second from each level of memory; empty when not measured.
    pub bandwidth: Vec<Bandwidth>,
    /// Floating-point operations per second, one thread and all together; none when not measured.
    pub multiply_add: Option<[f64; 2]>,
}

/// How fast a level of memory streams: `a = b + s·c`, 24 bytes for each number of `a`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bandwidth {
    /// Level.
    pub level: String,
    /// Bytes that one thread streams through.
    pub bytes: usize,
    /// Bytes per second of one thread.
    pub one: f64,
    /// Bytes per second of all threads together.
    pub all: f64,
}

impl Machine {
    /// The machine that the program runs on; its limits are measured when asked for.
    pub fn here(limits: bool) -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let mut machine = Self { processor: processor(), cores, caches: caches(), ..Self::default() };
        if limits {
            machine.bandwidth = LEVELS.map(|(level, length)| bandwidth(level, length, cores)).into();
            machine.multiply_add = Some([1, cores].map(|threads| together(threads, operations_per_second)));
        }
        machine
    }

    /// Bytes per second of one thread from the memory that holds a working set of so many bytes.
    pub fn bandwidth_for(&self, bytes: f64) -> Option<f64> {
        let holds = |level: &&Bandwidth| bytes <= 2.0 * level.bytes as f64;
        self.bandwidth.iter().find(holds).or(self.bandwidth.last()).map(|level| level.one)
    }
}

fn bandwidth(level: &str, length: usize, cores: usize) -> Bandwidth {
    let rate = |threads| together(threads, || bytes_per_second(length));
    Bandwidth { level: level.to_owned(), bytes: 24 * length, one: rate(1), all: rate(cores) }
}

/// Sum of the rates that so many threads reach beside each other.
fn together(threads: usize, rate: impl Fn() -> f64 + Sync) -> f64 {
    if threads == 1 {
        return rate();
    }
    std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(&rate)).collect();
        running.into_iter().filter_map(|thread| thread.join().ok()).sum()
    })
}

fn bytes_per_second(length: usize) -> f64 {
    let (b, c) = (vec![1.0; length], vec![2.0; length]);
    let mut a = vec![0.0; length];
    let pass = || dispatch(Triad { a: black_box(&mut a), b: black_box(&b), c: black_box(&c), s: 0.5 });
    24.0 * length as f64 * passes_per_second(pass)
}

fn operations_per_second() -> f64 {
    const ROUNDS: usize = 1000;
    let mut sums = [[1.0; LANES]; CHAINS];
    let pass = || dispatch(MultiplyAdd { sums: black_box(&mut sums), factor: 0.999_9, addend: 1e-4, rounds: ROUNDS });
    2.0 * (LANES * CHAINS * ROUNDS) as f64 * passes_per_second(pass)
}

/// How often a second the fastest of several measurements did a pass.
fn passes_per_second(mut pass: impl FnMut()) -> f64 {
    let mut count = 1_u32;
    let mut time = |count: u32| {
        let clock = Instant::now();
        (0..count).for_each(|_| pass());
        clock.elapsed().as_secs_f64()
    };
    while time(count) < SAMPLE {
        count *= 2;
    }
    let fastest = (0..SAMPLES).map(|_| time(count)).fold(f64::INFINITY, f64::min);
    f64::from(count) / fastest
}

/// `a = b + s·c`, as many numbers of each.
struct Triad<'a> {
    a: &'a mut [f64],
    b: &'a [f64],
    c: &'a [f64],
    s: f64,
}

impl Kernel for Triad<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let s = lanes.splat(self.s);
        let rows = self.a.as_chunks_mut::<LANES>().0.iter_mut();
        let rows = rows.zip(self.b.as_chunks::<LANES>().0).zip(self.c.as_chunks::<LANES>().0);
        rows.for_each(|((a, b), c)| lanes.store(lanes.load(b) + s * lanes.load(c), a));
    }
}

/// `sums = sums·factor + addend`, so many times over.
struct MultiplyAdd<'a> {
    sums: &'a mut [[f64; LANES]; CHAINS],
    factor: f64,
    addend: f64,
    rounds: usize,
}

impl Kernel for MultiplyAdd<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let (factor, addend) = (lanes.splat(self.factor), lanes.splat(self.addend));
        let mut sums = [addend; CHAINS];
        for _ in 0..self.rounds {
            for sum in &mut sums {
                *sum = *sum * factor + addend;
            }
        }
        self.sums.iter_mut().zip(sums).for_each(|(out, sum)| lanes.store(sum, out));
    }
}

fn processor() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let (_, name) = text.lines().find(|line| line.starts_with("model name"))?.split_once(':')?;
    Some(name.trim().to_owned())
}

fn caches() -> Vec<String> {
    let cache = |k: usize| {
        let read = |name: &str| fs::read_to_string(format!("/sys/devices/system/cpu/cpu0/cache/index{k}/{name}")).ok();
        let (level, kind, size) = (read("level")?, read("type")?, read("size")?);
        Some(format!("L{} {} {}", level.trim(), kind.trim().to_lowercase(), size.trim()))
    };
    (0..).map_while(cache).collect()
}
