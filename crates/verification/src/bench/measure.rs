//! One model timed: windows of steps that start from the same state again and again, so that each step has its
//! quickest time, which other programs on the machine hardly touch.

use std::io;
use std::time::Instant;

use serde::Serialize;

use super::clock::{PROCESSOR_TICK, forget_peak, memory_peak, processor_seconds};
use super::models::{Model, advance};
use super::{BenchError, BenchOptions, Machine, survey};
use enmm::model::bytes::{Keeper, encode};
use enmm::model::tables::Seconds;
use enmm::model::{Counters, Simulation};
use enmm_observe::{Joints, Snapshot};
use enmm_run::vtu::{write_joints_vtu, write_vtu};

/// Element updates in a window; small models take more steps, and large ones the fewest.
const WINDOW_UPDATES: u64 = 1_000_000;
/// Fewest and most steps of a window.
const WINDOW_STEPS: [u64; 2] = [20, 200];
/// Parts of state and buffers that grow with contacts.
const OF_CONTACTS: [&str; 4] = ["near pairs", "search", "accepted pairs", "contacts"];
/// Fewest windows.
const WINDOWS_MIN: usize = 2;
/// Floating-point operations of one element: gradient 22, rotation 8, stretch 4, stress 12, forces 22, their sum 6.
const OPERATIONS_PER_ELEMENT: f64 = 74.0;
/// Bytes of an element that its stage must read: the slots of three covers in its chunk, and its cut area.
const ELEMENT_BYTES: f64 = 3.0 * 2.0 + 8.0;
/// Bytes of a cover that the stage of the elements must move: position, displacement, velocity and two masses read,
/// predicted velocity fetched and written.
const COVER_BYTES: f64 = 3.0 * 16.0 + 2.0 * 8.0 + 2.0 * 16.0;

/// Costs of a model.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Measured {
    /// Name of the model.
    pub model: String,
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
    /// Milliseconds per step: the mean over the steps of a window, each the quickest of all windows; never more than
    /// the processor time of the quickest window, where one thread does all.
    pub ms_per_step: f64,
    /// Milliseconds of wall time per step in the median window.
    pub wall_ms_per_step: f64,
    /// Seconds per simulated second, as in the windows.
    pub seconds_per_simulated_second: f64,
    /// Seconds for the first simulated second of a sliding slope, from the model as built; null when it was not run.
    pub first_second: Option<f64>,
    /// Milliseconds per step of each stage, taken like those of the step.
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
    pub checkpoint_bytes: usize,
    /// Time to build the model (s).
    pub build_seconds: f64,
    /// Most memory (bytes) that the program held from the build of the model to the last step; null where the system
    /// does not tell.
    pub memory_peak: Option<u64>,
    /// Bytes of what is fixed, of what changes in time, and of buffers.
    pub heap_bytes: [usize; 3],
    /// Bytes of the state and buffers that hold near pairs and contacts, per contact; null without contact.
    pub bytes_per_contact: Option<f64>,
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
    /// Time outside all stages.
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

/// Seconds of a step: search, elements, entrance, sweep, commit, and all of it.
type StepSeconds = [f64; 6];

/// Sums over all windows.
struct Windows {
    /// Each step at its quickest, stage by stage.
    quickest: Vec<StepSeconds>,
    /// Wall time of each window (s).
    wall: Vec<f64>,
    /// Processor time of the quickest window (s); infinite where it does not count.
    processor: f64,
}

impl Windows {
    fn new(steps: u64) -> Self {
        let quickest = vec![[f64::INFINITY; 6]; steps as usize];
        Self { quickest, wall: Vec::new(), processor: f64::INFINITY }
    }

    /// Times one more window.
    fn take(&mut self, simulation: &mut Simulation) -> Result<(), BenchError> {
        let processor = processor_seconds();
        let clock = Instant::now();
        let mut before = (stage_seconds(simulation), 0.0);
        for quickest in &mut self.quickest {
            simulation.advance(false)?;
            let now = (stage_seconds(simulation), clock.elapsed().as_secs_f64());
            let [search, elements, entrance, sweep, commit] = [0, 1, 2, 3, 4].map(|k| now.0[k] - before.0[k]);
            let step = [search, elements, entrance, sweep, commit, now.1 - before.1];
            quickest.iter_mut().zip(step).for_each(|(quickest, seconds)| *quickest = quickest.min(seconds));
            before = now;
        }
        self.wall.push(before.1);
        let spent = processor_seconds().zip(processor).map(|(after, before)| after - before);
        if let Some(spent) = spent.filter(|&spent| spent > 0.0 && rayon::current_num_threads() == 1) {
            self.processor = self.processor.min(spent + PROCESSOR_TICK);
        }
        Ok(())
    }

    /// Seconds per step by stage and of all; the stages share what processor time takes off.
    fn per_step(&self) -> StepSeconds {
        let sum = |k: usize| self.quickest.iter().map(|step| step[k]).sum::<f64>();
        let sums = [0, 1, 2, 3, 4, 5].map(sum);
        let scale = (self.processor / sums[5]).min(1.0) / self.quickest.len() as f64;
        sums.map(|seconds| seconds * scale)
    }
}

fn stage_seconds(simulation: &Simulation) -> [f64; 5] {
    let Seconds { search, elements, entrance, sweep, commit } = simulation.workspace().seconds;
    [search, elements, entrance, sweep, commit]
}

/// Builds a model and times it.
///
/// # Errors
/// A model that cannot be built or fails.
pub fn measure(model: &Model, options: &BenchOptions, machine: &Machine) -> Result<Measured, BenchError> {
    forget_peak();
    let clock = Instant::now();
    let mut simulation = model.build()?;
    let build_seconds = clock.elapsed().as_secs_f64();
    model.warm(&mut simulation)?;
    let elements = simulation.model().covers.element_count() as u64;
    let steps = (WINDOW_UPDATES / elements).clamp(WINDOW_STEPS[0], WINDOW_STEPS[1]);
    let start = simulation.state().clone();
    let mut windows = Windows::new(steps);
    let clock = Instant::now();
    while windows.wall.len() < WINDOWS_MIN || clock.elapsed().as_secs_f64() < options.seconds {
        simulation.restore(start.clone());
        windows.take(&mut simulation)?;
    }
    let mut measured = Measured { model: model.to_string(), steps, build_seconds, ..sizes(&simulation) };
    measured.memory_peak = memory_peak();
    measured.take_heaps(&simulation);
    measured.take_windows(&windows, &simulation, &start.counters);
    measured.take_outputs(&simulation)?;
    measured.take_shares(machine);
    if options.first_second && survey::slope_seconds(model).is_some() {
        measured.first_second = Some(first_second(model)?);
    }
    Ok(measured)
}

/// Wall time (s) of the first simulated second of a model as built.
fn first_second(model: &Model) -> Result<f64, BenchError> {
    let mut simulation = model.build()?;
    let steps = simulation.steps_in(1.0);
    let clock = Instant::now();
    advance(&mut simulation, steps)?;
    Ok(clock.elapsed().as_secs_f64())
}

/// Counts of a model, and what its elements move.
pub fn sizes(simulation: &Simulation) -> Measured {
    let (slope, mass_matrix) = (simulation.model(), &simulation.workspace().mass_matrix);
    let covers = &slope.covers;
    let free = covers.blocks().filter(|&block| !mass_matrix.fixed[block]);
    let (mut blocks, mut elements) = (0, 0);
    free.for_each(|block| (blocks, elements) = (blocks + 1, elements + covers.elements_of(block).len()));
    let moved = covers.cover_count() as f64 * COVER_BYTES / covers.element_count() as f64;
    Measured {
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
    fn take_windows(&mut self, windows: &Windows, simulation: &Simulation, before: &Counters) {
        let steps = self.steps as f64;
        let mut wall = windows.wall.clone();
        wall.sort_by(f64::total_cmp);
        self.windows = wall.len();
        self.wall_ms_per_step = 1e3 * wall[wall.len() / 2] / steps;
        let [search, elements, entrance, sweep, commit, all] = windows.per_step().map(|seconds| 1e3 * seconds);
        let rest = all - (search + elements + entrance + sweep + commit);
        self.ms_per_step = all;
        self.seconds_per_simulated_second = 1e-3 * all / self.dt;
        self.stages = StageMilliseconds { search, elements, entrance, sweep, commit, rest };
        let after = simulation.state().counters;
        let per_second = |count: f64, ms: f64| count / (1e-3 * ms);
        let judged = (after.contacts_solved - before.contacts_solved) as f64 / steps;
        self.sweeps_mean = (after.sweeps - before.sweeps) as f64 / (after.substeps - before.substeps) as f64;
        self.contact_sweeps_per_second = (judged > 0.0).then(|| per_second(judged, sweep));
        self.elements_per_second = per_second(self.elements as f64, elements);
        self.step_elements_per_second = per_second(self.elements as f64, self.ms_per_step);
        self.searches = after.searches - before.searches;
        self.ms_per_search = (self.searches > 0).then(|| search * steps / self.searches as f64);
    }

    fn take_heaps(&mut self, simulation: &Simulation) {
        let (slope, state, workspace) = (simulation.model(), simulation.state(), simulation.workspace());
        self.heap_bytes = [slope.bytes(), state.bytes(), workspace.bytes()];
        let parts = state.memory().into_iter().chain(workspace.memory());
        let of_contacts: usize = parts.filter(|part| OF_CONTACTS.contains(&part.0)).map(|part| part.1).sum();
        self.bytes_per_contact = (self.contacts > 0).then(|| of_contacts as f64 / self.contacts as f64);
    }

    fn take_outputs(&mut self, simulation: &Simulation) -> Result<(), BenchError> {
        let clock = Instant::now();
        let snapshot = Snapshot::of(simulation);
        let folder = tempfile::tempdir()?;
        let files = ["elements.vtu", "joints.vtu"].map(|name| folder.path().join(name));
        let joints = Joints::of(simulation).now(simulation);
        let (laws, time) = (&snapshot.joint_laws, snapshot.time);
        let written = write_vtu(&snapshot, &files[0]).and_then(|()| write_joints_vtu(&joints, laws, time, &files[1]));
        self.frame_ms = 1e3 * clock.elapsed().as_secs_f64();
        written?;
        let clock = Instant::now();
        self.checkpoint_bytes = encode(Keeper::Model, simulation.state(), "").map_err(io::Error::other)?.len();
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
