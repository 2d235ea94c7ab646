//! Cuts of stages: the model is built again with them, and the state is carried over.
//!
//! A model is a pure function of the case and of the cuts so far, so that a run, a resumed run and a state that a host
//! goes back to have the same one. All are built before the run begins.

use std::sync::Arc;

use crate::recut::Lineage;
use crate::state::State;

use super::assemble::{BuildStage, Built, Cut, Integrators, build as build_once};
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
    let (built, state) = build_once(case, (&Cut::up_to(case, 0), None), integrators, tell)?;
    let mut grounds = vec![Ground { built: Arc::new(built), lineage: None }];
    let (mut notes, mut warnings) = (Vec::new(), Vec::new());
    for (k, stage) in case.stages.iter().enumerate().skip(1) {
        let before = grounds[k - 1].built.clone();
        grounds.push(if stage.cuts.is_empty() {
            Ground { built: before, lineage: None }
        } else {
            let (mut built, _) =
                build_once(case, (&Cut::up_to(case, k), Some(&before.model.boundary)), integrators, tell)?;
            let refused = |message| Invalid { key: format!("stage[{k}].cut"), message };
            let lineage = lineage(&before, &built).map_err(refused)?;
            built.model.labels = lineage.labels(&before.model, &built.model);
            notes.extend(new_in(&stage.name, &built.notes, &before.notes));
            warnings.extend(new_in(&stage.name, &built.warnings, &before.warnings));
            Ground { built: Arc::new(built), lineage: Some(Arc::new(lineage)) }
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
