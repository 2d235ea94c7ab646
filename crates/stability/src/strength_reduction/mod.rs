//! Factor of safety by strength reduction: the case at rest, then trials with its strength divided by F until the
//! greatest stable F is known (theory, section 16).

mod answer;
mod bracket;
mod corners;
mod doubt;
mod judge;
mod lost;
mod mechanism;
mod reference;
pub mod seismic;
mod series;
mod setting;
mod slip;
mod toppling;
mod trial;

use enmm::model::case::keys::rounded;
use std::sync::atomic::{AtomicBool, Ordering};

use enmm::geometry::{Point, Vector};
use enmm::model::StepError;

use super::limit_analysis::continuum::{self, Bracket};
use super::limit_analysis::{self, Bound, BoundError, NearEnds};
use enmm::model::case::{Case, Invalid};
use enmm::model::{ExplicitAlone, Integrators, Mechanism, Simulation};

pub use corners::CornersHold;
pub use judge::{Reason, Verdict};
pub use mechanism::{CHIP, MechanismOptions, mechanisms};
pub use series::Series;
pub use setting::Geometry;
pub use slip::slide;
pub use trial::Begun;

use series::Trials;
use setting::Setting;
use trial::Ended;

/// Least and greatest F that trials reach when none are given.
pub const FACTOR_RANGE: [f64; 2] = [0.05, 20.0];
/// Factor on the strength with which a slope comes to rest before the trials: its joints hold, so that they neither
/// slip nor lose their peak strength.
pub const HELD: f64 = 1000.0;
/// Width of the final bracket, relative to F, when none is given.
pub const TOLERANCE: f64 = 5e-3;

/// How to look for the factor of safety.
#[derive(Debug, Clone, Copy)]
pub struct ReductionOptions<'a> {
    /// Least F that trials reach; where the search begins when given.
    pub low: Option<f64>,
    /// Greatest F that trials reach; where the search begins when given.
    pub high: Option<f64>,
    /// Width of the final bracket relative to F.
    pub tolerance: f64,
    /// Set by another thread to end the search with the trials that are done.
    pub interrupt: Option<&'a AtomicBool>,
    /// The integrators from which the case names one.
    pub integrators: &'a dyn Integrators,
}

impl Default for ReductionOptions<'_> {
    fn default() -> Self {
        Self { low: None, high: None, tolerance: TOLERANCE, interrupt: None, integrators: &ExplicitAlone }
    }
}

/// One trial: the slope at rest, its strength divided by `factor`, and what became of it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trial {
    /// F.
    pub factor: f64,
    /// Geometry in which it was to rest.
    pub geometry: Geometry,
    /// Whether the slope is stable at it.
    pub verdict: Verdict,
    /// Reason of the verdict.
    pub reason: Reason,
    /// Simulated time (s).
    pub time: f64,
    /// Largest displacement of a block's covers since the trial began (m).
    pub displacement: f64,
    /// Largest slip of a contact since the trial began (m); where rock yields, the largest displacement.
    pub slip: f64,
    /// Speed of the fastest block in the mean of the last window (m/s).
    pub speed: f64,
    /// Kinetic energy at the end (J/m).
    pub kinetic: f64,
    /// Energy that the motion has set free since the trial began (J/m).
    pub released: f64,
    /// Acceleration of the fastest block by a straight line through its last speeds (m/s²).
    pub acceleration: f64,
    /// Blocks that fail or were caught, fastest first; none when the slope is stable.
    pub failing: Vec<FailingBlock>,
    /// Blocks that have slid off or fallen and are too few to decide: less than a thousandth of the free mass together.
    pub loose: Vec<FailingBlock>,
    /// Internal steps, those of a second trial in small displacements included.
    pub steps: u64,
    /// Energy that the ledger does not explain over its largest term.
    pub ledger_residual: f64,
    /// Wall time (s).
    pub wall: f64,
    /// Whether blocks have moved farther than rock that stands does: by ten times its displacement at rest, or by a
    /// hundredth of the height.
    pub is_far: bool,
    /// Whether a bar has yielded or broken.
    pub bars_yield: bool,
}

impl Trial {
    /// Reason of the verdict in words: `rests after 0.31 m` where a slope moves far before it rests.
    pub fn word(&self) -> String {
        match self.reason {
            Reason::Rest if self.is_far => format!("rests after {:.2} m", self.displacement),
            reason => reason.name().to_owned(),
        }
    }

    /// Area (m²) of the blocks that fail.
    pub fn failing_area(&self) -> f64 {
        self.failing.iter().map(|block| block.area).sum()
    }

    /// Their mass (kg/m).
    pub fn failing_mass(&self) -> f64 {
        self.failing.iter().map(|block| block.mass).sum()
    }
}

/// How far a search has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Trials so far.
    pub trials: usize,
    /// How many there will be, as far as it is known.
    pub expected: usize,
}

/// A block that moves with a failure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FailingBlock {
    /// Block.
    pub block: u32,
    /// Its centroid in the reference configuration (m).
    pub position: Point,
    /// Area (m²).
    pub area: f64,
    /// Mass (kg/m).
    pub mass: f64,
    /// Largest displacement of its covers since the trial began (m).
    pub displacement: f64,
    /// Displacement of its centroid since then (m).
    pub way: Vector,
    /// Turn since the trial began (rad), counter-clockwise.
    pub rotation: f64,
    /// Speed at the end (m/s).
    pub speed: f64,
}

/// How a search ended.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// The bracket is as narrow as it should be.
    Found,
    /// Stable even at the greatest F.
    StableThroughout,
    /// Not stable even at the least F.
    UnstableThroughout,
    /// The caller stopped it.
    Interrupted,
    /// A trial failed numerically.
    Failed(StepError),
}

impl End {
    /// A word for it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::StableThroughout => "stable_throughout",
            Self::UnstableThroughout => "unstable_throughout",
            Self::Interrupted => "interrupted",
            Self::Failed(_) => "failed",
        }
    }
}

/// Most triangles of the first meshes of limit analysis beside a search, and of the last: twice as many from one to the
/// next until the bounds are close, some 30 s of a processor together. Time itself decides nothing, so that a case has
/// the same bounds on any machine.
const TRIANGLES: [usize; 2] = [1000, 4000];

/// Result of a search.
#[derive(Debug, Clone)]
pub struct Reduction {
    /// The trials that decide, ascending in F.
    pub trials: Vec<Trial>,
    /// Greatest F that was stable, below every other.
    pub low: Option<f64>,
    /// Least F that was not.
    pub high: Option<f64>,
    /// How the search ended.
    pub end: End,
    /// The way in which the slope fails in the least trial that was not stable.
    pub mechanism: Option<Mechanism>,
    /// Corners that carry the slope, with the search in which they hold; none where they do not decide.
    pub corners: Option<CornersHold>,
    /// The factor before nudges, where the slope fails by turning and its greatest stable trial was nudged.
    pub before_nudges: Option<f64>,
    /// The trials in the real geometry, where they were made: beyond their limit the slope is lost.
    pub lost: Option<Series>,
    /// Time (s) and steps that coming to rest took.
    pub rest: (f64, u64),
    /// Area (m²) of all blocks that can move and have no support.
    pub free_area: f64,
    /// Limit analysis of the same model, or why there is none.
    pub bound: Result<Bound, String>,
    /// That of a model whose rock yields, in place of the bound.
    pub bracket: Option<Bracket>,
    /// Ends of joints that miss a line and decide about the bound.
    pub ends: Option<NearEnds>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// The model at the end of the least trial that was not stable, else at rest.
    pub simulation: Simulation,
    /// How the motion of that trial began; none at rest.
    pub begun: Option<Begun>,
}

impl Reduction {
    /// The factor of safety: the middle of the bracket, when it was found.
    pub fn factor(&self) -> Option<f64> {
        let (low, high) = (self.low?, self.high?);
        (self.end == End::Found).then_some(0.5 * (low + high))
    }

    /// The largest energy that a ledger leaves open, over its largest term: of stable trials, and of those in the real
    /// geometry. In small displacements the ledger of a slope that moves far is exact to the first order of turns
    /// alone.
    pub fn ledger_residual(&self) -> f64 {
        let lost = self.lost.iter().flat_map(|lost| &lost.trials);
        let counts = |t: &&Trial| t.verdict == Verdict::Stable || t.geometry == Geometry::Real;
        self.trials.iter().chain(lost).filter(counts).map(|t| t.ledger_residual.abs()).fold(0.0, f64::max)
    }

    /// The least trial that was not stable.
    pub fn first_unstable(&self) -> Option<&Trial> {
        self.trials.iter().find(|trial| Some(trial.factor) == self.high)
    }

    /// The greatest F that was tried, when the slope is stable at it: the factor of safety is at least that.
    pub fn at_least(&self) -> Option<f64> {
        self.low.filter(|_| self.end == End::StableThroughout)
    }
}

/// Why no trial was made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReductionError {
    /// The case cannot be built, or has no stage to begin with.
    #[error(transparent)]
    Case(#[from] Invalid),
    /// The slope does not come to rest, whatever its strength.
    #[error(
        "stage {stage:?} does not come to rest within {} s even with {HELD} times the strength (unbalanced \
         ratio {unbalanced:.2e}): {remedy}",
        rounded(*time)
    )]
    NotAtRest {
        /// Stage.
        stage: String,
        /// Time at which it was given up (s).
        time: f64,
        /// Unbalanced ratio then.
        unbalanced: f64,
        /// Remedy.
        remedy: &'static str,
    },
    /// A numerical failure before the trials.
    #[error("before the trials: {0}")]
    Failed(StepError),
    /// Interrupted before the trials.
    #[error("interrupted before the first trial")]
    Interrupted,
}

/// Finds the factor of safety of a case; `hear` is called with each trial as it ends. Limit analysis of the same model
/// stands beside it.
///
/// Trials are made in pairs, which two threads can share; what is tried does not depend on how many there are.
///
/// # Errors
/// A case that cannot be built, has no static stage or does not come to rest.
pub fn factor_of_safety(
    case: &Case,
    options: &ReductionOptions,
    hear: &mut (dyn FnMut(&Trial, Progress) + Send),
) -> Result<Reduction, ReductionError> {
    reduce(case, options, |case| SecondOpinion::of(case, options), hear)
}

/// Trials between the limits of `options` alone, without limit analysis beside them.
fn stands(case: &Case, options: &ReductionOptions) -> Result<Reduction, ReductionError> {
    reduce(case, options, |_| SecondOpinion::none("not asked for".to_owned()), &mut |_, _| ())
}

fn reduce(
    case: &Case,
    options: &ReductionOptions,
    opinion: impl FnOnce(&Case) -> SecondOpinion,
    hear: &mut (dyn FnMut(&Trial, Progress) + Send),
) -> Result<Reduction, ReductionError> {
    let mut rest = reference::settle(case, options)?;
    let base = trial::Base::new(rest.simulation, options.tolerance);
    let opinion = opinion(case);
    let limits = [options.low, options.high];
    let range = [options.low.unwrap_or(FACTOR_RANGE[0]), options.high.unwrap_or(FACTOR_RANGE[1])];
    let start = bracket::start(limits, opinion.foretold(options.tolerance), range);
    let search = bracket::Search::new(start, range, options.tolerance);
    // Blocks that break are others than those whose contacts the drawing has.
    let geometry = if case.yields() || case.breaks() { Geometry::Real } else { Geometry::Drawn };
    let setting = Setting { geometry, left_out: Vec::new() };
    let mut trials = Trials { base: &base, interrupt: options.interrupt, hear, made: 0, start: None };
    let held = trials.series(search.clone(), &setting);
    let lost = lost::look(&mut trials, &held, &setting, &search);
    let both: Vec<&Series> = std::iter::once(&held).chain(&lost).collect();
    let carrying = if case.breaks() { Vec::new() } else { corners::carrying(&base.simulation, &both) };
    let (series, lost, corners, setting) = if carrying.is_empty() || held.low.is_none() {
        (held, lost, None, setting)
    } else {
        let broken = corners::without(&carrying, &setting);
        let foretold = opinion.foretold_without_corners(options.tolerance);
        let mut series = trials.series(corners::below(&held, &search, limits, foretold), &broken);
        series.take_top(&held);
        let lost_too = lost::look(&mut trials, &series, &broken, &search);
        let hold = CornersHold { corners: carrying, series: lost.unwrap_or(held) };
        let decide = hold.decide(&series, lost_too.as_ref());
        (series, lost_too, decide.then_some(hold), broken)
    };
    let (mut series, before_nudges) = toppling::nudge(&mut trials, series, &setting, &search);
    trials.down_to_whole_bars(&mut series, &setting, range);
    let (mechanism, free_area) = (toppling::mechanism(&base, &series), base.free_area());
    rest.warnings.extend(toppling::coarse(&base, &series, mechanism));
    let Ended { simulation, begun } = ended(lost.as_ref(), series.unstable, base.simulation);
    let mut reduction = Reduction {
        trials: series.trials,
        low: series.low,
        high: series.high,
        end: series.end,
        mechanism,
        corners,
        before_nudges,
        lost,
        rest: rest.effort,
        free_area,
        bound: opinion.bound,
        bracket: opinion.bracket,
        ends: opinion.ends,
        warnings: rest.warnings,
        simulation,
        begun,
    };
    let doubts = doubt::doubts(&reduction, case);
    reduction.warnings.extend(doubts);
    Ok(reduction)
}

/// The slope that is shown: at the end of the least trial that fails, of rock that is lost first, or else at rest.
fn ended(lost: Option<&Series>, unstable: Option<Ended>, rest: Simulation) -> Ended {
    let failed = lost.and_then(|lost| lost.unstable.clone()).or(unstable);
    failed.unwrap_or(Ended { simulation: rest, begun: None })
}

/// Limit analysis beside a search: of rigid blocks with the ends that decide about their bound, or of rock that yields.
struct SecondOpinion {
    bound: Result<Bound, String>,
    bracket: Option<Bracket>,
    ends: Option<NearEnds>,
}

impl SecondOpinion {
    fn none(why: String) -> Self {
        Self { bound: Err(why), bracket: None, ends: None }
    }

    fn of(case: &Case, options: &ReductionOptions) -> Self {
        if options.interrupt.is_some_and(|interrupt| interrupt.load(Ordering::Relaxed)) {
            return Self::none("interrupted".to_owned());
        }
        if case.yields() {
            return match close_bracket(case) {
                Ok(bracket) => {
                    Self { bracket: Some(bracket), ..Self::none("rock yields, and blocks are not rigid".to_owned()) }
                }
                Err(error) => Self::none(error.to_string()),
            };
        }
        match limit_analysis::bound(case) {
            Ok(bound) => Self { ends: bound.ends.clone(), bound: Ok(bound), bracket: None },
            Err(BoundError::Held { invalid, ends }) => {
                Self { ends: ends.map(|ends| *ends), ..Self::none(format!("{}: {}", invalid.key, invalid.message)) }
            }
            Err(error) => Self::none(error.to_string()),
        }
    }

    /// The factor that trials may find, and the ratio within which: of rigid blocks the estimate without normality, or
    /// the bound where that is none; of rock that yields the lower bound.
    fn foretold(&self, tolerance: f64) -> Option<[f64; 2]> {
        if let Some(bracket) = &self.bracket {
            return Some(near(bracket.lower.found()?, bracket.upper.found()?, tolerance));
        }
        let bound = self.bound.as_ref().ok()?;
        let most = bound.level_tops.factor.found()?;
        let estimate = bound.estimate.as_ref().and_then(|estimate| estimate.factor.found());
        Some(near(estimate.map_or(most, |estimate| estimate.min(most)), most, tolerance))
    }

    /// The same where corners carry nothing.
    fn foretold_without_corners(&self, tolerance: f64) -> Option<[f64; 2]> {
        let released = self.bound.as_ref().ok()?.released.as_ref()?.collapse.factor.found()?;
        Some(near(released, released, tolerance))
    }
}

/// A factor and the ratio within which it is known: the tolerance, or four times as much where another one differs
/// from it.
fn near(factor: f64, other: f64, tolerance: f64) -> [f64; 2] {
    let agree = (factor / other - 1.0).abs() <= tolerance;
    [factor, if agree { 1.0 + tolerance } else { 1.0 + 4.0 * tolerance }]
}

/// The bracket of the first meshes on which it is close, else of the last that have a solution.
fn close_bracket(case: &Case) -> Result<Bracket, BoundError> {
    let [mut triangles, most] = TRIANGLES;
    let mut bracket = continuum::bracket(case, triangles)?;
    while !bracket.is_close() && triangles < most {
        triangles *= 2;
        let Ok(finer) = continuum::bracket(case, triangles) else { break };
        bracket = finer;
    }
    Ok(bracket)
}
