//! Costs of standard models: continua without contact, an example that rests and fails, slopes of any size that slide.

mod clock;
mod machine;
mod measure;
mod models;
mod report;
mod slope;
mod survey;

use serde::Serialize;

pub use clock::timed;
pub use machine::{Bandwidth, Machine};
pub use measure::{Measured, StageMilliseconds, measure, sizes};
pub use models::{LARGE, Model, STANDARD, advance};
pub use report::{Origin, REPORT_FILES, digits, markdown, none, push_machine, push_table, write_report};
pub use slope::{continuum_case, slope_case};

use enmm::engine_version;
use enmm::model::StepError;
use enmm::model::case::Invalid;
use enmm_io::CaseError;

/// Why a benchmark did not run.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// The model cannot be read.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The model cannot be built.
    #[error("{}: {}", .0.key, .0.message)]
    Build(Invalid),
    /// The model failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A frame cannot be written.
    #[error("cannot time an output: {0}")]
    Output(#[from] std::io::Error),
    /// The threads cannot be started.
    #[error("cannot start {0} threads: ask for fewer")]
    Threads(usize),
}

/// Options of a benchmark.
#[derive(Debug, Clone)]
pub struct BenchOptions {
    /// Models.
    pub models: Vec<Model>,
    /// Wall time (s) for the steps of each model.
    pub seconds: f64,
    /// Threads; none for all.
    pub threads: Option<usize>,
    /// Whether the limits of the machine are measured as well.
    pub limits: bool,
    /// Whether slopes that stand beside other programs run through their first second as well, which takes minutes.
    pub first_second: bool,
}

/// Results of a benchmark, and its machine.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct BenchReport {
    /// Version of the engine.
    pub version: String,
    /// Threads that the models could use.
    pub threads: usize,
    /// The machine.
    pub machine: Machine,
    /// The models.
    pub models: Vec<Measured>,
}

/// Times models one after the other; `begin` hears the name of each before it is built.
///
/// # Errors
/// A model that cannot be built or fails, which for a standard one is a defect.
pub fn bench(options: &BenchOptions, begin: &mut (dyn FnMut(&str) + Send)) -> Result<BenchReport, BenchError> {
    // Zero stands for all threads.
    in_pool(options.threads.unwrap_or(0), || bench_here(options, begin))?
}

/// Works in a pool of its own with so many threads, so that one thread does all that it counts as its time.
///
/// # Errors
/// Threads that the system refuses.
pub fn in_pool<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> Result<R, BenchError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|_| BenchError::Threads(threads))?.install(work))
}

fn bench_here(options: &BenchOptions, begin: &mut dyn FnMut(&str)) -> Result<BenchReport, BenchError> {
    if options.limits {
        begin("limits of the machine");
    }
    let machine = Machine::here(options.limits);
    let mut models = Vec::new();
    for model in &options.models {
        begin(&model.to_string());
        models.push(measure(model, options, &machine)?);
    }
    Ok(BenchReport { version: engine_version().to_owned(), threads: rayon::current_num_threads(), machine, models })
}
