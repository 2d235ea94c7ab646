//! An ensemble from case to results: `ensemble.csv`, `ensemble.json` and `ensemble.png`.
//!
//! Each answer goes to the store as soon as it is there; the results are written when all are.

mod answer;
mod answers;
mod record;
mod screen;

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use enmm::model::case::{Ensemble, EnsembleOutput};
use enmm_ensemble::{Row, StoreError, draw, wilson};
use enmm_io::{CaseError, LoadedCase};
use enmm_stability::strength_reduction::MechanismOptions;

use crate::fos::FosOptions;
use enmm_record::{Folder, STORE, check_output, is_result};

pub(crate) use answers::{Answers, Values};

pub(crate) use answer::{FAILS, NO_VERDICT};
pub use answer::{SampleOutput, answer, columns};
pub use answers::{Ask, EnsembleProgress};
pub use record::EnsembleResult;
pub(crate) use record::{Answered, head, output_name, write_record, write_table};

/// Samples after each of which the width of the interval is looked at.
const BATCH: usize = 50;
/// Confidence of the intervals.
const CONFIDENCE: f64 = 0.95;

/// Options of the search for each factor of safety; those that are none are the defaults of [`super::FosOptions`].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SearchOptions {
    /// Least F that trials reach.
    pub low: Option<f64>,
    /// Greatest F that trials reach.
    pub high: Option<f64>,
    /// Width of the final bracket relative to F.
    pub tolerance: Option<f64>,
    /// Area (m²) of failing blocks below which a mechanism does not count.
    pub least_area: Option<f64>,
}

impl SearchOptions {
    /// As options of one search, on one thread.
    pub fn fos(&self) -> FosOptions<'static> {
        let whole = FosOptions::into_directory(PathBuf::new());
        FosOptions {
            low: self.low,
            high: self.high,
            tolerance: self.tolerance.unwrap_or(whole.tolerance),
            mechanisms: MechanismOptions { least_area: self.least_area, count: 1 },
            threads: Some(1),
            ..whole
        }
    }

    /// The options that are given, by name.
    pub fn given(&self) -> BTreeMap<String, f64> {
        let all =
            [("low", self.low), ("high", self.high), ("tolerance", self.tolerance), ("least_area", self.least_area)];
        all.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))).collect()
    }
}

/// How to work out an ensemble, and where its results go.
#[derive(Debug)]
pub struct EnsembleOptions<'a> {
    /// Where results go.
    pub directory: PathBuf,
    /// File of the store.
    pub store: PathBuf,
    /// Samples at a time.
    pub jobs: usize,
    /// Options of each search.
    pub search: SearchOptions,
    /// Work out again the samples that have no answer.
    pub retry_failed: bool,
    /// Set by another thread to end with the samples that are under way.
    pub interrupt: &'a AtomicBool,
}

/// Why there is no result.
#[derive(Debug, thiserror::Error)]
pub enum EnsembleError {
    /// The case, its random values or their correlations cannot be used.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The store cannot be read or written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// No sample has an answer.
    #[error("none of {n} samples has an answer; the first: {message}")]
    NoAnswer {
        /// Number of samples.
        n: usize,
        /// Why the first has none.
        message: String,
    },
    /// Workers were lost again and again.
    #[error(
        "{count} samples were not done, because their workers were lost ({message}); what is done is stored: run \
             the same command again to continue"
    )]
    Lost {
        /// Number of samples that are not done.
        count: usize,
        /// Why the first is not.
        message: String,
    },
    /// The case or a file that it names changed during the work.
    #[error(
        "the case changed while its samples were worked out; what is done is stored for the case as it was: run \
             the same command again"
    )]
    Changed,
    /// The caller stopped it.
    #[error("interrupted with {done} of {n} samples done, which are stored: run the same command again to continue")]
    Interrupted {
        /// Samples done.
        done: usize,
        /// Number of samples.
        n: usize,
    },
    /// The directory or the store cannot take results.
    #[error("cannot write results ({0}): choose another directory with -o, or another file with --store")]
    Directory(io::Error),
    /// A result cannot be written.
    #[error("cannot write results ({0}): choose another directory with -o")]
    Output(io::Error),
}

/// Result of a worker.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// The sample is done.
    Done(Row),
    /// The case is not the one of the ensemble any more.
    Changed,
}

/// Works out the samples of a case that are not in the store yet, and writes the results of all.
///
/// `ask` computes one output of a sample, and fails when the worker was lost. `hear` is called as samples are done.
///
/// # Errors
/// See [`EnsembleError`]; what is done stays in the store.
pub fn ensemble(
    loaded: &LoadedCase,
    options: &EnsembleOptions,
    ask: impl Fn(&Ask) -> Result<Answer, String> + Sync,
    hear: &mut dyn FnMut(&EnsembleProgress),
) -> Result<EnsembleResult, EnsembleError> {
    let clock = Instant::now();
    let _held = hold(loaded, options)?;
    let located = |invalid: enmm::model::case::Invalid| loaded.source.locate(&invalid.key, &invalid.message);
    let mut samples = draw(&loaded.case).map_err(located)?;
    let values = (0..samples.rows.len()).map(|k| samples.values(k)).collect();
    let mut answers = Answers::open(loaded, options, values, &ask, hear)?;
    let rows = rows(&loaded.case.ensemble, options, &mut answers)?;
    drop(answers);
    samples.rows.truncate(rows.len());
    let result = EnsembleResult::of(loaded, samples, rows)?;
    result.write(loaded, options, clock.elapsed().as_secs_f64()).map_err(EnsembleError::Output)?;
    Ok(result)
}

/// The folder of the results, when it and the place of the store can take them.
pub(crate) fn hold(loaded: &LoadedCase, options: &EnsembleOptions) -> Result<Folder, EnsembleError> {
    let inputs = loaded.source.inputs();
    let held = Folder::open(&options.directory, inputs);
    held.and_then(|held| check_store(options, inputs).map(|()| held)).map_err(EnsembleError::Directory)
}

/// The rows of all samples, or of as many as the interval asks for.
fn rows(of: &Ensemble, options: &EnsembleOptions, answers: &mut Answers) -> Result<Vec<Row>, EnsembleError> {
    let n = answers.count();
    let batch = if of.interval.is_some() { BATCH } else { n.max(1) };
    let mut rows: Vec<Row> = Vec::with_capacity(n);
    let mut margin = None;
    while rows.len() < n {
        let next = rows.len()..n.min(rows.len() + batch);
        answers.earlier = (of.output != EnsembleOutput::Failure).then_some(rows.len());
        rows.extend(match of.output {
            EnsembleOutput::Failure => screen::rows(next, of.limit, &options.search, answers, &mut margin)?,
            output => answers.find(&next.collect::<Vec<_>>(), output, &options.search)?,
        });
        if of.interval.is_some_and(|width| is_narrow(&rows, of, width)) {
            break;
        }
    }
    Ok(rows)
}

/// Whether the interval of the probability of failure is no wider than `width`.
fn is_narrow(rows: &[Row], of: &Ensemble, width: f64) -> bool {
    let outputs = rows.iter().filter_map(|row| row.number(columns(of.output)[0]));
    let (failing, all) =
        outputs.fold((0, 0), |(failing, all), output| (failing + usize::from(output < of.limit), all + 1));
    let interval = wilson(failing, all, CONFIDENCE);
    all > 0 && interval.high - interval.low <= width
}

/// Looks at the places of the store and of the files that SQLite keeps beside it while it is open.
fn check_store(options: &EnsembleOptions, inputs: &[PathBuf]) -> io::Result<()> {
    let name = options.store.file_name().unwrap_or_default().to_os_string();
    let folder = options.store.parent().unwrap_or(Path::new(""));
    let is_here = folder.canonicalize().ok() == options.directory.canonicalize().ok();
    if is_here && is_result(Path::new(&name)) && name != STORE {
        let message = format!("{}: another result has this name", options.store.display());
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    ["", "-wal", "-shm", "-journal"].iter().try_for_each(|end| {
        let mut name = name.clone();
        name.push(end);
        check_output(&folder.join(name), inputs)
    })
}
