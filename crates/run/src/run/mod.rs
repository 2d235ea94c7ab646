//! A run from case to results: all stages, histories, frames, checkpoints, pictures and the summary.
//!
//! Everything that can fail as input fails before anything is written. Prints nothing: an [`Observer`] hears.

mod concurrency;
mod driver;
mod load_at_once;
mod outlook;

use std::io;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use enmm::model::BuildStage;
use enmm_io::CaseError;
use enmm_io::LoadedCase;
use enmm_io::checkpoint::CheckpointError;
use enmm_record::Summary;

/// How to run a case.
#[derive(Debug, Default)]
pub struct RunOptions<'a> {
    /// Where results go.
    pub directory: PathBuf,
    /// Checkpoint to continue from.
    pub resume: Option<PathBuf>,
    /// Threads; when none is given, as many as make steps shorter. The results do not depend on it.
    pub threads: Option<usize>,
    /// Set by another thread to end the run with a checkpoint.
    pub interrupt: Option<&'a AtomicBool>,
}

/// Where a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunProgress<'a> {
    /// Name of the stage.
    pub stage: &'a str,
    /// Its number, from 1.
    pub stage_number: usize,
    /// Number of stages.
    pub stage_count: usize,
    /// Simulated time (s).
    pub time: f64,
    /// Simulated time left at most (s).
    pub time_left: f64,
    /// Simulated time that is expected to be left (s); none while nothing is known of a static stage.
    pub time_expected: Option<f64>,
    /// Unbalanced ratio at the last report of a static stage, and the one at which the stage ends.
    pub unbalanced: Option<[f64; 2]>,
    /// Steps done.
    pub step: u64,
}

/// Hears how a run goes.
pub trait Observer: Send {
    /// Called when a part of the build begins.
    fn build(&mut self, _stage: BuildStage) {}

    /// Called before every step.
    fn step(&mut self, _progress: &RunProgress) {}

    /// Called with what the build has changed in the drawing.
    fn note(&mut self, _message: &str) {}

    /// Called with what the user should know.
    fn warn(&mut self, _message: &str) {}
}

/// Hears nothing.
impl Observer for () {}

/// Why a run did not begin, or could not write.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The case cannot be built.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The checkpoint cannot be used.
    #[error("{}: {error}", path.display())]
    Checkpoint {
        /// The checkpoint.
        path: PathBuf,
        /// The fault.
        error: CheckpointError,
    },
    /// The threads cannot be started.
    #[error("cannot start {0} threads: ask for fewer")]
    Threads(usize),
    /// The directory cannot take results.
    #[error("cannot write results ({0}): choose another directory with -o")]
    Directory(io::Error),
    /// A result cannot be written.
    #[error("cannot write results ({0}): see that the folder is there and has room, and run the case again")]
    Output(io::Error),
    /// A result cannot be written, but a checkpoint has been.
    #[error(
        "cannot write results ({error}): see that the folder is there and has room, and continue with --resume {}",
        checkpoint.display()
    )]
    OutputAfter {
        /// The refusal of the file system.
        error: io::Error,
        /// The last checkpoint.
        checkpoint: PathBuf,
    },
}

/// Runs all stages of a case and writes its results.
///
/// # Errors
/// When something cannot be read, built or written. A numerical failure is not an error but a status of the summary.
pub fn run(loaded: &LoadedCase, options: &RunOptions, observer: &mut dyn Observer) -> Result<Summary, RunError> {
    let Some(threads) = options.threads else { return driver::run(loaded, options, observer) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|_| RunError::Threads(threads))?.install(|| driver::run(loaded, options, observer))
}
