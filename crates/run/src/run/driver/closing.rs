//! Records, checkpoints and the end of a run.

use std::io;

use crate::blocks::write_blocks;
use crate::input::input_record;
use crate::motion::FailureOfStage;
use crate::summary::{RunRecord, RunStatus, StageRecord, Summary, WallSeconds};
use crate::verdict::Verdict;
use enmm::model::StepError;
use enmm::model::case::StageKind;
use enmm::model::tables::Seconds;
use enmm_io::checkpoint;
use enmm_report::Note;

use super::progress::Saved;
use super::{CHECKPOINT, Driver, RunError, results};

impl Driver<'_> {
    pub(super) fn stage_record(&self, converged: Option<bool>) -> StageRecord {
        let (stage, state, progress) = (self.simulation.stage(), self.simulation.state(), &self.progress);
        let potential = progress.ledger.potential;
        let is_at_rest = stage.kind == StageKind::Dynamic || converged.unwrap_or(true);
        let began = self.began();
        StageRecord {
            name: stage.name.clone(),
            kind: stage.kind,
            start: state.stage_start,
            time: self.simulation.time() - state.stage_start,
            steps: state.stage_step,
            converged: converged.filter(|_| stage.kind == StageKind::Static),
            ended_early: false,
            displacement: self.simulation.farthest_since(began).map_or(0.0, |farthest| farthest.displacement),
            failure: self.simulation.failure_since(began, is_at_rest).map(FailureOfStage::from),
            wall_seconds: Some(self.stage_clock.elapsed().as_secs_f64()),
            unbalanced: progress.unbalanced,
            kinetic_energy: progress.ledger.kinetic,
            potential_released: progress.potential_start.unwrap_or(potential) - potential,
            unsettled: self.unsettled(),
            penetration_max: progress.penetration_max,
        }
    }

    fn wall(&self) -> WallSeconds {
        let parts: &Seconds = &self.simulation.workspace().seconds;
        WallSeconds::of(parts, self.clock.elapsed().as_secs_f64())
    }

    /// Writes the checkpoint of the state now.
    pub(super) fn save(&mut self) -> Result<(), RunError> {
        let mut progress = self.progress.clone();
        progress.done.iter_mut().for_each(|stage| stage.wall_seconds = None);
        let saved = Saved { state: self.simulation.state(), progress };
        let path = self.options.directory.join(CHECKPOINT);
        checkpoint::save(&path, &saved, &self.loaded.hash).map_err(RunError::Output)?;
        self.saved = true;
        Ok(())
    }

    /// Falls back to the last good state and closes.
    pub(super) fn fail(&mut self, error: &StepError) -> Result<Summary, RunError> {
        self.simulation.return_to(&self.good.state);
        self.progress = self.good.progress.clone();
        self.close(RunStatus::Failed, Some(error))
    }

    /// Writes what a run leaves at its end, the checkpoint first and the summary last.
    pub(super) fn close(&mut self, status: RunStatus, failure: Option<&StepError>) -> Result<Summary, RunError> {
        self.simulation.drop_buffers();
        self.save()?;
        self.history.check_place().map_err(RunError::Output)?;
        let directory = &self.options.directory;
        write_blocks(&directory.join("blocks.csv"), &self.simulation.block_states()).map_err(RunError::Output)?;
        if status != RunStatus::Interrupted {
            results::draw_end(&self.simulation, directory).map_err(RunError::Output)?;
        }
        let mut stages = self.progress.done.clone();
        if stages.len() <= self.simulation.state().stage as usize {
            stages.push(self.stage_record(None));
        }
        let ended = status == RunStatus::Finished;
        let doubt = self.simulation.doubt(&self.progress.ledger).filter(|_| ended);
        self.warnings.extend(doubt.clone());
        let verdict = Verdict::of(&stages, status);
        let time = self.simulation.time();
        let note = Note::Verdict { text: verdict.text.clone(), failed: verdict.failed };
        self.film.note(time, &note).map_err(RunError::Output)?;
        self.close_film(status, failure, doubt.as_ref()).map_err(RunError::Output)?;
        let record = RunRecord {
            case_file: self.loaded.source.file(),
            case_hash: &self.loaded.hash,
            settings: &self.loaded.settings,
            status,
            failure,
            stages,
            permanent: self.progress.permanent.clone(),
            failed: verdict.failed,
            verdict: verdict.text,
            ledger: &self.progress.ledger,
            wall: self.wall(),
            warnings: std::mem::take(&mut self.warnings),
            input: input_record(self.loaded),
            doubt,
        };
        let summary = Summary::new(&self.simulation, record);
        summary.write(&directory.join("summary.json")).map_err(RunError::Output)?;
        Ok(summary)
    }

    /// Writes the page of the run.
    fn close_film(&mut self, status: RunStatus, failure: Option<&StepError>, doubt: Option<&String>) -> io::Result<()> {
        let time = self.simulation.time();
        if let Some(doubt) = doubt {
            self.film.note(time, &Note::Warning { text: doubt.clone() })?;
        }
        let status = match (status, failure) {
            (RunStatus::Finished, _) => "finished".to_owned(),
            (RunStatus::Interrupted, _) => "interrupted".to_owned(),
            (RunStatus::Failed, failure) => {
                failure.map_or_else(|| "failed".to_owned(), |error| format!("failed: {error}"))
            }
        };
        self.film.close(time, status)
    }
}
