//! Nudges of a slope that fails by turning: without dilation its rest depends on the path (theory, section 16).

use enmm::geometry::Vector;
use enmm::model::{Mechanism, Simulation};

use super::bracket::Search;
use super::series::{Series, Trials};
use super::setting::{Geometry, Setting};
use super::slip::height_and_gravity;
use super::trial::{Base, Ended, Outcome};
use super::{FailingBlock, Reason, Trial, Verdict};

/// Acceleration of a nudge over that of gravity.
const NUDGE: f64 = 0.01;
/// Nudges of a trial.
const NUDGES: usize = 3;
/// First step down where a nudge makes the slope fail: nudges lower a factor by 0 to 3.5 %.
const STEP_DOWN: f64 = 1.01;

/// Elements over the width of a block that turns from which its factor hardly depends on the mesh.
const ELEMENTS: f64 = 3.0;
/// The same where rock yields.
const ELEMENTS_YIELDING: f64 = 6.0;

/// Nudges the greatest stable trial where the blocks that fail turn, in the geometry as drawn, and goes down where it
/// fails. Returns the search with the bracket that nudges leave, and the factor before them.
pub fn nudge(trials: &mut Trials, mut series: Series, setting: &Setting, search: &Search) -> (Series, Option<f64>) {
    let are_blocks = setting.geometry == Geometry::Drawn;
    let Some(before) = series.factor().filter(|_| are_blocks && turns(mechanism(trials.base, &series))) else {
        return (series, None);
    };
    let outward = outward(series.trial(series.high));
    let (base, interrupt) = (trials.base, trials.interrupt);
    let nudged = |outcome: Outcome| -> Outcome {
        let (mut trial, mut ended) = outcome?;
        let (height, gravity) = height_and_gravity(&ended.simulation);
        let time = 2.0 * (height / gravity).sqrt();
        let push = Vector::new(outward * NUDGE * gravity, 0.0);
        for _ in 0..NUDGES {
            if trial.verdict != Verdict::Stable {
                break;
            }
            (trial, ended) = base.push((trial, ended.simulation), push, time, interrupt)?;
            trial.reason = if trial.verdict == Verdict::Stable { Reason::Rest } else { Reason::Nudge };
        }
        Ok((trial, ended))
    };
    let Some((top, resting)) = series.trial(series.low).cloned().zip(series.stable.take()) else {
        return (series, None);
    };
    let low = top.factor;
    let first = trials.one(&|| nudged(Ok((top.clone(), Ended { simulation: resting.clone(), begun: None }))));
    match first {
        Ok((trial, _)) if trial.verdict == Verdict::Stable => {
            series.stable = Some(resting);
            return (series, Some(before));
        }
        Ok((trial, ended)) => replace(&mut series, vec![trial], Some(ended)),
        Err(stop) => {
            series.end = stop;
            return (series, None);
        }
    }
    let mut down = search.again([low / STEP_DOWN; 2]);
    down.note(low, Verdict::Unstable);
    let rest = trials.rest(setting);
    let found = trials.series_of(down, &|factor| nudged(base.run(factor, setting, rest.as_deref(), interrupt)));
    let Series { trials, low, high, end, stable, unstable } = found;
    replace(&mut series, trials, unstable);
    // Trials above the bracket rested, but nobody has nudged them.
    series.trials.retain(|trial| trial.verdict != Verdict::Stable || Some(trial.factor) <= low);
    (Series { low, high, end, stable, ..series }, Some(before))
}

/// The way in which the least trial fails that was not stable.
pub fn mechanism(base: &Base, series: &Series) -> Option<Mechanism> {
    let (trial, ended) = series.trial(series.high).zip(series.unstable.as_ref())?;
    base.mechanism(&ended.simulation, &trial.failing)
}

/// Whether blocks turn that fail.
fn turns(mechanism: Option<Mechanism>) -> bool {
    matches!(mechanism, Some(Mechanism::Topples | Mechanism::Rotates))
}

/// Width (m) of a block: that of a rectangle of the same area and perimeter.
fn width(simulation: &Simulation, block: &FailingBlock) -> f64 {
    let boundary = &simulation.model().boundary;
    let own = simulation.block_labelled(block.block);
    let thickness = own.map_or(f64::INFINITY, |own| boundary.block_thickness[own]);
    let half = block.area / thickness;
    0.5 * (half - (half * half - 4.0 * block.area).max(0.0).sqrt())
}

/// A warning where blocks turn that have too few elements over their width.
pub fn coarse(base: &Base, series: &Series, mechanism: Option<Mechanism>) -> Option<String> {
    let simulation = series.unstable.as_ref().map_or(&base.simulation, |ended| &ended.simulation);
    let trial = series.trial(series.high).filter(|_| turns(mechanism))?;
    let wanted = if simulation.case().yields() { ELEMENTS_YIELDING } else { ELEMENTS };
    let size = simulation.model().covers.mesh.size;
    let moving = trial.failing.iter().filter(|block| block.displacement > 0.5 * trial.displacement);
    let narrow = moving.map(|block| width(simulation, block)).fold(f64::INFINITY, f64::min);
    (narrow < wanted * size).then(|| {
        format!(
            "blocks turn that are {:.1} elements wide ({narrow:.3} m, mesh {size:.3} m): their factor can be 5 % too \
             high below {wanted} elements; set mesh.size to {:.3} m",
            narrow / size,
            narrow / wanted
        )
    })
}

/// Which way along x blocks move that fail: the sign of their mean displacement.
fn outward(trial: Option<&Trial>) -> f64 {
    let way = trial.map_or(0.0, |trial| trial.failing.iter().map(|block| block.mass * block.way.x).sum());
    if way < 0.0 { -1.0 } else { 1.0 }
}

/// Puts trials in the place of those at the same factors.
fn replace(series: &mut Series, trials: Vec<Trial>, unstable: Option<Ended>) {
    series.trials.retain(|old| trials.iter().all(|new| new.factor != old.factor));
    series.trials.extend(trials);
    series.trials.sort_by(|a, b| a.factor.total_cmp(&b.factor));
    series.unstable = unstable.or_else(|| series.unstable.take());
}
