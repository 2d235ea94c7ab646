//! Warnings of a run that need its results alone.

use enmm::model::case::keys::{Plain, rounded};
use std::io;

use enmm::model::case::{Integrator, StageKind};
use enmm::model::{Event, EventKind, Restless, Simulation};
use enmm_observe::flow_doubts;
use enmm_report::Note;

use crate::recorder::Recorder;

/// Blocks that a warning names.
const NAMED: usize = 3;
/// Least slip (m) that a warning gives, by its digits.
const SLIP_SHOWN: f64 = 5e-5;
/// Share of unsettled steps above which a stage is warned of: a few are usual where blocks strike each other.
const UNSETTLED_SHARE: f64 = 0.01;

impl Recorder {
    /// Warns of the first pairs of blocks that overlap, with the event of index `known` or a later one.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn warn_of_overlaps(&mut self, simulation: &Simulation, known: usize) -> io::Result<()> {
        let is_overlap = |event: &&Event| event.kind == EventKind::Overlapped;
        let events = &simulation.state().events;
        let new: Vec<Event> = events.list.iter().skip(known).filter(is_overlap).copied().collect();
        let room = (NAMED + new.len()).saturating_sub(events.overlapped.len());
        new.iter().take(room).try_for_each(|event| self.warn(simulation, overlap_text(simulation, event)))
    }

    /// Warns of a static stage that has run away.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn warn_of_early_end(&mut self, simulation: &Simulation) -> io::Result<()> {
        let (stage, limit) = (simulation.stage(), simulation.model().failure_displacement);
        let (name, duration) = (&stage.name, stage.duration);
        let time = simulation.time() - simulation.state().stage_start;
        let text = format!(
            "stage {name:?} ended early, after {} s of at most {} s: rock has moved by more than {} m and becomes no \
             slower, so that it will not come to rest; raise solver.failure_displacement to follow it farther",
            rounded(time),
            Plain(duration),
            Plain(limit)
        );
        self.warn(simulation, text)
    }

    /// Warns of what a stage that is over has brought.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn warn_of_stage(&mut self, simulation: &Simulation, converged: bool, restless: &[Restless]) -> io::Result<()> {
        self.warn_of_unsettled(simulation)?;
        self.warn_of_shaking(simulation)?;
        self.warn_of_barred(simulation)?;
        self.warn_of_water(simulation)?;
        let stage = simulation.stage();
        let name = &stage.name;
        if stage.kind == StageKind::Static && converged && !restless.is_empty() {
            let text = format!("stage {name:?} is at rest but for {}, which cannot rest", named(restless));
            self.warn(simulation, text)?;
        }
        if stage.kind == StageKind::Static && !converged {
            let (time, ratio) = (stage.duration, self.progress.reports.unbalanced);
            let text = format!(
                "stage {name:?} did not come to rest within its duration of {} s (unbalanced ratio {ratio:.2e}); \
                 fastest: {}",
                Plain(time),
                named(&simulation.moving())
            );
            self.warn(simulation, text)?;
        }
        Ok(())
    }

    /// Warns of blocks that would have broken where they could not be cut.
    fn warn_of_barred(&mut self, simulation: &Simulation) -> io::Result<()> {
        let (model, state) = (simulation.model(), simulation.state());
        let barred = model.labels.iter().zip(&state.worst_sections).filter(|(_, worst)| worst.barred);
        let blocks: Vec<String> = barred.map(|(label, _)| label.to_string()).collect();
        if blocks.is_empty() {
            return Ok(());
        }
        let name = &simulation.stage().name;
        let text = format!(
            "in stage {name:?} {} {} reached the strength of the rock where no cut can be made, as at a support, and \
             {} held: refine mesh.size or move the support",
            if blocks.len() == 1 { "block" } else { "blocks" },
            blocks.join(", "),
            if blocks.len() == 1 { "was" } else { "were" },
        );
        self.warn(simulation, text)
    }

    /// Warns of a stage in which contacts often end a step with other forces than their joint laws give.
    fn warn_of_unsettled(&mut self, simulation: &Simulation) -> io::Result<()> {
        let (steps, unsettled) = (simulation.state().stage_step, self.unsettled(simulation));
        if unsettled as f64 <= UNSETTLED_SHARE * steps as f64 {
            return Ok(());
        }
        let (name, solver) = (&simulation.stage().name, &simulation.case().solver);
        let (most, step) = match solver.integrator {
            Integrator::Explicit => (format!("{} sweeps (solver.sweeps_max)", solver.sweeps_max), "dt_max"),
            Integrator::Implicit => {
                (format!("{} iterations (solver.iterations_max)", solver.iterations_max), "implicit_step")
            }
        };
        let text = format!(
            "stage {name:?}: the open–close iteration did not settle within {most} in {unsettled} sub-steps of {steps} \
             steps, so that joints may slip or open falsely; compare with a run of shorter steps (solver.{step})"
        );
        self.warn(simulation, text)
    }

    /// Warns of pumps that run dry, of drains that give water, of joints that drain longer than their stage, of
    /// apertures and openings that disagree, of joints that have parted, and of flow in joints that is in doubt.
    fn warn_of_water(&mut self, simulation: &Simulation) -> io::Result<()> {
        let name = &simulation.stage().name;
        let mut doubts = simulation.dry_drains();
        doubts.extend(simulation.unfinished_drainage());
        doubts.extend(simulation.unsettled_apertures());
        doubts.extend(simulation.parted_joints());
        if simulation.stage().kind == StageKind::Static {
            doubts.extend(flow_doubts(simulation));
        }
        let texts: Vec<String> = doubts.into_iter().map(|doubt| format!("stage {name:?}: {doubt}")).collect();
        texts.into_iter().try_for_each(|text| self.warn(simulation, text))
    }

    /// Warns of joints that have slipped when the ground has shaken: their slip depends on the mesh.
    fn warn_of_shaking(&mut self, simulation: &Simulation) -> io::Result<()> {
        let (case, stage) = (simulation.case(), simulation.stage());
        if !case.is_shaken(simulation.state().stage as usize) {
            return Ok(());
        }
        let joints = self.joints.now(simulation);
        let slip = joints.iter().filter(|piece| piece.is_joint).map(|piece| piece.slip.abs()).fold(0.0, f64::max);
        if slip < SLIP_SHOWN {
            return Ok(());
        }
        let (name, half) = (&stage.name, 0.5 * case.mesh.size);
        let text = format!(
            "stage {name:?}: joints have slipped by up to {slip:.4} m; how far a shaken slope slips depends on the \
             mesh, slips of millimetres by several times: compare with a run on half the mesh size (--set \
             mesh.size={half})"
        );
        self.warn(simulation, text)
    }

    /// Keeps a warning, and notes it in the film.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn warn(&mut self, simulation: &Simulation, text: String) -> io::Result<()> {
        self.film.note(simulation.time(), &Note::Warning { text: text.clone() })?;
        self.warnings.push(text);
        Ok(())
    }
}

fn overlap_text(simulation: &Simulation, event: &Event) -> String {
    let block = simulation.block_labelled(event.subject).unwrap_or_default();
    let place = simulation.motion_of(block).centroid;
    format!(
        "{} near ({:.3}, {:.3}) m at t = {} s: results about them are wrong from here on; where their joint is \
         soft, raise its normal_stiffness",
        event.overlap_text(simulation.model().covers.mesh.size),
        place.x,
        place.y,
        rounded(event.time)
    )
}

/// The first of these blocks in words.
fn named(blocks: &[Restless]) -> String {
    let more = blocks.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let named: Vec<String> = blocks.iter().take(NAMED).map(Restless::to_string).collect();
    named.join("; ") + &more
}
