//! The loop over stages and steps, with outputs at their times.

mod closing;
mod progress;
mod warnings;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use crate::check::count_of_notes;
use crate::film::{Film, Opening, numbers};
use crate::folder::Folder;
use crate::history::HistoryWriter;
use crate::motion::PermanentMotion;
use crate::summary::{FAILED, RunStatus, StageRecord, Summary};
use crate::vtu::{Part, PvdWriter, Structures};
use enmm::geometry::Vector;
use enmm::model::case::{Invalid, StageKind};
use enmm::model::{Restless, Simulation, StepError, StepReport, settle};
use enmm_io::LoadedCase;
use enmm_observe::{Joints, Snapshot};
use enmm_report::{Axis, FILM, Note};

use super::concurrency::Concurrency;
use super::outlook::Outlook;
use super::results::Past;
use super::rows::{self, Plan};
use super::{Observer, RunError, RunOptions, RunProgress, results};

use progress::{Progress, Saved, load};

/// Name of the checkpoint in the folder of a run.
const CHECKPOINT: &str = "checkpoint.enmm";
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
    progress: Progress,
    outlook: Outlook,
    good: Saved,
    history: HistoryWriter,
    frames: Option<PvdWriter>,
    joints: Joints,
    film: Film,
    clock: Instant,
    stage_clock: Instant,
    warnings: Vec<String>,
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
    let saved = options.resume.as_deref().map(|path| load(path, &simulation, &loaded.hash)).transpose()?;
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
        saved: Option<Saved>,
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
        let good = saved.unwrap_or_else(|| Saved { state: simulation.state().clone(), progress: Progress::default() });
        if resumed {
            simulation.return_to(&good.state);
        }
        let mut warnings: Vec<String> = loaded.warnings.iter().chain(&simulation.built().warnings).cloned().collect();
        warnings.extend(past.and_then(|past| lost_past(past, &simulation, directory)));
        warnings.iter().for_each(|warning| observer.warn(warning));
        count_of_notes(simulation.built().notes.len()).iter().for_each(|note| observer.note(note));
        let (history, frames) = writers(&simulation, directory, resumed).map_err(RunError::Directory)?;
        let film = film(loaded, &simulation, directory, resumed, &warnings).map_err(RunError::Directory)?;
        let progress = good.progress.clone();
        let joints = Joints::of(&simulation);
        let stage_clock = Instant::now();
        let mut driver = Self {
            loaded,
            options,
            observer,
            simulation,
            concurrency: Concurrency::new(options.threads),
            progress,
            outlook: Outlook::default(),
            good,
            history,
            frames,
            joints,
            film,
            clock,
            stage_clock,
            warnings,
            saved: false,
        };
        if !resumed {
            driver.begin_stage().map_err(RunError::Directory)?;
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
            self.begin_stage().map_err(RunError::Output)?;
        }
    }

    fn begin_stage(&mut self) -> io::Result<()> {
        self.stage_clock = Instant::now();
        self.begin_row();
        self.progress.unsettled_before = self.simulation.state().counters.unsettled;
        self.progress.potential_start = None;
        self.progress.penetration_max = 0.0;
        let state = self.simulation.state();
        self.progress.started.clear();
        if state.stage_displacement.is_empty() {
            self.progress.started.clone_from(&state.displacement);
        }
        self.note_stage(None, "")
    }

    /// Notes in the film that the stage begins, or how it ended.
    fn note_stage(&mut self, end: Option<f64>, outcome: &str) -> io::Result<()> {
        let (stage, state) = (self.simulation.stage(), self.simulation.state());
        let kind = match stage.kind {
            StageKind::Static => "static",
            StageKind::Dynamic => "dynamic",
        };
        let note = Note::Stage {
            number: state.stage,
            name: stage.name.clone(),
            kind: kind.to_owned(),
            start: state.stage_start,
            end,
            outcome: outcome.to_owned(),
        };
        self.film.note(self.simulation.time(), &note)
    }

    /// Runs the stage in progress to its end, unless a checkpoint says that it is over.
    fn run_stage(&mut self) -> Result<StageEnd, RunError> {
        let plan = Plan::of(&self.simulation);
        let recorded = self.progress.done.len() > self.simulation.state().stage as usize;
        if recorded {
            return self.end_stage(None, recorded, false);
        }
        match settle::until_over(self, |driver| &driver.simulation, |driver| driver.pass(&plan)) {
            Ok(last) => self.end_stage(last, recorded, false),
            Err(Ok(StageEnd::RanAway(last))) => self.end_stage(Some(*last), recorded, true),
            Err(halt) => halt,
        }
    }

    /// Outputs that are due at the start of a step, and the step.
    fn pass(&mut self, plan: &Plan) -> Result<Option<StepReport>, Halt> {
        if self.options.interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            return Err(Ok(StageEnd::Interrupted));
        }
        let step = self.simulation.state().stage_step;
        if plan.checkpoint_due(step) {
            self.save().map_err(Err)?;
        }
        if plan.frame_due(step) {
            self.push_frame().map_err(Err)?;
        }
        if plan.film_due(step) {
            self.film.frame(&self.simulation).map_err(|error| Err(RunError::Output(error)))?;
        }
        self.tell();
        self.step(plan)
    }

    /// One step, with a report and a row when they are due.
    fn step(&mut self, plan: &Plan) -> Result<Option<StepReport>, Halt> {
        let step = self.simulation.state().stage_step;
        let row = plan.row_due(step);
        if row || step.is_multiple_of(GOOD_STEPS) {
            self.keep_good();
        }
        let before = if row { rows::monitors(&self.simulation) } else { Vec::new() };
        let dt_before = self.simulation.state().dt_last;
        let sweeps_mean = self.sweeps_mean();
        if row {
            self.begin_row();
        }
        let rest_due = self.simulation.rest_due();
        let wanted = step == 0 || row || rest_due;
        let known = self.simulation.state().events.list.len();
        let made = self.concurrency.advance(&mut self.simulation, wanted);
        let report = made.map_err(|error| Ok(StageEnd::Failed(error)))?;
        self.warn_of_overlaps(known).map_err(Err)?;
        if !wanted {
            return Ok(None);
        }
        self.note(&report);
        if row {
            self.write_row(&report, &before, dt_before, sweeps_mean).map_err(Err)?;
        }
        if step.is_multiple_of(settle::RUNAWAY_STEPS) && self.simulation.has_run_away() {
            return Err(Ok(StageEnd::RanAway(Box::new(report))));
        }
        Ok(rest_due.then_some(report))
    }

    /// Notes that there is a row now.
    fn begin_row(&mut self) {
        let counters = &self.simulation.state().counters;
        self.progress.row_sweeps = [counters.sweeps, counters.substeps];
    }

    fn note(&mut self, report: &StepReport) {
        self.outlook.note(&self.simulation, report);
        let progress = &mut self.progress;
        progress.potential_start.get_or_insert(report.ledger.potential);
        progress.penetration_max = progress.penetration_max.max(report.penetration_max);
        progress.unbalanced = report.unbalanced;
        progress.ledger = report.ledger;
    }

    /// Mean sweeps of a sub-step since the last row.
    fn sweeps_mean(&self) -> f64 {
        let counters = &self.simulation.state().counters;
        let [sweeps, substeps] = self.progress.row_sweeps;
        (counters.sweeps - sweeps) as f64 / (counters.substeps - substeps).max(1) as f64
    }

    fn write_row(
        &mut self,
        report: &StepReport,
        before: &[(Vector, Vector)],
        dt_before: f64,
        sweeps_mean: f64,
    ) -> Result<(), RunError> {
        let after = rows::monitors(&self.simulation);
        let dt = [dt_before, self.simulation.model().dt];
        let tensions = rows::tensions(&self.simulation);
        let stage = self.simulation.state().stage;
        let row = rows::row(stage, report, before, &after, dt, sweeps_mean, &tensions);
        self.history.row(&row).and_then(|()| self.film.row(&row)).map_err(RunError::Output)
    }

    /// Row and frame of the end of a stage, and its record; the step that the row needs is taken back.
    fn end_stage(&mut self, last: Option<StepReport>, recorded: bool, ended_early: bool) -> Result<StageEnd, RunError> {
        // Before the outputs, which give back the buffers with the contacts.
        let mut converged = last.is_some_and(|report| self.simulation.at_rest(&report));
        let restless = last.map_or_else(Vec::new, |report| self.simulation.restless(&report));
        self.keep_good();
        self.push_frame()?;
        self.film.frame(&self.simulation).map_err(RunError::Output)?;
        self.draw_stage().map_err(RunError::Output)?;
        let dt_before = self.simulation.state().dt_last;
        let before = rows::monitors(&self.simulation);
        let sweeps_mean = self.sweeps_mean();
        let report = self.simulation.advance(true);
        if let Ok(report) = &report {
            self.note(report);
            converged |= self.simulation.at_rest(report);
            self.write_row(report, &before, dt_before, sweeps_mean)?;
        }
        self.simulation.return_to(&self.good.state);
        if !recorded {
            self.record_stage(converged, ended_early, &restless)?;
        }
        Ok(StageEnd::Over)
    }

    /// Warns of what a stage has brought and records it. A slope that has failed in a static stage is saved at once.
    fn record_stage(&mut self, converged: bool, ended_early: bool, restless: &[Restless]) -> Result<(), RunError> {
        let record = StageRecord { ended_early, ..self.stage_record(Some(converged)) };
        let is_static = record.kind == StageKind::Static;
        if ended_early {
            self.warn_of_early_end()?;
        } else {
            self.warn_of_stage(converged, restless)?;
        }
        if is_static {
            self.warn_of_corners()?;
            self.outlook.end(self.simulation.time() - self.simulation.state().stage_start);
        } else {
            let motion = PermanentMotion::of(&self.simulation, &self.joints, self.began());
            self.progress.permanent.push(motion);
        }
        // The table of stages on the page is narrow, and the verdict above it has the rest.
        let outcome = if record.failure.is_some() { FAILED.to_owned() } else { record.outcome() };
        self.note_stage(Some(self.simulation.time()), &outcome).map_err(RunError::Output)?;
        let is_lost = is_static && record.failure.is_some();
        self.progress.done.push(record);
        if is_lost { self.save() } else { Ok(()) }
    }

    /// Displacements of the covers (m) at the start of the stage in progress.
    fn began(&self) -> &[Vector] {
        let of_state = &self.simulation.state().stage_displacement;
        if of_state.is_empty() { &self.progress.started } else { of_state }
    }

    fn draw_stage(&self) -> io::Result<()> {
        results::draw_stage(&self.simulation, &self.joints, self.began(), &self.options.directory)
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
            unbalanced: simulation.rest_target().map(|(_, target)| [self.progress.unbalanced, target]),
            step: state.step,
        });
    }

    fn push_frame(&mut self) -> Result<(), RunError> {
        let Some(frames) = &mut self.frames else { return Ok(()) };
        self.simulation.drop_buffers();
        let beside = Structures::of(&self.simulation, &self.joints);
        frames.push(&Snapshot::of(&self.simulation), &beside).map_err(RunError::Output)
    }

    fn keep_good(&mut self) {
        self.good.state.clone_from(self.simulation.state());
        self.good.progress.clone_from(&self.progress);
    }
}

/// Begins histories and frames, or continues those of the past of a restored state.
fn writers(simulation: &Simulation, directory: &Path, resumed: bool) -> io::Result<(HistoryWriter, Option<PvdWriter>)> {
    let (path, columns) = (directory.join("history.csv"), rows::columns(simulation.case()));
    let frames = simulation.case().output.frames;
    if !resumed {
        results::clear(directory)?;
        let history = HistoryWriter::new(&path, &columns)?;
        return Ok((history, frames.then(|| PvdWriter::new(directory, Part::of(simulation))).transpose()?));
    }
    let until = kept_until(simulation);
    let history = HistoryWriter::open_for_append(&path, &columns, until)?;
    Ok((history, frames.then(|| PvdWriter::open_for_append(directory, Part::of(simulation), until)).transpose()?))
}

/// Begins the film of a run, or continues that of a restored state. Its first notes are the warnings so far.
fn film(
    loaded: &LoadedCase,
    simulation: &Simulation,
    directory: &Path,
    resumed: bool,
    warnings: &[String],
) -> io::Result<Film> {
    let columns = rows::columns(simulation.case());
    let opening = Opening {
        command: "run",
        film: directory.join(FILM),
        axis: Axis::time(),
        numbers: numbers(),
        columns: &columns,
    };
    let until = resumed.then(|| kept_until(simulation));
    let mut film = Film::open(directory, loaded, simulation, opening, until)?;
    for text in warnings {
        film.note(simulation.time(), &Note::Warning { text: text.clone() })?;
    }
    film.note_changes(simulation)?;
    Ok(film)
}

/// Warning when the histories begin at a checkpoint.
fn lost_past(past: Past, simulation: &Simulation, directory: &Path) -> Option<String> {
    let lost = past == Past::Lost && simulation.time() > 0.0;
    lost.then(|| {
        format!(
            "history.csv and frames in {} begin at t = {:.6} s: neither there nor beside the checkpoint is a \
             history.csv with the rows before; continue from the checkpoint in the directory of its run to have them",
            directory.display(),
            simulation.time()
        )
    })
}

/// Time (s) up to which rows and frames belong to the past of a restored state; it writes those of its own time
/// again, but for those of the start of a later stage, which the stage before wrote.
fn kept_until(simulation: &Simulation) -> f64 {
    let state = simulation.state();
    let half = 0.5 * simulation.model().dt;
    if state.stage > 0 && state.stage_step == 0 { simulation.time() + half } else { simulation.time() - half }
}
