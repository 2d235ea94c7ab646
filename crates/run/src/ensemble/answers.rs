//! Outputs of samples: from the store where they are there, else from workers, and then into the store at once.

use std::sync::atomic::Ordering;
use std::time::Instant;

use enmm::engine_version;
use enmm_ensemble::{Given, Identity, Row, Store, Value, sample_key, work};
use enmm_io::LoadedCase;

use super::{Answer, EnsembleError, EnsembleOptions, SampleOutput, SearchOptions, columns};

/// How a search ends whose slope stands at no factor that was tried.
const NEVER_STABLE: &str = "unstable_throughout";

/// Order to a worker.
#[derive(Debug)]
pub struct Ask {
    /// Number of the sample.
    pub sample: usize,
    /// Its values, as settings of the case.
    pub settings: Vec<String>,
    /// Output to work out of it.
    pub output: SampleOutput,
    /// Options of the search.
    pub search: SearchOptions,
}

/// How far the work on an output has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnsembleProgress {
    /// The output.
    pub output: SampleOutput,
    /// When the work began.
    pub begun: Instant,
    /// Samples that the store had then.
    pub stored: usize,
    /// Samples of which it is there.
    pub done: usize,
    /// Samples of which it is wanted.
    pub wanted: usize,
    /// Of all samples of the ensemble that are decided: how many have a factor, and how many of them are below the
    /// limit.
    pub answered: usize,
    /// See `answered`.
    pub below: usize,
    /// The sample that took longest so far, and how long (s).
    pub slowest: Option<(usize, f64)>,
}

/// The values of a sample with their keys.
pub type Values = Vec<(String, Value)>;

type Worker<'a> = &'a (dyn Fn(&Ask) -> Result<Answer, String> + Sync);

/// The store of an ensemble and its workers.
pub struct Answers<'a> {
    loaded: &'a LoadedCase,
    options: &'a EnsembleOptions<'a>,
    values: Vec<Values>,
    store: Store,
    ask: Worker<'a>,
    hear: &'a mut dyn FnMut(&EnsembleProgress),
    /// Samples that are decided so far, over all calls.
    tally: Tally,
    /// Number of samples of earlier calls, where each call works out a batch of one output; none where a call is a part
    /// of the work by itself.
    pub earlier: Option<usize>,
}

/// Samples that are decided: how many have a factor, and how many of them are below the limit.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Tally {
    answered: usize,
    below: usize,
}

impl Tally {
    fn count(&mut self, fails: Option<bool>) {
        self.answered += usize::from(fails.is_some());
        self.below += usize::from(fails == Some(true));
    }
}

impl<'a> Answers<'a> {
    /// Opens the store of the samples of a case, of which each has its own values.
    ///
    /// # Errors
    /// The store cannot be made or opened.
    pub fn open(
        loaded: &'a LoadedCase,
        options: &'a EnsembleOptions<'a>,
        values: Vec<Values>,
        ask: Worker<'a>,
        hear: &'a mut dyn FnMut(&EnsembleProgress),
    ) -> Result<Self, EnsembleError> {
        if let Some(parent) = options.store.parent().filter(|parent| !parent.as_os_str().is_empty()) {
            std::fs::create_dir_all(parent).map_err(EnsembleError::Output)?;
        }
        let store = Store::open(&options.store)?;
        Ok(Self { loaded, options, values, store, ask, hear, tally: Tally::default(), earlier: None })
    }

    /// Number of samples.
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// One output of some samples, in their order, which decides whether they fail.
    ///
    /// # Errors
    /// See [`EnsembleError`]; what is done stays in the store.
    pub fn find(
        &mut self,
        samples: &[usize],
        output: impl Into<SampleOutput>,
        search: &SearchOptions,
    ) -> Result<Vec<Row>, EnsembleError> {
        self.work_out(samples, output.into(), search, true)
    }

    /// One output of some samples, in their order, which leaves open whether they fail.
    ///
    /// # Errors
    /// As [`Self::find`].
    pub fn look(
        &mut self,
        samples: &[usize],
        output: impl Into<SampleOutput>,
        search: &SearchOptions,
    ) -> Result<Vec<Row>, EnsembleError> {
        self.work_out(samples, output.into(), search, false)
    }

    /// Counts a sample that has been decided without work on it.
    pub fn decided(&mut self, fails: bool) {
        self.tally.count(Some(fails));
    }

    fn work_out(
        &mut self,
        samples: &[usize],
        output: SampleOutput,
        search: &SearchOptions,
        decides: bool,
    ) -> Result<Vec<Row>, EnsembleError> {
        let keys = self.sample_keys(samples, output, search);
        let names = columns(output);
        let mut found = keys.iter().map(|key| self.store.find(key, names)).collect::<Result<Vec<_>, _>>()?;
        let again = |row: &Row| self.options.retry_failed && !row.is_done();
        let wanted: Vec<usize> = (0..samples.len()).filter(|&i| found[i].as_ref().is_none_or(again)).collect();
        let mut tally = self.tally;
        let mut progress = self.begin(output, &found, decides.then_some(&mut tally));
        (self.hear)(&progress);
        let timed = |i: usize| {
            let clock = Instant::now();
            let k = samples[i];
            let settings = self.values[k].iter().map(|(key, value)| format!("{key}={value}")).collect();
            let ask = Ask { sample: k, settings, output, search: *search };
            (self.ask)(&ask).map(|answer| (answer, clock.elapsed().as_secs_f64()))
        };
        let (store, hear, limit) = (&self.store, &mut self.hear, self.loaded.case.ensemble.limit);
        let lost = work(&wanted, self.options.jobs, self.options.interrupt, timed, |i, (answer, seconds)| {
            let Answer::Done(row) = answer else { return Err(EnsembleError::Changed) };
            let k = samples[i];
            store.add(&keys[i], k, &self.values[k], &row, (seconds, engine_version()))?;
            progress.note(&row, decides.then_some((&mut tally, limit)), Some((k, seconds)));
            found[i] = Some(row);
            hear(&progress);
            Ok(())
        })?;
        self.tally = tally;
        let EnsembleProgress { done, wanted: n, .. } = progress;
        if self.options.interrupt.load(Ordering::Relaxed) && done < n {
            return Err(EnsembleError::Interrupted { done, n });
        }
        if lost.count > 0 {
            return Err(EnsembleError::Lost { count: lost.count, message: lost.message });
        }
        Ok(found.into_iter().flatten().collect())
    }

    /// Keys of samples in the store.
    fn sample_keys(&self, samples: &[usize], output: SampleOutput, search: &SearchOptions) -> Vec<String> {
        let identity = Identity {
            case: self.loaded.hash.clone(),
            version: engine_version().to_owned(),
            output: output.name().to_owned(),
            options: search.given().into_iter().map(|(name, value)| (name, Given::Number(value))).collect(),
        };
        samples.iter().map(|&k| sample_key(&identity, &self.values[k])).collect()
    }

    /// Counts what the store has; rows that are to be worked out again do not count.
    fn begin(&self, output: SampleOutput, found: &[Option<Row>], mut decides: Option<&mut Tally>) -> EnsembleProgress {
        let limit = self.loaded.case.ensemble.limit;
        let Tally { answered, below } = self.tally;
        let (done, wanted) = self.earlier.map_or((0, found.len()), |earlier| (earlier, self.values.len()));
        let begun = Instant::now();
        let mut progress = EnsembleProgress { output, begun, stored: 0, done, wanted, answered, below, slowest: None };
        let kept = found.iter().flatten().filter(|row| row.is_done() || !self.options.retry_failed);
        for row in kept {
            progress.note(row, decides.as_deref_mut().map(|tally| (tally, limit)), None);
        }
        EnsembleProgress { stored: progress.done, ..progress }
    }
}

impl EnsembleProgress {
    /// A sample is done, and counts in a tally where it is decided.
    fn note(&mut self, row: &Row, decides: Option<(&mut Tally, f64)>, took: Option<(usize, f64)>) {
        self.done += 1;
        if let Some((tally, limit)) = decides.filter(|_| self.output != SampleOutput::Displacement) {
            // A search that found no factor at which the slope stands has the least that it tried, which may be the
            // limit itself.
            let fails = |factor: f64| factor < limit || factor <= limit && row.text("status") == NEVER_STABLE;
            tally.count(row.number(columns(self.output)[0]).map(fails));
            (self.answered, self.below) = (tally.answered, tally.below);
        }
        let slower =
            |(k, seconds): (usize, f64)| self.slowest.is_none_or(|(_, most)| seconds > most).then_some((k, seconds));
        self.slowest = took.and_then(slower).or(self.slowest);
    }
}
