//! The explicit method beside the implicit one: the same models, error against the exact answer, and cost.

mod models;
pub mod ratio;
mod report;

use std::time::Instant;

use crate::bench::Machine;
use enmm::geometry::Vector;
use enmm::model::case::Integrator;
use enmm::model::{Counters, Simulation};
use enmm_implicit::ImplicitBuffers;

use crate::{Plot, Setup, Trouble, Values};

pub use crate::slope::{Totals, slope_text};

/// When, by what and on what the times of a document were taken: `cargo xtask` passes commit and date.
fn origin() -> String {
    let label = std::env::var("ENMM_LABEL").unwrap_or_else(|_| "Commit and date not told".to_owned());
    let Machine { processor, cores, .. } = Machine::here(false);
    format!("{label}; {}, {cores} cores.\n", processor.as_deref().unwrap_or("a processor without a name"))
}

/// One run of one model by one method.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Model.
    pub model: &'static str,
    /// Variant.
    pub variant: String,
    /// Method.
    pub integrator: Integrator,
    /// Blocks, covers and contacts.
    pub counts: [usize; 3],
    /// Internal step (s).
    pub dt: f64,
    /// Relative error against the exact answer, or difference from the explicit method where there is none.
    pub error: f64,
    /// Wall time (s).
    pub wall: f64,
    /// Processor time of all threads (s).
    pub cpu: f64,
    /// Steps and sub-steps.
    pub steps: [u64; 2],
    /// Open–close sweeps, or solutions of the implicit iteration.
    pub iterations: u64,
    /// Factorisations.
    pub factorisations: u64,
    /// Bytes of matrix, factor and fields over covers.
    pub bytes: usize,
    /// Whether all stages that should come to rest did.
    pub at_rest: bool,
}

/// Time (s) for which slopes fail.
pub const FAILING: f64 = 1.0;

/// A slope that fails, by one method.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// Cost of the failure, without that of coming to rest.
    pub entry: Entry,
    /// Motion after [`FAILING`] seconds.
    pub totals: Totals,
}

/// All runs of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Pairs of runs over sizes: explicit, then implicit.
    pub entries: Vec<Entry>,
    /// Slopes that fail over sizes: explicit, then implicit.
    pub failures: Vec<Failure>,
    /// Sizes of the implicit step on one model, after the explicit run.
    pub sweep: Vec<Entry>,
    /// Plots of error and cost.
    pub plots: Vec<Plot>,
    /// Whether the sizes are those of a quick run.
    pub quick: bool,
}

/// Both methods on beams, blocks on inclines and fractured slopes of several sizes, in one run.
///
/// # Errors
/// A case that does not build, or a run that fails.
pub fn compare(quick: bool) -> Result<Comparison, Trouble> {
    let mut entries = Vec::new();
    let beams: &[f64] = if quick { &[2.0, 4.0, 8.0] } else { &[4.0, 8.0, 16.0] };
    for &rows in beams {
        entries.extend(pair(|integrator| models::beam(integrator, rows, None))?);
    }
    let inclines: &[f64] = if quick { &[0.6, 0.45, 0.3] } else { &[0.6, 0.3, 0.15] };
    for &size in inclines {
        entries.extend(pair(|integrator| models::incline(integrator, size, None))?);
    }
    let spacings: &[f64] = if quick { &[24.0, 16.0, 12.0] } else { &[12.0, 6.4, 3.2] };
    for &spacing in spacings {
        let mut places = Vec::new();
        entries.extend(pair(|integrator| models::slope(integrator, spacing, &mut places))?);
    }
    let mut failures = Vec::new();
    // A slope of 3.2 m takes the implicit method minutes for a second of failure.
    let failing: &[f64] = if quick { &[24.0, 16.0, 12.0] } else { &[24.0, 12.0, 6.4] };
    for &spacing in failing {
        let mut totals = None;
        failures.extend(pair(|integrator| models::failure(integrator, spacing, &mut totals))?);
    }
    let sweep = sweep(quick)?;
    let plots = report::plots(&entries, &failures, &sweep);
    Ok(Comparison { entries, failures, sweep, plots, quick })
}

fn pair<T>(mut run: impl FnMut(Integrator) -> Result<T, Trouble>) -> Result<[T; 2], Trouble> {
    Ok([run(Integrator::Explicit)?, run(Integrator::Implicit)?])
}

/// The sliding block with implicit steps of several sizes.
fn sweep(quick: bool) -> Result<Vec<Entry>, Trouble> {
    let size = if quick { 0.6 } else { 0.3 };
    let explicit = models::incline(Integrator::Explicit, size, None)?;
    let factors: &[f64] = if quick { &[5.0, 20.0, 80.0] } else { &[2.0, 5.0, 20.0, 50.0, 100.0, 200.0, 400.0] };
    let dt = explicit.dt;
    let mut entries = vec![explicit];
    for factor in factors {
        entries.push(models::incline(Integrator::Implicit, size, Some(factor * dt))?);
    }
    Ok(entries)
}

/// A model built by one method, and the clock of its run.
struct Run {
    simulation: Simulation,
    integrator: Integrator,
    wall: Instant,
    cpu: f64,
    /// Steps and counters before the clock was set.
    before: (u64, Counters),
}

impl Run {
    fn start(integrator: Integrator, text: String) -> Result<Self, Trouble> {
        let values = Values::none();
        let mut setup = Setup { values, integrator, quick: false, cases: Vec::new() };
        let simulation = setup.simulation("comparison", text)?;
        let before = (0, Counters::default());
        Ok(Self { simulation, integrator, wall: Instant::now(), cpu: cpu_seconds(), before })
    }

    /// Sets clock and counts to zero.
    fn restart(&mut self) {
        (self.wall, self.cpu) = (Instant::now(), cpu_seconds());
        self.before = (self.simulation.state().step, self.simulation.state().counters);
    }

    fn entry(&self, model: &'static str, variant: String, error: f64, at_rest: bool) -> Entry {
        let (simulation, counters) = (&self.simulation, &self.simulation.state().counters);
        let (steps, before) = (simulation.state().step - self.before.0, &self.before.1);
        let covers = &simulation.model().covers;
        Entry {
            model,
            variant,
            integrator: self.integrator,
            counts: [covers.block_count(), covers.cover_count(), simulation.state().contacts.len()],
            dt: simulation.model().dt,
            error,
            wall: self.wall.elapsed().as_secs_f64(),
            cpu: cpu_seconds() - self.cpu,
            steps: [steps, counters.substeps - before.substeps],
            iterations: counters.sweeps - before.sweeps,
            factorisations: counters.factorisations - before.factorisations,
            bytes: bytes(simulation),
            at_rest,
        }
    }
}

/// Bytes of matrix and factor, of the fields over covers and of the contacts.
fn bytes(simulation: &Simulation) -> usize {
    let workspace = simulation.workspace();
    let (motion, sweep) = (&workspace.motion, &workspace.sweep);
    let vectors = [&workspace.load_force, &motion.predicted, &motion.damped, &sweep.increment];
    let fields = vectors.map(|v| v.len()).iter().sum::<usize>() + 2 * simulation.state().displacement.len();
    let contacts = workspace.contacts.len() * size_of::<enmm::model::tables::VertexEdge>();
    fields * size_of::<Vector>() + contacts + enmm_implicit::buffers(workspace).map_or(0, of_implicit)
}

/// Bytes of matrix, factor and fields of the implicit integrator.
fn of_implicit(buffers: &ImplicitBuffers) -> usize {
    let [matrix, factor] = buffers.matrix.bytes();
    let fields = [&buffers.moved, &buffers.offset, &buffers.applied].map(|v| v.len()).iter().sum::<usize>();
    let places = buffers.slots.contacts.len() * 144 + buffers.slots.elements.len() * 24;
    matrix + factor + fields * size_of::<Vector>() + places
}

/// Processor time (s) of all threads of this process so far; 0 where the system does not report it.
fn cpu_seconds() -> f64 {
    // The system brings its count up to date when a thread gives way.
    std::thread::yield_now();
    let Ok(tasks) = std::fs::read_dir("/proc/self/task") else { return 0.0 };
    let of = |task: std::fs::DirEntry| -> Option<f64> {
        let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        Some(text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
    };
    tasks.flatten().filter_map(of).sum()
}
