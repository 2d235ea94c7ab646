//! One model timed: windows of steps that start from the same state again and again.

use std::time::Instant;

use serde::Serialize;

use super::clock::{forget_peak, memory_peak, processor_seconds};
use super::models::{Model, advance};
use super::{BenchError, Machine};
use crate::io::checkpoint::encode;
use crate::io::vtu::{write_joints_vtu, write_vtu};
use crate::model::Simulation;
use crate::state::{Counters, Seconds};

/// Element updates in a window; small models take more steps, and large ones the fewest.
const WINDOW_UPDATES: u64 = 1_000_000;
/// Fewest and most steps of a window.
const WINDOW_STEPS: [u64; 2] = [20, 200];
/// Fewest windows.
const WINDOWS_MIN: usize = 2;
/// Floating-point operations of one element: gradient 22, rotation 8, stretch 4, stress 12, forces 22, their sum 6.
const OPERATIONS_PER_ELEMENT: f64 = 74.0;
/// Bytes of an element that a step must read: three covers, cut area, triangle and rock.
const ELEMENT_BYTES: f64 = 3.0 * 4.0 + 8.0 + 2.0;
/// Bytes of a cover that a step must move: place, masses and load read once, displacement and velocity read and
/// written, force, damped and predicted velocity written and read.
const COVER_BYTES: f64 = 16.0 + 3.0 * 8.0 + 16.0 + 2.0 * 32.0 + 3.0 * 32.0;

/// What a model costs. Times are those of the quickest window.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Measured {
    /// Name of the model.
    pub model: String,
    /// Clock of all rates and milliseconds: `processor` (one thread, time that it really had) or `wall`.
    pub clock: &'static str,
    /// Free blocks.
    pub blocks: usize,
    /// Manifold elements of free blocks.
    pub elements: usize,
    /// Manifold elements of held blocks, which no step touches.
    pub held_elements: usize,
    /// Physical covers.
    pub covers: usize,
    /// Pieces of the boundary that the search looks at.
    pub boundary_edges: usize,
    /// Contacts of the last step.
    pub contacts: usize,
    /// Internal step (s).
    pub dt: f64,
    /// Steps of a window.
    pub steps: u64,
    /// Windows timed.
    pub windows: usize,
    /// Median over the quickest window.
    pub spread: f64,
    /// Milliseconds per step.
    pub ms_per_step: f64,
    /// Milliseconds of wall time per step, in the window of least wall time.
    pub wall_ms_per_step: f64,
    /// Seconds per simulated second.
    pub seconds_per_simulated_second: f64,
    /// Milliseconds per step of each stage.
    pub stages: StageMilliseconds,
    /// Mean sweeps of a step.
    pub sweeps_mean: f64,
    /// Contacts times sweeps per second of the open–close iteration; null without contact.
    pub contact_sweeps_per_second: Option<f64>,
    /// Elements per second of the element stage.
    pub elements_per_second: f64,
    /// Elements per second of the whole step.
    pub step_elements_per_second: f64,
    /// Searches for near edges in a window.
    pub searches: u64,
    /// Milliseconds of one search, looks for stale pairs included; null when the window had none.
    pub ms_per_search: Option<f64>,
    /// Milliseconds to write one frame of elements and joints.
    pub frame_ms: f64,
    /// Milliseconds to encode one checkpoint.
    pub checkpoint_ms: f64,
    /// Bytes of one checkpoint, which holds the whole state.
    pub state_bytes: usize,
    /// Time to build the model (s).
    pub build_seconds: f64,
    /// Most memory (bytes) that the program held from the build of the model on; null where the system does not tell.
    pub memory_peak: Option<u64>,
    /// The same per element.
    pub memory_per_element: Option<f64>,
    /// Bytes that the element stage must move for an element and its share of covers.
    pub bytes_per_element: f64,
    /// Floating-point operations of an element.
    pub operations_per_element: f64,
    /// Share of what one thread streams from the memory that holds the model, in the element stage.
    pub share_of_bandwidth: Option<f64>,
    /// Share of what one thread multiplies and adds, in the element stage.
    pub share_of_operations: Option<f64>,
}

/// Milliseconds per step of each stage.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct StageMilliseconds {
    /// Search for near edges.
    pub search: f64,
    /// Elements and kick.
    pub elements: f64,
    /// Vertex rule and contact geometry.
    pub entrance: f64,
    /// Open–close iteration.
    pub sweep: f64,
    /// Velocities, positions, ledger.
    pub commit: f64,
    /// What no stage claims.
    pub rest: f64,
}

impl StageMilliseconds {
    /// The stages with their names.
    pub fn named(&self) -> [(&'static str, f64); 6] {
        let Self { search, elements, entrance, sweep, commit, rest } = *self;
        [
            ("search", search),
            ("elements", elements),
            ("entrance", entrance),
            ("sweep", sweep),
            ("commit", commit),
            ("rest", rest),
        ]
    }
}

/// One window.
struct Window {
    /// Time (s) on the clock that counts.
    seconds: f64,
    wall: f64,
    /// Wall time of the stages (s).
    stages: Seconds,
}

/// Builds a model and times it for some `seconds`.
///
/// # Errors
/// A model that cannot be built or fails.
pub fn measure(model: &Model, seconds: f64, machine: &Machine) -> Result<Measured, BenchError> {
    forget_peak();
    let clock = Instant::now();
    let mut simulation = model.build()?;
    let build_seconds = clock.elapsed().as_secs_f64();
    model.warm(&mut simulation)?;
    let elements = simulation.slope().covers.element_count() as u64;
    let steps = (WINDOW_UPDATES / elements).clamp(WINDOW_STEPS[0], WINDOW_STEPS[1]);
    let start = simulation.state().clone();
    let mut windows = Vec::new();
    let clock = Instant::now();
    while windows.len() < WINDOWS_MIN || clock.elapsed().as_secs_f64() < seconds {
        simulation.restore(start.clone());
        windows.push(window(&mut simulation, steps)?);
    }
    let mut measured = Measured { model: model.to_string(), steps, build_seconds, ..sizes(&simulation) };
    measured.take_windows(windows, &simulation, &start.counters);
    measured.take_outputs(&simulation)?;
    measured.memory_peak = memory_peak();
    measured.memory_per_element = measured.memory_peak.map(|peak| peak as f64 / measured.elements as f64);
    measured.take_shares(machine);
    Ok(measured)
}

fn window(simulation: &mut Simulation, steps: u64) -> Result<Window, BenchError> {
    let stages = simulation.scratch().seconds;
    let processor = processor_seconds();
    let clock = Instant::now();
    advance(simulation, steps)?;
    let wall = clock.elapsed().as_secs_f64();
    let processor = processor_seconds().zip(processor).map(|(after, before)| after - before);
    let seconds = processor.filter(|_| counts_processor()).unwrap_or(wall);
    let now = simulation.scratch().seconds;
    let stages = Seconds {
        elements: now.elements - stages.elements,
        search: now.search - stages.search,
        entrance: now.entrance - stages.entrance,
        sweep: now.sweep - stages.sweep,
        commit: now.commit - stages.commit,
    };
    Ok(Window { seconds, wall, stages })
}

/// Whether processor time is the clock: with several threads it would count those that wait.
fn counts_processor() -> bool {
    rayon::current_num_threads() == 1 && processor_seconds().is_some()
}

fn sizes(simulation: &Simulation) -> Measured {
    let (slope, metric) = (simulation.slope(), &simulation.scratch().metric);
    let covers = &slope.covers;
    let free = (0..covers.block_count()).filter(|&block| !metric.fixed[block]);
    let (mut blocks, mut elements) = (0, 0);
    free.for_each(|block| (blocks, elements) = (blocks + 1, elements + covers.elements_of(block).len()));
    let moved = covers.cover_count() as f64 * COVER_BYTES / covers.element_count() as f64;
    Measured {
        clock: if counts_processor() { "processor" } else { "wall" },
        blocks,
        elements,
        held_elements: covers.element_count() - elements,
        covers: covers.cover_count(),
        boundary_edges: slope.boundary.len(),
        contacts: simulation.state().contacts.len(),
        dt: slope.dt,
        bytes_per_element: ELEMENT_BYTES + moved,
        operations_per_element: OPERATIONS_PER_ELEMENT,
        ..Measured::default()
    }
}

impl Measured {
    fn take_windows(&mut self, mut windows: Vec<Window>, simulation: &Simulation, before: &Counters) {
        windows.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let quickest = &windows[0];
        let steps = self.steps as f64;
        self.windows = windows.len();
        self.spread = windows[windows.len() / 2].seconds / quickest.seconds;
        self.ms_per_step = 1e3 * quickest.seconds / steps;
        self.wall_ms_per_step = 1e3 * windows.iter().map(|w| w.wall).fold(f64::INFINITY, f64::min) / steps;
        self.seconds_per_simulated_second = quickest.seconds / (steps * self.dt);
        // Stages share the time that the thread had as they share wall time.
        let scale = 1e3 / steps * quickest.seconds / quickest.wall;
        let Seconds { search, elements, entrance, sweep, commit } = quickest.stages;
        let claimed = search + elements + entrance + sweep + commit;
        let [search, elements, entrance, sweep, commit, rest] =
            [search, elements, entrance, sweep, commit, quickest.wall - claimed].map(|seconds| scale * seconds);
        self.stages = StageMilliseconds { search, elements, entrance, sweep, commit, rest };
        let after = simulation.state().counters;
        let per_second = |count: f64, ms: f64| count / (1e-3 * ms);
        let judged = (after.judged - before.judged) as f64 / steps;
        self.sweeps_mean = (after.sweeps - before.sweeps) as f64 / (after.substeps - before.substeps) as f64;
        self.contact_sweeps_per_second = (judged > 0.0).then(|| per_second(judged, sweep));
        self.elements_per_second = per_second(self.elements as f64, elements);
        self.step_elements_per_second = per_second(self.elements as f64, self.ms_per_step);
        self.searches = after.searches - before.searches;
        self.ms_per_search = (self.searches > 0).then(|| search * steps / self.searches as f64);
    }

    fn take_outputs(&mut self, simulation: &Simulation) -> Result<(), BenchError> {
        let clock = Instant::now();
        let snapshot = simulation.snapshot();
        let folder = std::env::temp_dir();
        let file = |kind: &str| folder.join(format!("enmm-bench-{}-{kind}.vtu", std::process::id()));
        let files = [file("elements"), file("joints")];
        let written = write_vtu(&snapshot, &files[0]).and_then(|()| write_joints_vtu(&snapshot, &files[1]));
        self.frame_ms = 1e3 * clock.elapsed().as_secs_f64();
        files.iter().for_each(|file| drop(std::fs::remove_file(file)));
        written?;
        let clock = Instant::now();
        self.state_bytes = encode(simulation.state(), "")?.len();
        self.checkpoint_ms = 1e3 * clock.elapsed().as_secs_f64();
        Ok(())
    }

    fn take_shares(&mut self, machine: &Machine) {
        let working_set = self.bytes_per_element * (self.elements + self.held_elements) as f64;
        let share =
            |per_element: f64, limit: Option<f64>| limit.map(|limit| per_element * self.elements_per_second / limit);
        self.share_of_bandwidth = share(self.bytes_per_element, machine.bandwidth_for(working_set));
        self.share_of_operations = share(self.operations_per_element, machine.multiply_add.map(|[one, _]| one));
    }
}
