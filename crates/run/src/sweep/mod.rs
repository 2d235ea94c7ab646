//! A sweep: the factor of safety of a case, or its displacement, over values of its keys, as a curve, a contour or a
//! tornado.
//!
//! Samples of a sweep go to the store of an ensemble, by the same workers; the results are written when all are there.

mod change;
mod crossing;
mod drawing;
mod record;

use std::time::Instant;

use enmm::model::case::EnsembleOutput;
use enmm_io::LoadedCase;

use crate::ensemble::{
    Answer, Answers, Ask, EnsembleError, EnsembleOptions, EnsembleProgress, SampleOutput, SearchOptions, Values, hold,
};

pub use change::Change;
pub use crossing::Crossing;
pub use record::{Effect, SweepResult};

/// Most samples of a sweep.
const SAMPLES_MAX: usize = 100_000;

/// Pictures that sweeps make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SweepKind {
    /// One key: the factor over its values.
    Curve,
    /// Two keys: the factor over both.
    Contour,
    /// Any number of keys: the factor of the case, and that after each change alone.
    Tornado,
}

impl SweepKind {
    /// Its name in records.
    pub fn name(self) -> &'static str {
        match self {
            Self::Curve => "curve",
            Self::Contour => "contour",
            Self::Tornado => "tornado",
        }
    }
}

/// Keys with their values, and the output of each sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// Keys with their values.
    pub changes: Vec<Change>,
    /// Picture that they make.
    pub kind: SweepKind,
    /// Output of each sample.
    pub output: SampleOutput,
}

impl Sweep {
    /// A curve or a contour, or a tornado of changes one by one.
    ///
    /// # Errors
    /// A key occurs twice, or the number of keys or values makes no picture.
    pub fn new(changes: Vec<Change>, one_by_one: bool, output: SampleOutput) -> Result<Self, String> {
        let twice = (1..changes.len()).find(|&k| changes[..k].iter().any(|other| other.key == changes[k].key));
        if let Some(k) = twice {
            return Err(format!("{}: is given twice; give all its values at once", changes[k].key));
        }
        let kind = match changes.len() {
            _ if one_by_one => SweepKind::Tornado,
            1 => SweepKind::Curve,
            2 => SweepKind::Contour,
            n => {
                let keys = changes.iter().map(|change| change.key.as_str()).collect::<Vec<_>>().join(", ");
                let remedy = "one makes a curve and two a contour; add --one-by-one to change each alone";
                return Err(format!("{keys}: are {n} keys; {remedy}"));
            }
        };
        if let Some(single) = changes.iter().find(|change| kind != SweepKind::Tornado && change.values.len() < 2) {
            let remedy = "give more of them, or add --one-by-one to change each key alone";
            return Err(format!("{}: has 1 value, a {} needs at least 2; {remedy}", single.key, kind.name()));
        }
        let sweep = Self { changes, kind, output };
        let n = sweep.size();
        if n > SAMPLES_MAX {
            return Err(format!("the sweep has {n} samples, at most are {SAMPLES_MAX}; give fewer values"));
        }
        Ok(sweep)
    }

    fn size(&self) -> usize {
        let counts = self.changes.iter().map(|change| change.values.len());
        if self.kind == SweepKind::Tornado { 1 + counts.sum::<usize>() } else { counts.product() }
    }

    /// The values of each sample: the first key runs fastest in a contour; a tornado begins with the case as it is.
    pub fn samples(&self) -> Vec<Values> {
        let one = |change: &Change, k: usize| (change.key.clone(), change.values[k]);
        let alone = |change: &Change| (0..change.values.len()).map(|k| vec![one(change, k)]).collect::<Vec<_>>();
        match &self.changes[..] {
            [across, up] if self.kind == SweepKind::Contour => {
                let row = |j: usize| (0..across.values.len()).map(move |i| vec![one(across, i), one(up, j)]);
                (0..up.values.len()).flat_map(row).collect()
            }
            changes if self.kind == SweepKind::Tornado => {
                std::iter::once(Vec::new()).chain(changes.iter().flat_map(alone)).collect()
            }
            changes => changes.iter().flat_map(alone).collect(),
        }
    }

    /// Settings that have each value of each key at least once, to be looked at before any sample is worked out.
    pub fn settings(&self) -> Vec<Vec<String>> {
        let is_first = |(key, value): &(String, enmm_ensemble::Value)| {
            self.changes.iter().any(|change| change.key == *key && change.values[0] == *value)
        };
        let samples = self.samples().into_iter();
        let edge = samples.filter(|values| values.iter().filter(|value| !is_first(value)).count() < 2);
        edge.map(|values| values.iter().map(|(key, value)| format!("{key}={value}")).collect()).collect()
    }
}

/// Works out the samples of a sweep that are not in the store yet, and writes the results of all.
///
/// `ask` and `hear` are those of [`crate::ensemble()`].
///
/// # Errors
/// See [`EnsembleError`]; what is done stays in the store.
pub fn sweep(
    loaded: &LoadedCase,
    sweep: &Sweep,
    options: &EnsembleOptions,
    ask: impl Fn(&Ask) -> Result<Answer, String> + Sync,
    hear: &mut dyn FnMut(&EnsembleProgress),
) -> Result<SweepResult, EnsembleError> {
    let clock = Instant::now();
    let _held = hold(loaded, options)?;
    let mut answers = Answers::open(loaded, options, sweep.samples(), &ask, hear)?;
    // Bounds and runs have no search.
    let is_searched = sweep.output == EnsembleOutput::FactorOfSafety.into();
    let search = if is_searched { options.search } else { SearchOptions::default() };
    let all: Vec<usize> = (0..answers.count()).collect();
    let rows = answers.find(&all, sweep.output, &search)?;
    drop(answers);
    let result = SweepResult::of(sweep.clone(), rows, loaded.case.ensemble.limit)?;
    result.write(loaded, options, clock.elapsed().as_secs_f64()).map_err(EnsembleError::Output)?;
    Ok(result)
}
