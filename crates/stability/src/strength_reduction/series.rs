//! A series of trials in one setting, until the limit lies between two of them.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::bracket::Search;
use super::setting::{Geometry, Setting};
use super::trial::{Base, Ended, Outcome, Rest};
use super::{End, Progress, Trial, Verdict};
use enmm::model::Simulation;
use enmm::model::tables::{BlockId, SideId};

/// Ratio, less 1, of the factors between which bars yield first.
const FIRST_YIELD: f64 = 0.02;

/// Trials in one setting, and what they have found.
#[derive(Debug, Clone)]
pub struct Series {
    /// The trials, ascending in F.
    pub trials: Vec<Trial>,
    /// Greatest F that was stable, below every other.
    pub low: Option<f64>,
    /// Least F that was not.
    pub high: Option<f64>,
    /// How it ended.
    pub end: End,
    /// The model at the end of the greatest stable trial.
    pub stable: Option<Simulation>,
    /// The model at the end of the least trial that was not stable.
    pub unstable: Option<Ended>,
}

impl Series {
    /// The limit: the middle of the bracket, when it was found.
    pub fn factor(&self) -> Option<f64> {
        let (low, high) = (self.low?, self.high?);
        (self.end == End::Found).then_some(0.5 * (low + high))
    }

    /// The greatest F that was tried, when the slope is stable at it.
    pub fn at_least(&self) -> Option<f64> {
        self.low.filter(|_| self.end == End::StableThroughout)
    }

    /// Takes over the least trial of another series that was not stable, where its own bracket ends at that.
    pub fn take_top(&mut self, other: &Self) {
        if self.trial(self.high).is_none() {
            self.trials.extend(other.trial(self.high).cloned());
            self.unstable = other.unstable.clone();
        }
    }

    /// The trial at a factor.
    pub fn trial(&self, factor: Option<f64>) -> Option<&Trial> {
        self.trials.iter().find(|trial| Some(trial.factor) == factor)
    }
}

/// Makes trials from a common start and says how far it has come.
pub struct Trials<'a> {
    /// The slope at rest.
    pub base: &'a Base,
    /// Set by another thread to end the search.
    pub interrupt: Option<&'a AtomicBool>,
    /// Hears of each trial.
    pub hear: &'a mut (dyn FnMut(&Trial, Progress) + Send),
    /// Trials so far.
    pub made: usize,
    /// Where the trials of a setting begin.
    pub start: Option<Start>,
}

/// Where the trials of a setting begin: at the rest of a slope that has hardly moved at a factor far below theirs, or,
/// where there is none, at that of the common start.
pub struct Start {
    left_out: Vec<(BlockId, SideId)>,
    rest: Option<Arc<Rest>>,
}

impl Trials<'_> {
    /// Goes on with a search in a setting until it is over.
    pub fn series(&mut self, mut search: Search, setting: &Setting) -> Series {
        let lead = self.lead(&mut search, setting);
        let (base, interrupt, rest) = (self.base, self.interrupt, self.rest(setting));
        let mut series = self.series_of(search, &|factor| base.run(factor, setting, rest.as_deref(), interrupt));
        series.trials.extend(lead);
        series.trials.sort_by(|a, b| a.factor.total_cmp(&b.factor));
        series
    }

    /// The slope at rest from which the trials of a setting go on.
    pub fn rest(&self, setting: &Setting) -> Option<Arc<Rest>> {
        self.start.as_ref().filter(|start| start.left_out == setting.left_out)?.rest.clone()
    }

    /// Looks for a start of the trials of a setting, far below those that a search begins with; if the slope fails
    /// there, the search begins there as well. It lies in the real geometry: a slope that has hardly moved is as drawn.
    /// Rock that yields is judged by its motion in the whole fall. Returns the trial, if it is stable.
    fn lead(&mut self, search: &mut Search, setting: &Setting) -> Option<Trial> {
        if self.base.yields || self.start.as_ref().is_some_and(|start| start.left_out == setting.left_out) {
            return None;
        }
        let factor = search.lead()?;
        let real = Setting { geometry: Geometry::Real, ..setting.clone() };
        let (base, interrupt) = (self.base, self.interrupt);
        let (trial, Ended { simulation, .. }) = self.one(&|| base.run(factor, &real, None, interrupt)).ok()?;
        let is_stable = trial.verdict == Verdict::Stable;
        if !is_stable {
            search.begin_at(factor);
        }
        let rest = (is_stable && base.is_near(&trial)).then(|| Arc::new(Rest { factor, simulation }));
        self.start = Some(Start { left_out: setting.left_out.clone(), rest });
        is_stable.then_some(trial)
    }

    /// Goes on with a search by trials of any kind, which are made in pairs, so that two threads can share them.
    pub fn series_of(&mut self, mut search: Search, run: &(dyn Fn(f64) -> Outcome + Sync)) -> Series {
        let (mut trials, mut end) = (Vec::<Trial>::new(), None);
        let (mut stable, mut unstable) = (None::<(f64, Simulation)>, None::<(f64, Ended)>);
        while let (None, Some((a, b))) = (&end, search.next()) {
            let both = match b {
                Some(b) => <[Outcome; 2]>::from(rayon::join(|| run(a), || run(b))).into_iter().collect(),
                None => vec![run(a)],
            };
            for outcome in both {
                match outcome {
                    Ok((trial, ended)) => {
                        search.note(trial.factor, trial.verdict);
                        self.tell(&trial, search.expected() - search.made());
                        let factor = trial.factor;
                        if trial.verdict == Verdict::Stable {
                            keep(&mut stable, factor, ended.simulation, |kept| factor > kept);
                        } else {
                            keep(&mut unstable, factor, ended, |kept| factor < kept);
                        }
                        trials.push(trial);
                    }
                    Err(stop) => _ = end.get_or_insert(stop),
                }
            }
        }
        trials.sort_by(|a, b| a.factor.total_cmp(&b.factor));
        let [low, high] = search.bracket();
        let stable = stable.filter(|(factor, _)| Some(*factor) == low).map(|(_, simulation)| simulation);
        let unstable = unstable.map(|(_, ended)| ended);
        Series { trials, low, high, end: end.unwrap_or_else(|| search.end()), stable, unstable }
    }

    /// Goes down from the least stable trial of a series in which bars yield, until their first yield lies between two.
    pub fn down_to_whole_bars(&mut self, series: &mut Series, setting: &Setting, range: [f64; 2]) {
        let mut stable = series.trials.iter().filter(|trial| trial.verdict == Verdict::Stable);
        let Some(least) = stable.find(|trial| trial.bars_yield).map(|trial| trial.factor) else { return };
        let (base, interrupt, rest) = (self.base, self.interrupt, self.rest(setting));
        let mut search = Search::new([least / (1.0 + FIRST_YIELD); 2], range, FIRST_YIELD);
        search.note(least, Verdict::Unstable);
        while let Some((a, b)) = search.next().filter(|(a, _)| *a >= range[0]) {
            for factor in std::iter::once(a).chain(b) {
                let Ok((trial, _)) = self.one(&|| base.run(factor, setting, rest.as_deref(), interrupt)) else {
                    return;
                };
                let is_whole = trial.verdict == Verdict::Stable && !trial.bars_yield;
                search.note(factor, if is_whole { Verdict::Stable } else { Verdict::Unstable });
                series.trials.push(trial);
            }
        }
        series.trials.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    }

    /// Makes one trial.
    pub fn one(&mut self, run: &dyn Fn() -> Outcome) -> Outcome {
        let outcome = run();
        if let Ok((trial, _)) = &outcome {
            self.tell(trial, 0);
        }
        outcome
    }

    /// Says that a trial has ended, and how many will follow.
    fn tell(&mut self, trial: &Trial, open: usize) {
        self.made += 1;
        (self.hear)(trial, Progress { trials: self.made, expected: self.made + open });
    }
}

/// Keeps a model if its factor is better than that of the one that is kept.
fn keep<T>(kept: &mut Option<(f64, T)>, factor: f64, ended: T, better: impl Fn(f64) -> bool) {
    if kept.as_ref().is_none_or(|(kept, _)| better(*kept)) {
        *kept = Some((factor, ended));
    }
}
