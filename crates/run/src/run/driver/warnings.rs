//! Warnings of a run.

use enmm::model::case::{Integrator, StageKind};
use enmm::model::tables::BlockId;
use enmm::model::{Event, EventKind, Restless, Simulation};
use enmm_report::Note;
use enmm_stability::corners::{CarryingCorner, carrying_corners};
use enmm_stability::strength_reduction::slide;

use super::{Driver, RunError};

/// Blocks that a warning names.
const NAMED: usize = 3;
/// Least slip (m) that a warning gives, by its digits.
const SLIP_SHOWN: f64 = 5e-5;
/// Share of unsettled steps above which a stage is warned of: a few are usual where blocks strike each other.
const UNSETTLED_SHARE: f64 = 0.01;

impl Driver<'_> {
    /// Warns of the first pairs of blocks that overlap, with the event of index `known` or a later one.
    pub(super) fn warn_of_overlaps(&mut self, known: usize) -> Result<(), RunError> {
        let is_overlap = |event: &&Event| event.kind == EventKind::Overlapped;
        let events = &self.simulation.state().events;
        let new: Vec<Event> = events.list[known..].iter().filter(is_overlap).copied().collect();
        let room = (NAMED + new.len()).saturating_sub(events.overlapped.len());
        new.iter().take(room).try_for_each(|event| self.warn(overlap_text(&self.simulation, event)))
    }

    /// Warns of a static stage that has run away.
    pub(super) fn warn_of_early_end(&mut self) -> Result<(), RunError> {
        let (stage, limit) = (self.simulation.stage(), self.simulation.model().failure_displacement);
        let (name, duration) = (&stage.name, stage.duration);
        let time = self.simulation.time() - self.simulation.state().stage_start;
        self.warn(format!(
            "stage {name:?} ended early, after {time:.4} s of at most {duration} s: rock has moved by more than \
             {limit} m and becomes no slower, so that it will not come to rest; raise solver.failure_displacement to \
             follow it farther"
        ))
    }

    pub(super) fn warn_of_stage(&mut self, converged: bool, restless: &[Restless]) -> Result<(), RunError> {
        self.warn_of_unsettled()?;
        self.warn_of_shaking()?;
        let stage = self.simulation.stage();
        if stage.kind == StageKind::Static && converged && !restless.is_empty() {
            let name = &stage.name;
            self.warn(format!("stage {name:?} is at rest but for {}, which cannot rest", named(restless)))?;
        }
        let stage = self.simulation.stage();
        if stage.kind == StageKind::Static && !converged {
            let (name, time, ratio) = (&stage.name, stage.duration, self.progress.unbalanced);
            self.warn(format!(
                "stage {name:?} did not come to rest within its duration of {time} s (unbalanced ratio {ratio:.2e}); \
                 fastest: {}",
                named(&self.simulation.moving())
            ))?;
        } else if self.has_only_settled()
            && let Some(slip) = slide(&self.simulation)
        {
            let name = &stage.name;
            self.warn(format!(
                "stage {name:?} is at rest after joints have slipped by up to {slip:.3} m, farther than elasticity \
                 explains: rock slid until other rock stopped it; `enmm fos` counts that as a failure"
            ))?;
        }
        Ok(())
    }

    /// Warns of a stage in which contacts often end a step with other forces than their joint laws give.
    fn warn_of_unsettled(&mut self) -> Result<(), RunError> {
        let (steps, unsettled) = (self.simulation.state().stage_step, self.unsettled());
        if unsettled as f64 <= UNSETTLED_SHARE * steps as f64 {
            return Ok(());
        }
        let (name, solver) = (&self.simulation.stage().name, &self.simulation.case().solver);
        let (most, step) = match solver.integrator {
            Integrator::Explicit => (format!("{} sweeps (solver.sweeps_max)", solver.sweeps_max), "dt_max"),
            Integrator::Implicit => {
                (format!("{} iterations (solver.iterations_max)", solver.iterations_max), "implicit_step")
            }
        };
        self.warn(format!(
            "stage {name:?}: the open–close iteration did not settle within {most} in {unsettled} sub-steps of {steps} \
             steps, so that joints may slip or open falsely; compare with a run of shorter steps (solver.{step})"
        ))
    }

    /// Warns of joints that have slipped when the ground has shaken: their slip depends on the mesh.
    fn warn_of_shaking(&mut self) -> Result<(), RunError> {
        let (case, stage) = (self.simulation.case(), self.simulation.stage());
        if !case.is_shaken(self.simulation.state().stage as usize) {
            return Ok(());
        }
        let joints = self.joints.now(&self.simulation);
        let slip = joints.iter().filter(|piece| piece.is_joint).map(|piece| piece.slip.abs()).fold(0.0, f64::max);
        if slip < SLIP_SHOWN {
            return Ok(());
        }
        let (name, half) = (&stage.name, 0.5 * case.mesh.size);
        self.warn(format!(
            "stage {name:?}: joints have slipped by up to {slip:.4} m; how far a shaken slope slips depends on the \
             mesh, slips of millimetres by several times: compare with a run on half the mesh size (--set \
             mesh.size={half})"
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

    /// Sub-steps of the stage that ended unsettled.
    pub(super) fn unsettled(&self) -> u64 {
        self.simulation.state().counters.unsettled - self.progress.unsettled_before
    }

    /// Whether this stage and all before it are static, so that every slip so far belongs to settling.
    fn has_only_settled(&self) -> bool {
        let mut stages = self.simulation.case().stages.iter().take(self.simulation.state().stage as usize + 1);
        stages.all(|stage| stage.kind == StageKind::Static)
    }

    fn warn(&mut self, message: String) -> Result<(), RunError> {
        self.observer.warn(&message);
        let note = Note::Warning { text: message.clone() };
        self.warnings.push(message);
        self.film.note(self.simulation.time(), &note).map_err(RunError::Output)
    }
}

fn overlap_text(simulation: &Simulation, event: &Event) -> String {
    let place = simulation.motion_of(BlockId::new(event.subject as usize)).centroid;
    format!(
        "{} near ({:.3}, {:.3}) m at t = {:.4} s: results about them are wrong from here on; where their joint is \
         soft, raise its normal_stiffness",
        event.overlap_text(simulation.model().covers.mesh.size),
        place.x,
        place.y,
        event.time
    )
}

/// The first of these blocks in words.
fn named(blocks: &[Restless]) -> String {
    let more = blocks.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let named: Vec<String> = blocks.iter().take(NAMED).map(Restless::to_string).collect();
    named.join("; ") + &more
}
