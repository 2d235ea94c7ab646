//! One way to fail after the other: the next is looked for when the blocks of the last have gone.

use enmm::model::Simulation;
use enmm::model::case::{Case, FlowTime, Stage, StageFlow, StageKind};

use super::{End, FailingBlock, Progress, Reduction, ReductionError, ReductionOptions, Trial, factor_of_safety};

/// Time (s) in which no water flows.
const NO_TIME: f64 = 1e-6;
/// Share of the free rock below which failing blocks are a chip and no failure of the slope.
pub const CHIP: f64 = 0.015;

/// Which ways to fail to look for.
#[derive(Debug, Clone, Copy)]
pub struct MechanismOptions {
    /// Area (m²) of failing blocks below which a way to fail is passed over; that of a chip when none is given.
    pub least_area: Option<f64>,
    /// How many of the others to find.
    pub count: usize,
}

impl Default for MechanismOptions {
    fn default() -> Self {
        Self { least_area: None, count: 1 }
    }
}

impl MechanismOptions {
    /// Area (m²) of failing blocks from which on a way to fail counts.
    pub fn least(&self, reduction: &Reduction) -> f64 {
        self.least_area.unwrap_or(CHIP * reduction.free_area)
    }

    /// Whether a way to fail counts: blocks of at least the least area, or no blocks at all.
    pub fn counts(&self, reduction: &Reduction) -> bool {
        reduction.first_unstable().is_none_or(|trial| trial.failing_area() >= self.least(reduction))
    }
}

/// Finds the factors of safety of one mechanism after the other; each search begins without the blocks that failed in
/// those before, as if they had fallen and been cleared away.
///
/// # Errors
/// A case that cannot be built, has no static stage or does not come to rest; not for the later ones, whose list ends.
pub fn mechanisms(
    case: &Case,
    which: MechanismOptions,
    options: &ReductionOptions,
    hear: &mut (dyn FnMut(&Trial, Progress) + Send),
) -> Result<Vec<Reduction>, ReductionError> {
    let mut found = vec![factor_of_safety(case, options, hear)?];
    let mut case = case.clone();
    while let Some(last) = found.last().filter(|last| goes_on(&found, last, which)) {
        if !last.simulation.cuts().is_empty() {
            let message = "no further mechanism is looked for: parts of blocks that have broken cannot be cleared away";
            found.last_mut().into_iter().for_each(|last| last.warnings.push(message.to_owned()));
            break;
        }
        let failing = last.first_unstable().map_or(&[][..], |trial| &trial.failing);
        let statics = case.stages.iter().take_while(|stage| stage.kind == StageKind::Static).count();
        let cleared = without(&case.stages[..statics], &last.simulation, failing);
        case.stages.insert(statics, cleared);
        match factor_of_safety(&case, options, hear) {
            Ok(reduction) => found.push(reduction),
            Err(ReductionError::Interrupted) => break,
            Err(error) => {
                let message = format!("no further mechanism was found: without the blocks that fail, {error}");
                found.last_mut().into_iter().for_each(|last| last.warnings.push(message.clone()));
                break;
            }
        }
    }
    Ok(found)
}

/// Whether another search follows the last: it found blocks to clear away, and fewer ways to fail count than wanted.
fn goes_on(found: &[Reduction], last: &Reduction, which: MechanismOptions) -> bool {
    let counted = found.iter().filter(|reduction| which.counts(reduction)).count();
    let fails = last.first_unstable().is_some_and(|trial| !trial.failing.is_empty());
    fails
        && match last.end {
            End::Found => counted < which.count,
            End::UnstableThroughout => !which.counts(last),
            _ => false,
        }
}

/// A static stage after those that there are, as long as the last, in which blocks are cleared away.
fn without(stages: &[Stage], simulation: &Simulation, failing: &[FailingBlock]) -> Stage {
    let last = &stages[stages.len() - 1];
    let blocks = failing.iter().filter_map(|block| simulation.block_labelled(block.block));
    Stage {
        convergence: last.convergence,
        excavate: blocks.map(|block| simulation.model().covers.point_inside(block).into()).collect(),
        // Water that has had its time before gets none to follow.
        flow: last.flow_time().map(|_| StageFlow::Over(FlowTime { time: NO_TIME, steps: 1 })),
        ..Stage::plain(stages, "cleared", StageKind::Static, last.duration)
    }
}
