//! Warnings of a run that take a look at what holds the slope.

use enmm::model::case::StageKind;
use enmm_stability::corners::{CarryingCorner, carrying_corners};
use enmm_stability::strength_reduction::slide;

use super::{Driver, RunError};

impl Driver<'_> {
    /// Warns of slips of a static stage that elasticity does not explain.
    pub(super) fn warn_of_slide(&mut self) -> Result<(), RunError> {
        if !self.has_only_settled() {
            return Ok(());
        }
        let Some(slip) = slide(&self.simulation) else { return Ok(()) };
        let name = &self.simulation.stage().name;
        self.warn(format!(
            "stage {name:?} is at rest after joints have slipped by up to {slip:.3} m, farther than elasticity \
             explains: rock slid until other rock stopped it; `enmm fos` counts that as a failure"
        ))
    }

    /// Warns of corners that carry more than their rock can.
    pub(super) fn warn_of_corners(&mut self) -> Result<(), RunError> {
        let corners: Vec<String> = carrying_corners(&self.simulation).iter().map(CarryingCorner::text).collect();
        if corners.is_empty() {
            return Ok(());
        }
        let (name, corners) = (&self.simulation.stage().name, corners.join(", "));
        self.warn(format!(
            "stage {name:?}: {corners}, which is more than the rock bears there: `enmm fos` has the factor without \
             corners that meet rock ahead of them"
        ))
    }

    /// Whether this stage and all before it are static, so that every slip so far belongs to settling.
    fn has_only_settled(&self) -> bool {
        let mut stages = self.simulation.case().stages.iter().take(self.simulation.state().stage as usize + 1);
        stages.all(|stage| stage.kind == StageKind::Static)
    }

    fn warn(&mut self, text: String) -> Result<(), RunError> {
        self.recorder.warn(&self.simulation, text).map_err(RunError::Output)?;
        self.tell_warnings();
        Ok(())
    }

    /// Hands the warnings that have come together to the observer.
    pub(super) fn tell_warnings(&mut self) {
        let new = self.recorder.warnings.get(self.told..).unwrap_or_default();
        new.iter().for_each(|text| self.observer.warn(text));
        self.told = self.recorder.warnings.len();
    }
}
