//! The loop over stages and steps, with outputs at their times.

mod warnings;

use enmm::model::case::keys::rounded;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use crate::check::count_of_notes;
use enmm::model::case::{Invalid, StageKind};
use enmm::model::{Restless, Simulation, StepError, StepReport, settle};
use enmm_io::LoadedCase;
use enmm_record::results::{self, Past};
use enmm_record::summary::{RunStatus, StageRecord, Summary};
use enmm_record::{CHECKPOINT, Closing, Folder, Progress, Recorder, Saved, Setting, load_checkpoint};

use super::concurrency::Concurrency;
use super::outlook::Outlook;
use super::{Observer, RunError, RunOptions, RunProgress};

/// Most steps between two copies of the state to which a failed run falls back.
const GOOD_STEPS: u64 = 200;

/// How a stage ended.
enum StageEnd {
    Over,
    /// A static stage whose slope has run away, with the report of its last step.
    RanAway(Box<StepReport>),
    Interrupted,
    Failed(StepError),
}

/// Early end of a stage.
type Halt = Result<StageEnd, RunError>;

struct Driver<'a> {
    loaded: &'a LoadedCase,
    options: &'a RunOptions<'a>,
    observer: &'a mut dyn Observer,
    simulation: Simulation,
    concurrency: Concurrency,
    recorder: Recorder,
    outlook: Outlook,
    good: Saved,
    /// Warnings of the recorder that the observer has heard.
    told: usize,
    /// Whether a checkpoint of this run is in its folder.
    saved: bool,
}

/// Runs all stages; see [`super::run`].
pub fn run(loaded: &LoadedCase, options: &RunOptions, observer: &mut dyn Observer) -> Result<Summary, RunError> {
    let clock = Instant::now();
    let _held = Folder::open(&options.directory, &inputs(loaded, options)).map_err(RunError::Directory)?;
    let invalid = |invalid: Invalid| RunError::Case(loaded.source.locate(&invalid.key, &invalid.message));
    let mut simulation =
        enmm_implicit::build(loaded.case.clone(), &mut |stage| observer.build(stage)).map_err(invalid)?;
    simulation.validate_stages().map_err(invalid)?;
    let load = |path: &PathBuf| {
        load_checkpoint(path, &simulation, &loaded.hash)
            .map_err(|error| RunError::Checkpoint { path: path.clone(), error })
    };
    let saved = options.resume.as_ref().map(load).transpose()?;
    let mut driver = Driver::open(loaded, options, observer, simulation, saved, clock)?;
    driver.run(invalid).map_err(|error| match error {
        RunError::Output(error) if driver.saved && options.directory.join(CHECKPOINT).is_file() => {
            RunError::OutputAfter { error, checkpoint: options.directory.join(CHECKPOINT) }
        }
        other => other,
    })
}

/// Files that are read: a checkpoint of the folder itself is replaced by later ones.
fn inputs(loaded: &LoadedCase, options: &RunOptions) -> Vec<PathBuf> {
    let own = options.directory.join(CHECKPOINT).canonicalize().ok();
    let is_foreign = |path: &&PathBuf| path.canonicalize().ok() != own;
    loaded.source.inputs().iter().chain(options.resume.iter().filter(is_foreign)).cloned().collect()
}

impl<'a> Driver<'a> {
    /// Opens or continues the results; the first thing that writes.
    fn open(
        loaded: &'a LoadedCase,
        options: &'a RunOptions<'a>,
        observer: &'a mut dyn Observer,
        mut simulation: Simulation,
        saved: Option<(Saved, bool)>,
        clock: Instant,
    ) -> Result<Self, RunError> {
        let directory = &options.directory;
        let used = results::has_run(directory);
        let past = options.resume.as_deref().map(|checkpoint| results::bring_past(checkpoint, directory));
        let past = past.transpose().map_err(RunError::Directory)?;
        if used && past != Some(Past::Here) {
            observer.warn(&format!("the results of an earlier run in {} are overwritten", directory.display()));
        }
        results::draw_model(&simulation, directory).map_err(RunError::Directory)?;
        let resumed = saved.is_some();
        let of_host = saved.as_ref().is_some_and(|(_, of_run)| !of_run);
        let good =
            saved.map_or_else(|| Saved { state: simulation.state().clone(), progress: Progress::default() }, |s| s.0);
        if resumed {
            simulation.return_to(&good.state);
        }
        let mut warnings: Vec<String> = loaded.warnings.iter().chain(&simulation.built().warnings).cloned().collect();
        warnings.extend(past.and_then(|past| lost_past(past, &simulation, directory)));
        warnings.extend(of_host.then(|| unseen_past(&simulation)));
        warnings.iter().for_each(|warning| observer.warn(warning));
        count_of_notes(simulation.built().notes.len()).iter().for_each(|note| observer.note(note));
        let past = resumed.then(|| good.progress.clone());
        let told = warnings.len();
        let setting = Setting { loaded, directory, command: "run", past, warnings, clock };
        let recorder = Recorder::open(setting, &simulation).map_err(RunError::Directory)?;
        let mut driver = Self {
            loaded,
            options,
            observer,
            simulation,
            concurrency: Concurrency::new(options.threads),
            recorder,
            outlook: Outlook::default(),
            good,
            told,
            saved: false,
        };
        if !resumed {
            driver.recorder.begin_stage(&driver.simulation).map_err(RunError::Directory)?;
        }
        Ok(driver)
    }

    /// Runs all stages that are left.
    fn run(&mut self, invalid: impl Fn(Invalid) -> RunError) -> Result<Summary, RunError> {
        loop {
            match self.run_stage()? {
                StageEnd::Over | StageEnd::RanAway(_) => {}
                StageEnd::Interrupted => return self.close(RunStatus::Interrupted, None),
                StageEnd::Failed(error) => return self.fail(&error),
            }
            if !self.simulation.next_stage().map_err(&invalid)? {
                return self.close(RunStatus::Finished, None);
            }
            self.recorder.begin_stage(&self.simulation).map_err(RunError::Output)?;
        }
    }

    /// Runs the stage in progress to its end, unless a checkpoint says that it is over.
    fn run_stage(&mut self) -> Result<StageEnd, RunError> {
        let recorded = self.recorder.progress.done.len() > self.simulation.state().stage as usize;
        if recorded {
            return self.end_stage(None, recorded, false);
        }
        match settle::until_over(self, |driver| &driver.simulation, Self::pass) {
            Ok(last) => self.end_stage(last, recorded, false),
            Err(Ok(StageEnd::RanAway(last))) => self.end_stage(Some(*last), recorded, true),
            Err(halt) => halt,
        }
    }

    /// Outputs that are due at the start of a step, and the step.
    fn pass(&mut self) -> Result<Option<StepReport>, Halt> {
        if self.options.interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            return Err(Ok(StageEnd::Interrupted));
        }
        let step = self.simulation.state().stage_step;
        if self.recorder.plan().checkpoint_due(step) {
            self.save().map_err(Err)?;
        }
        if self.recorder.frame_due(step) {
            self.simulation.drop_buffers();
            self.recorder.push_frame(&self.simulation).map_err(unwritten)?;
        }
        if self.recorder.plan().film_due(step) {
            self.recorder.push_film(&self.simulation).map_err(unwritten)?;
        }
        self.tell();
        self.step()
    }

    /// One step, with a report and a row when they are due.
    fn step(&mut self) -> Result<Option<StepReport>, Halt> {
        let step = self.simulation.state().stage_step;
        let row = self.recorder.plan().row_due(step);
        if row || step.is_multiple_of(GOOD_STEPS) {
            self.keep_good();
        }
        if row {
            self.recorder.before_row(&self.simulation);
        }
        let rest_due = self.simulation.rest_due();
        let wanted = step == 0 || row || rest_due;
        let known = self.simulation.state().events.list.len();
        let made = self.concurrency.advance(&mut self.simulation, wanted);
        let report = made.map_err(|error| Ok(StageEnd::Failed(error)))?;
        self.recorder.follow_breaks(&self.simulation);
        self.recorder.warn_of_overlaps(&self.simulation, known).map_err(unwritten)?;
        self.tell_warnings();
        if !wanted {
            return Ok(None);
        }
        self.outlook.note(&self.simulation, &report);
        self.recorder.after_step(&self.simulation, &report).map_err(unwritten)?;
        if step.is_multiple_of(settle::RUNAWAY_STEPS) && self.simulation.has_run_away() {
            return Err(Ok(StageEnd::RanAway(Box::new(report))));
        }
        Ok(rest_due.then_some(report))
    }

    /// Row and frame of the end of a stage, and its record; the step that the row needs is taken back.
    fn end_stage(&mut self, last: Option<StepReport>, recorded: bool, ended_early: bool) -> Result<StageEnd, RunError> {
        // Before the outputs, which give back the buffers with the contacts.
        let was_at_rest = last.is_some_and(|report| self.simulation.at_rest(&report));
        let restless = last.map_or_else(Vec::new, |report| self.simulation.restless(&report));
        self.keep_good();
        let at_rest = self.recorder.show_end(&mut self.simulation, &self.good.state).map_err(RunError::Output)?;
        if !recorded {
            self.record_stage(was_at_rest || at_rest, ended_early, &restless)?;
        }
        Ok(StageEnd::Over)
    }

    /// Warns of what a stage has brought and records it. A slope that has failed in a static stage is saved at once.
    fn record_stage(&mut self, converged: bool, ended_early: bool, restless: &[Restless]) -> Result<(), RunError> {
        let simulation = &self.simulation;
        let record = StageRecord { ended_early, ..self.recorder.stage_record(simulation, Some(converged)) };
        let is_static = record.kind == StageKind::Static;
        let warned = match ended_early {
            true => self.recorder.warn_of_early_end(simulation),
            false => self.recorder.warn_of_stage(simulation, converged, restless),
        };
        warned.map_err(RunError::Output)?;
        self.tell_warnings();
        if !ended_early && converged {
            self.warn_of_slide()?;
        }
        if is_static {
            self.warn_of_corners()?;
            self.outlook.end(self.simulation.time() - self.simulation.state().stage_start);
        }
        let is_lost = is_static && record.failure.is_some();
        self.recorder.keep_record(&self.simulation, record).map_err(RunError::Output)?;
        if is_lost { self.save() } else { Ok(()) }
    }

    /// Writes the checkpoint of the state now.
    fn save(&mut self) -> Result<(), RunError> {
        self.recorder.save(self.simulation.state(), &self.loaded.hash).map_err(RunError::Output)?;
        self.saved = true;
        Ok(())
    }

    /// Falls back to the last good state and closes.
    fn fail(&mut self, error: &StepError) -> Result<Summary, RunError> {
        self.simulation.return_to(&self.good.state);
        self.recorder.progress = self.good.progress.clone();
        self.recorder.follow_breaks(&self.simulation);
        self.close(RunStatus::Failed, Some(error))
    }

    /// Writes what a run leaves at its end, the checkpoint first and the summary last.
    fn close(&mut self, status: RunStatus, failure: Option<&StepError>) -> Result<Summary, RunError> {
        self.simulation.drop_buffers();
        self.save()?;
        let closing = Closing { loaded: self.loaded, status, failure, coupled: None };
        self.recorder.close(&self.simulation, closing).map_err(RunError::Output)
    }

    fn tell(&mut self) {
        let (simulation, state) = (&self.simulation, self.simulation.state());
        let stages = &simulation.case().stages;
        let number = state.stage as usize + 1;
        let later: f64 = stages[number..].iter().map(|stage| stage.duration).sum();
        let time = simulation.time();
        self.observer.step(&RunProgress {
            stage: &simulation.stage().name,
            stage_number: number,
            stage_count: stages.len(),
            time,
            time_left: (state.stage_start + simulation.stage().duration - time).max(0.0) + later,
            time_expected: self.outlook.left(simulation),
            unbalanced: simulation.rest_target().map(|(_, target)| [self.recorder.progress.reports.unbalanced, target]),
            step: state.step,
        });
    }

    fn keep_good(&mut self) {
        self.good.state.clone_from(self.simulation.state());
        self.good.progress.clone_from(&self.recorder.progress);
    }
}

/// Warning when the run goes on from the state of a host.
fn unseen_past(simulation: &Simulation) -> String {
    format!(
        "the run goes on from the state of a host at t = {} s, with the inputs that held there: of stages before \
         only the times are known, and displacements of this stage count from there; a folder that the host has \
         recorded (enmm_record) has a checkpoint with all of it",
        rounded(simulation.time())
    )
}

/// Ends a stage by the refusal of the file system.
fn unwritten(error: io::Error) -> Halt {
    Err(RunError::Output(error))
}

/// Warning when the histories begin at a checkpoint.
fn lost_past(past: Past, simulation: &Simulation, directory: &Path) -> Option<String> {
    let lost = past == Past::Lost && simulation.time() > 0.0;
    lost.then(|| {
        format!(
            "history.csv and frames in {} begin at t = {} s: neither there nor beside the checkpoint is a \
             history.csv with the rows before; continue from the checkpoint in the directory of its run to have them",
            directory.display(),
            rounded(simulation.time())
        )
    })
}
