//! Outputs of samples: from the store where they are there, else from workers, and then into the store at once.

use std::sync::atomic::Ordering;
use std::time::Instant;

use enmm::engine_version;
use enmm_ensemble::{Given, Identity, Row, Store, Value, sample_key, work};
use enmm_io::LoadedCase;

use super::{Answer, EnsembleError, EnsembleOptions, SampleOutput, SearchOptions, columns};

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
    /// Of those that are done: how many have a factor, and how many of them are below the limit.
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
        Ok(Self { loaded, options, values, store, ask, hear })
    }

    /// Number of samples.
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// One output of some samples, in their order.
    ///
    /// # Errors
    /// See [`EnsembleError`]; what is done stays in the store.
    pub fn find(
        &mut self,
        samples: &[usize],
        output: impl Into<SampleOutput>,
        search: &SearchOptions,
    ) -> Result<Vec<Row>, EnsembleError> {
        let output = output.into();
        let keys = self.sample_keys(samples, output, search);
        let names = columns(output);
        let mut found = keys.iter().map(|key| self.store.find(key, names)).collect::<Result<Vec<_>, _>>()?;
        let again = |row: &Row| self.options.retry_failed && !row.is_done();
        let wanted: Vec<usize> = (0..samples.len()).filter(|&i| found[i].as_ref().is_none_or(again)).collect();
        let mut progress = self.begin(output, &found);
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
            progress.note(&row, limit, Some((k, seconds)));
            found[i] = Some(row);
            hear(&progress);
            Ok(())
        })?;
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
    fn begin(&self, output: SampleOutput, found: &[Option<Row>]) -> EnsembleProgress {
        let (wanted, limit) = (found.len(), self.loaded.case.ensemble.limit);
        let begun = Instant::now();
        let mut progress =
            EnsembleProgress { output, begun, stored: 0, done: 0, wanted, answered: 0, below: 0, slowest: None };
        let kept = found.iter().flatten().filter(|row| row.is_done() || !self.options.retry_failed);
        kept.for_each(|row| progress.note(row, limit, None));
        EnsembleProgress { stored: progress.done, ..progress }
    }
}

impl EnsembleProgress {
    fn note(&mut self, row: &Row, limit: f64, took: Option<(usize, f64)>) {
        self.done += 1;
        let factor = row.number(columns(self.output)[0]).filter(|_| self.output != SampleOutput::Displacement);
        if let Some(output) = factor {
            self.answered += 1;
            self.below += usize::from(output < limit);
        }
        let slower =
            |(k, seconds): (usize, f64)| self.slowest.is_none_or(|(_, most)| seconds > most).then_some((k, seconds));
        self.slowest = took.and_then(slower).or(self.slowest);
    }
}
