//! The yield acceleration: the horizontal acceleration of all rock, out of the slope, at which it just stands at its
//! own strength.

use std::sync::atomic::AtomicBool;

use enmm::model::case::{Case, Invalid, Load, LoadKind};
use enmm::model::{Integrators, Mechanism};

use super::bracket::Search;
use super::{End, Progress, Reduction, ReductionError, ReductionOptions, TOLERANCE, Trial, Verdict, stands};
use crate::limit_analysis;

/// Least and greatest coefficient that is tried.
pub const COEFFICIENT_RANGE: [f64; 2] = [0.002, 2.0];
/// The first pair where limit analysis foretells nothing.
const FIRST: [f64; 2] = [0.1, 0.15];
/// Share by which the first pair begins below and ends above what limit analysis foretells, in tolerances: blocks that
/// give way have a little less than rigid ones.
const ABOUT: [f64; 2] = [1.5, 0.5];
/// Width of the bracket of limit analysis, relative to the coefficient.
const CLOSE: f64 = 1e-4;
/// Difference of heights, over the height of the drawing, from which the ground falls to one side.
const LEVEL: f64 = 0.02;

/// The side to which the slope falls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// To smaller x.
    Left,
    /// To greater x.
    Right,
}

impl Direction {
    /// `left` or `right`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// −1 or 1 along x.
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }

    /// The side to which the ground of a case falls: where its outline ends lower.
    ///
    /// # Errors
    /// Both ends are as high.
    pub fn of(case: &Case) -> Result<Self, Invalid> {
        let outline = &case.domain.outline;
        let range = |k: usize| outline.iter().map(|p| p[k]).fold([f64::INFINITY, -f64::INFINITY], widened);
        let ([left, right], [bottom, top]) = (range(0), range(1));
        let edge = 1e-6 * (right - left);
        let height = |x: f64| {
            outline.iter().filter(|p| (p[0] - x).abs() <= edge).map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max)
        };
        let rise = height(right) - height(left);
        if rise.abs() <= LEVEL * (top - bottom) {
            let message = "is as high at its left end as at its right, so that nothing says to which side the slope \
                           falls; name it, as in --seismic=left";
            return Err(Invalid { key: "domain.outline".to_owned(), message: message.to_owned() });
        }
        Ok(if rise > 0.0 { Self::Left } else { Self::Right })
    }
}

fn widened([low, high]: [f64; 2], value: f64) -> [f64; 2] {
    [low.min(value), high.max(value)]
}

/// How to look for the yield acceleration.
#[derive(Debug, Clone, Copy)]
pub struct SeismicOptions<'a> {
    /// The side to which the slope falls; that to which its ground falls where none is named.
    pub direction: Option<Direction>,
    /// Width of the final bracket relative to the coefficient.
    pub tolerance: f64,
    /// Set by another thread to end the search with the trials that are done.
    pub interrupt: Option<&'a AtomicBool>,
    /// The integrators from which the case names one.
    pub integrators: &'a dyn Integrators,
}

/// A trial with an acceleration of all rock.
#[derive(Debug, Clone, PartialEq)]
pub struct SeismicTrial {
    /// Acceleration over gravity.
    pub coefficient: f64,
    /// The trial at F = 1; none where the rock does not even come to rest with joints that hold.
    pub trial: Option<Trial>,
}

impl SeismicTrial {
    /// Whether the slope stands.
    pub fn verdict(&self) -> Verdict {
        self.trial.as_ref().map_or(Verdict::Unstable, |trial| trial.verdict)
    }

    /// Reason of the verdict in words.
    pub fn word(&self) -> String {
        self.trial.as_ref().map_or_else(|| "no rest with joints that hold".to_owned(), Trial::word)
    }
}

/// Result of a search for the yield acceleration.
#[derive(Debug, Clone)]
pub struct YieldAcceleration {
    /// The side to which the slope falls.
    pub direction: Direction,
    /// Gravity (m/s²) of which coefficients are shares.
    pub gravity: f64,
    /// The trials, ascending in their coefficients.
    pub trials: Vec<SeismicTrial>,
    /// Greatest coefficient at which the slope stood, below every other.
    pub low: Option<f64>,
    /// Least at which it did not.
    pub high: Option<f64>,
    /// How the search ended.
    pub end: End,
    /// The coefficient at which the factor of limit analysis is 1, an upper bound, or why there is none.
    pub bound: Result<f64, String>,
    /// The search at F = 1 with the least coefficient at which the slope did not stand, for its mechanism.
    pub failing: Option<Box<Reduction>>,
}

impl YieldAcceleration {
    /// The yield acceleration over gravity: the middle of the bracket, when it was found.
    pub fn coefficient(&self) -> Option<f64> {
        let (low, high) = (self.low?, self.high?);
        (self.end == End::Found).then_some(0.5 * (low + high))
    }

    /// The greatest coefficient that was tried, where the slope stands at it.
    pub fn at_least(&self) -> Option<f64> {
        self.low.filter(|_| self.end == End::StableThroughout)
    }

    /// The way in which the slope fails beyond it.
    pub fn mechanism(&self) -> Option<Mechanism> {
        self.failing.as_ref()?.mechanism
    }
}

/// Finds the yield acceleration of a case whose slope stands without an earthquake; `hear` is called with each trial as
/// it ends. Each trial brings the slope to rest under its own acceleration, with joints that hold, and then lets its
/// strength fall to its own, as a trial of the factor of safety at F = 1 with a body load does.
///
/// Trials are made in pairs, which two threads can share; what is tried does not depend on how many there are.
///
/// # Errors
/// A case without gravity, with level ground and no direction, or that cannot be built.
pub fn yield_acceleration(
    case: &Case,
    options: &SeismicOptions,
    hear: &mut (dyn FnMut(&SeismicTrial, Progress) + Send),
) -> Result<YieldAcceleration, ReductionError> {
    let gravity = libm::hypot(case.gravity.x, case.gravity.y);
    if gravity == 0.0 {
        let message = "is 0, so that no acceleration is a share of it; give x or y";
        return Err(Invalid { key: "gravity".to_owned(), message: message.to_owned() }.into());
    }
    let direction = options.direction.map_or_else(|| Direction::of(case), Ok)?;
    let shaken = |coefficient: f64| with_acceleration(case, coefficient * gravity * direction.sign());
    let bound = bounded(&shaken);
    let start = bound.as_ref().map_or(FIRST, |bound| {
        let [below, above] = ABOUT.map(|tolerances| tolerances * options.tolerance);
        [bound * (1.0 - below), bound * (1.0 + above)].map(|k| k.clamp(COEFFICIENT_RANGE[0], COEFFICIENT_RANGE[1]))
    });
    let mut search = Search::new(start, COEFFICIENT_RANGE, options.tolerance);
    let at_own_strength = ReductionOptions {
        low: Some(1.0),
        high: Some(1.0),
        tolerance: TOLERANCE,
        interrupt: options.interrupt,
        integrators: options.integrators,
    };
    let run = |coefficient: f64| made(coefficient, stands(&shaken(coefficient), &at_own_strength));
    let (mut trials, mut failing, mut end) = (Vec::<SeismicTrial>::new(), None::<(f64, Box<Reduction>)>, None);
    while let (None, Some((a, b))) = (&end, search.next()) {
        let both = match b {
            Some(b) => <[Made; 2]>::from(rayon::join(|| run(a), || run(b))).into_iter().collect(),
            None => vec![run(a)],
        };
        for outcome in both {
            let (trial, reduction) = match outcome? {
                Ok(made) => made,
                Err(stop) => {
                    end.get_or_insert(stop);
                    continue;
                }
            };
            search.note(trial.coefficient, trial.verdict());
            hear(&trial, Progress { trials: search.made(), expected: search.expected() });
            let is_lowest = failing.as_ref().is_none_or(|(least, _)| trial.coefficient < *least);
            if trial.verdict() != Verdict::Stable && is_lowest {
                failing = reduction.map(|reduction| (trial.coefficient, reduction));
            }
            trials.push(trial);
        }
    }
    trials.sort_by(|a, b| a.coefficient.total_cmp(&b.coefficient));
    let [low, high] = search.bracket();
    let end = end.unwrap_or_else(|| search.end());
    let failing = failing.map(|(_, reduction)| reduction);
    Ok(YieldAcceleration { direction, gravity, trials, low, high, end, bound, failing })
}

/// A trial with its search at F = 1, or the end of all trials.
type Made = Result<Result<(SeismicTrial, Option<Box<Reduction>>), End>, ReductionError>;

fn made(coefficient: f64, outcome: Result<Reduction, ReductionError>) -> Made {
    match outcome {
        Ok(reduction) => match reduction.end {
            End::Interrupted | End::Failed(_) => Ok(Err(reduction.end)),
            _ => {
                let trial = reduction.trials.iter().find(|trial| trial.factor == 1.0).cloned();
                Ok(Ok((SeismicTrial { coefficient, trial }, Some(Box::new(reduction)))))
            }
        },
        // Joints without tensile strength part under a great acceleration, whatever their friction.
        Err(ReductionError::NotAtRest { .. }) => Ok(Ok((SeismicTrial { coefficient, trial: None }, None))),
        Err(ReductionError::Interrupted) => Ok(Err(End::Interrupted)),
        Err(ReductionError::Failed(error)) => Ok(Err(End::Failed(error))),
        Err(error) => Err(error),
    }
}

/// The case with an acceleration (m/s²) of all rock along x, which acts from its first stage on.
pub fn with_acceleration(case: &Case, along_x: f64) -> Case {
    let mut case = case.clone();
    case.loads.push(Load {
        name: None,
        kind: LoadKind::Body,
        point: None,
        edge: None,
        force: None,
        moment: None,
        traction: None,
        pressure: None,
        pressure_end: None,
        acceleration: Some([along_x, 0.0]),
        table: None,
    });
    case
}

/// The coefficient at which the factor of limit analysis is 1, by halvings between coefficients at which it is above
/// and below 1.
fn bounded(shaken: &dyn Fn(f64) -> Case) -> Result<f64, String> {
    let holds = |coefficient: f64| {
        let bound = limit_analysis::bound(&shaken(coefficient)).map_err(|error| error.to_string())?;
        let factor = bound.level_tops.factor;
        match factor.found() {
            Some(factor) => Ok(factor >= 1.0),
            None => Err(format!("its factor at k = {coefficient:.3} is {factor}")),
        }
    };
    let [least, most] = COEFFICIENT_RANGE;
    if !holds(least)? {
        return Err(format!("it is below {least}"));
    }
    let mut low = least;
    let mut high = FIRST[0];
    while holds(high)? {
        low = high;
        if high >= most {
            return Err(format!("it is above {most}"));
        }
        high = (2.0 * high).min(most);
    }
    while high / low - 1.0 > CLOSE {
        let middle = 0.5 * (low + high);
        if holds(middle)? { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}
