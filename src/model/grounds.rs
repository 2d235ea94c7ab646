//! Cuts of stages and sections that break: the model is built again with them, and the state is carried over.
//!
//! A model is a pure function of the case and of the cuts so far, so that a run, a resumed run and a state that a host
//! goes back to have the same one. Those of stages are built before the run begins.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use crate::recut::Lineage;
use crate::state::{self, Model, PortKind, State};

use super::Simulation;
use super::assemble::{BuildStage, Built, Cut, ExplicitAlone, Integrators, build as build_once};
use super::case::{Case, Invalid};

/// The model of a stage, and how it follows from that of the stage before; without a lineage it is the same.
#[derive(Debug, Clone)]
pub struct Ground {
    /// The model.
    pub built: Arc<Built>,
    /// Where its parts come from.
    pub lineage: Option<Arc<Lineage>>,
}

/// The models of all stages, and the state at the start of the first.
///
/// # Errors
/// The first key of the case that does not fit.
pub fn build(
    case: &Case,
    integrators: &dyn Integrators,
    tell: &mut dyn FnMut(BuildStage),
) -> Result<(Vec<Ground>, State), Invalid> {
    let (built, state) = build_once(case, (&Cut::up_to(case, 0, &[]), None), integrators, tell)?;
    let mut grounds = vec![Ground { built: Arc::new(built), lineage: None }];
    let (mut notes, mut warnings) = (Vec::new(), Vec::new());
    for (k, stage) in case.stages.iter().enumerate().skip(1) {
        let before = grounds[k - 1].built.clone();
        grounds.push(if stage.cuts.is_empty() {
            Ground { built: before, lineage: None }
        } else {
            let ground = after(case, &before, (k, &[]), integrators, tell)?;
            notes.extend(new_in(&stage.name, &ground.built.notes, &before.notes));
            warnings.extend(new_in(&stage.name, &ground.built.warnings, &before.warnings));
            ground
        });
    }
    if !notes.is_empty() || !warnings.is_empty() {
        // Those of the first are shown; the others have none left to take.
        change(&mut grounds, |built| {
            built.notes.append(&mut notes);
            built.warnings.append(&mut warnings);
        });
    }
    Ok((grounds, state))
}

/// The model of a stage in which sections of rock have broken, after the last of its cuts.
fn after(
    case: &Case,
    before: &Built,
    (stage, broken): (usize, &[state::Cut]),
    integrators: &dyn Integrators,
    tell: &mut dyn FnMut(BuildStage),
) -> Result<Ground, Invalid> {
    let cuts = Cut::up_to(case, stage, broken);
    let key = cuts.last().map_or_else(|| format!("stage[{stage}].cut"), |cut| cut.key.clone());
    let (mut built, _) = build_once(case, (&cuts, Some(&before.model.boundary)), integrators, tell)?;
    let lineage = lineage(before, &built).map_err(|message| Invalid { key, message })?;
    built.model.labels = lineage.labels(&before.model);
    keep_ports(&before.model, &mut built.model);
    built.model.detection = before.model.detection;
    Ok(Ground { built: Arc::new(built), lineage: Some(Arc::new(lineage)) })
}

/// Ports of blocks go on with the number that their block has had, which the part with the first of them keeps.
fn keep_ports(before: &Model, model: &mut Model) {
    let blocks: Vec<_> = before.ports.iter().map(|was| model.block_labelled(before.labels[was.block])).collect();
    for (port, block) in model.ports.iter_mut().zip(blocks).filter(|(port, _)| port.kind == PortKind::Block) {
        port.block = block.unwrap_or(port.block);
    }
}

/// Models of rock that has broken in the course of a run, which copies of a simulation share. The last ones are kept,
/// so that a return to an earlier state builds nothing.
#[derive(Debug, Clone, Default)]
pub struct Broken(Arc<Mutex<VecDeque<Kept>>>);

/// The model of a stage with the sections that have broken.
#[derive(Debug)]
struct Kept {
    stage: usize,
    cuts: Vec<state::Cut>,
    ground: Ground,
}

/// Models that are kept.
const KEPT: usize = 6;

impl Broken {
    fn find(&self, stage: usize, cuts: &[state::Cut]) -> Option<Ground> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter().find(|kept| kept.stage == stage && kept.cuts == cuts).map(|kept| kept.ground.clone())
    }

    fn keep(&self, stage: usize, cuts: &[state::Cut], ground: &Ground) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() == KEPT {
            kept.pop_front();
        }
        kept.push_back(Kept { stage, cuts: cuts.to_vec(), ground: ground.clone() });
    }
}

impl Simulation {
    /// The model of a stage in which sections of rock have broken: a pure function of the case and of both.
    ///
    /// # Errors
    /// A cut with which the model cannot be built or cannot follow from the one before.
    pub(super) fn ground(&self, stage: usize, cuts: &[state::Cut]) -> Result<Ground, Invalid> {
        let Some(last) = cuts.last() else { return Ok(self.grounds[stage].clone()) };
        if let Some(ground) = self.broken.find(stage, cuts) {
            return Ok(ground);
        }
        let is_broken_now = last.stage as usize == stage;
        let before = if is_broken_now {
            let earlier = cuts.iter().rposition(|cut| cut.step != last.step).map_or(0, |k| k + 1);
            self.ground(stage, &cuts[..earlier])?.built
        } else {
            self.ground(stage - 1, cuts)?.built
        };
        let ground = if !is_broken_now && self.case.stages[stage].cuts.is_empty() {
            Ground { built: before, lineage: None }
        } else {
            after(&self.case, &before, (stage, cuts), &ExplicitAlone, &mut |_| ())?
        };
        self.broken.keep(stage, cuts, &ground);
        Ok(ground)
    }
}

/// Notes or warnings of the model of a stage that the model before has not.
fn new_in<'a>(stage: &'a str, texts: &'a [String], before: &'a [String]) -> impl Iterator<Item = String> + 'a {
    let new = texts.iter().filter(|text| !before.contains(text));
    new.map(move |text| format!("from stage {stage:?} on: {text}"))
}

/// How a model with more cuts follows from one before, or why the cuts cannot be made in the middle of a run.
fn lineage(before: &Built, after: &Built) -> Result<Lineage, String> {
    let crumbs = after.crumbs.iter().filter(|crumb| before.crumbs.iter().all(|old| old.place != crumb.place));
    if let Some(crumb) = crumbs.min_by(|a, b| a.area.total_cmp(&b.area)) {
        return Err(format!(
            "parts off {:.2e} m² of rock at ({:.6}, {:.6}) m, less than mesh.least_block: lead the cut another way, or \
             lower that",
            crumb.area, crumb.place.x, crumb.place.y
        ));
    }
    Lineage::new(&before.model, &after.model, before.noding.tolerance)
}

/// Changes the models of all stages alike.
pub fn change(grounds: &mut [Ground], mut change: impl FnMut(&mut Built)) {
    for stage in 0..grounds.len() {
        if stage > 0 && grounds[stage].lineage.is_none() {
            grounds[stage].built = grounds[stage - 1].built.clone();
        } else {
            change(Arc::make_mut(&mut grounds[stage].built));
        }
    }
}
