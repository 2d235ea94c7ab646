//! Doubts about a factor of safety that follow from its trials.

use super::{FailingBlock, Reason, Reduction, Trial, Verdict};
use crate::limit_analysis::Bound;
use crate::limit_analysis::continuum::Bracket;
use enmm::model::case::Case;

/// Part of the largest term of the ledger that may stay unexplained.
const RESIDUAL: f64 = 1e-3;
/// A stable F over the bound of limit analysis from which something other than strength must hold the slope.
const ABOVE: f64 = 1.02;
/// Blocks that a warning names.
const NAMED: usize = 3;

impl Reduction {
    /// Whether the mechanism of a bound holds more than the few blocks that do not count in trials.
    fn moves_slope(&self, bound: &Bound) -> bool {
        let few = self.simulation.mass_of_few();
        let moving: f64 = bound.level_tops.mechanism.iter().map(|block| block.mass).sum();
        moving > few
    }

    /// The same for a bracket.
    fn moves_rock(&self, bracket: &Bracket) -> bool {
        bracket.moving().map(|motion| motion.mass).sum::<f64>() > self.simulation.mass_of_few()
    }

    /// The upper bound of limit analysis, when a trial above it was stable: the factor of safety is at most that,
    /// whatever the trials say.
    pub fn at_most(&self) -> Option<f64> {
        let limit = match (&self.bracket, &self.bound) {
            (Some(bracket), _) if self.moves_rock(bracket) => bracket.upper.value(),
            (None, Ok(bound)) if self.moves_slope(bound) => bound.level_tops.factor.value(),
            _ => return None,
        };
        self.low.filter(|stable| *stable > ABOVE * limit).map(|_| limit)
    }

    /// Why the factor is in doubt: it is above the bound of limit analysis. The text is among the warnings, too.
    pub fn doubt(&self) -> Option<String> {
        let (limit, stable) = (self.at_most()?, self.low?);
        let over = 100.0 * (stable / limit - 1.0);
        let above = format!("F = {stable:.4} was stable, {over:.1} % above");
        Some(if self.bracket.is_some() {
            format!(
                "{above} the upper bound of limit analysis ({limit:.4}): the mesh is too coarse for rock that yields; \
                 set a smaller `mesh.size`"
            )
        } else {
            format!(
                "{above} what limit analysis of rigid blocks allows ({limit:.4}): something other than strength \
                 holds a block; look at those that `enmm bound` names, and try a finer mesh"
            )
        })
    }
}

/// Reasons not to take the result as it is.
pub fn doubts(reduction: &Reduction, case: &Case) -> Vec<String> {
    let trials = &reduction.trials;
    let mut doubts = Vec::new();
    doubts.extend(not_monotone(trials));
    doubts.extend(slid(trials, |t| t.verdict == Verdict::Caught, "were caught: that does not count as stable"));
    let held = "then held, in small displacements as well: that counts as stable";
    doubts.extend(slid(trials, |t| t.reason == Reason::Hardening, held));
    doubts.extend(reduction.doubt());
    doubts.extend(undecided(trials));
    doubts.extend(loose(reduction));
    let rubbing = case.joint_laws.values().any(|law| law.friction_deg > 0.0);
    if !rubbing && !case.joint_laws.is_empty() {
        doubts.push("no joint has friction: the factor is one on cohesion and tensile strength alone".to_owned());
    }
    let worst = trials.iter().map(|t| t.ledger_residual.abs()).fold(0.0, f64::max);
    if worst > RESIDUAL {
        doubts.push(format!(
            "the energy ledger of a trial is open by {worst:.1e} of its largest term (limit {RESIDUAL})"
        ));
    }
    doubts
}

fn not_monotone(trials: &[Trial]) -> Option<String> {
    let of = |stable: bool| trials.iter().filter(move |t| (t.verdict == Verdict::Stable) == stable).map(|t| t.factor);
    let (stable, other) = (of(true).fold(0.0, f64::max), of(false).fold(f64::INFINITY, f64::min));
    (other < stable).then(|| {
        format!(
            "F = {stable:.4} was stable, but F = {other:.4} was not: the verdict is not monotone, look at both trials"
        )
    })
}

/// Blocks that slid off or fell in trials at which the slope is stable.
fn loose(reduction: &Reduction) -> Option<String> {
    let stable = reduction.trials.iter().filter(|t| t.verdict == Verdict::Stable);
    let first = stable.clone().find(|t| !t.loose.is_empty())?;
    let block =
        |b: &FailingBlock| format!("{} of {:.3} m² at ({:.3}, {:.3}) m", b.block, b.area, b.position.x, b.position.y);
    let named: Vec<String> = first.loose.iter().take(NAMED).map(block).collect();
    let blocks = if first.loose.len() == 1 { "block" } else { "blocks" };
    Some(format!(
        "from F = {:.4} on {blocks} {} slid off or fell; they have less than a thousandth of the free mass, and do not \
         count as a failure of the slope",
        first.factor,
        named.join(", ")
    ))
}

/// Trials whose time was over before motion had died or grown.
fn undecided(trials: &[Trial]) -> Option<String> {
    let trend = trials.iter().filter(|t| t.reason == Reason::Trend);
    let told: Vec<String> = trend.map(|t| format!("{:.4} ({})", t.factor, t.verdict.name())).collect();
    let trials = if told.len() == 1 { "trial F =" } else { "trials F =" };
    (!told.is_empty()).then(|| format!("judged by their trend when their time was over: {trials} {}", told.join(", ")))
}

/// Trials in which blocks slid and stopped, and how that counts.
fn slid(trials: &[Trial], counts: impl Fn(&&Trial) -> bool, fate: &str) -> Option<String> {
    let slid: Vec<&Trial> = trials.iter().filter(counts).collect();
    let (first, last) = (slid.first()?, slid.last()?);
    let far = slid.iter().map(|t| t.displacement).fold(0.0, f64::max);
    let range = if slid.len() == 1 {
        format!("F = {:.4}", first.factor)
    } else {
        format!("F = {:.4} to {:.4}", first.factor, last.factor)
    };
    Some(format!(
        "at {range} joints slipped or rock flowed by up to {far:.3} m, farther than elasticity explains, and {fate}"
    ))
}
