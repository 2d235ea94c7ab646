//! Results of a model that a host drives: those of `enmm run`, in the same files.
//!
//! Rows and frames are due at the times of the case and are taken as the model passes them, within communication steps
//! too. What a communication step brings is kept back until the next one begins, so that a host that repeats it leaves
//! nothing twice. A return to an earlier state removes what is later from the files.

use std::any::Any;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use enmm::cosimulation::{Cosimulation, Witness};
use enmm::geometry::Vector;
use enmm::model::case::StageKind;
use enmm::model::{Simulation, StepError, StepReport};
use enmm_io::LoadedCase;

use crate::folder::Folder;
use crate::progress::Reports;
use crate::recorder::{Closing, Recorder, Setting, kept_until};
use crate::results;
use crate::summary::{CoupledRecord, RunStatus, StageRecord, Summary};

/// Bytes of the film that are kept back at most.
const HELD_MAX: usize = 1 << 24;
/// Part of an internal step within which two times of outputs are the same.
const SAME_TIME: f64 = 0.25;

/// Why results are not recorded.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The folder cannot take results.
    #[error("cannot write results ({0}): choose another folder")]
    Folder(io::Error),
    /// A result could not be written, and recording has ended.
    #[error("recording has ended ({0}): see that the folder is there and has room, and record into another one")]
    Output(String),
    /// The model is of another case than the one that results name.
    #[error("the model is of case {found}, the results of case {own}: record the case of which the model is")]
    OtherCase {
        /// Hash of the model.
        found: String,
        /// Hash of the case.
        own: String,
    },
    /// A recording is on.
    #[error("results of this model go to {} already: end that recording first", .0.display())]
    On(PathBuf),
    /// No recording is on.
    #[error("no results of this model are recorded: begin by naming a folder")]
    Off,
}

/// Times (s) of the last outputs.
#[derive(Debug, Clone, Copy)]
struct Last {
    row: f64,
    frame: f64,
    film: f64,
}

impl Last {
    const NONE: Self = Self { row: f64::NEG_INFINITY, frame: f64::NEG_INFINITY, film: f64::NEG_INFINITY };

    fn latest(self) -> f64 {
        self.row.max(self.frame).max(self.film)
    }

    fn until(self, time: f64) -> Self {
        Self { row: self.row.min(time), frame: self.frame.min(time), film: self.film.min(time) }
    }
}

/// Reports up to a row, or up to the start of a stage.
#[derive(Debug, Clone, Copy)]
struct Mark {
    stage: u32,
    /// Step of the stage whose report the row has; none for the start.
    step: Option<u64>,
    reports: Reports,
}

/// Results of a model in the hands of a host, as its [`Witness`].
#[derive(Debug)]
pub struct Recording {
    recorder: Recorder,
    loaded: LoadedCase,
    directory: PathBuf,
    folder: Option<Folder>,
    /// Process that records; a forked one writes nothing.
    process: u32,
    last: Last,
    /// The same without what is kept back.
    written: Last,
    /// Time (s) from which on outputs are kept back.
    held_from: f64,
    marks: Vec<Mark>,
    /// Displacements of the covers (m) at the start of stages that began while this recorded, and the breaks before.
    starts: Vec<(u32, usize, Vec<Vector>)>,
    /// The last step of the stage in progress that was seen.
    seen: Option<u64>,
    /// Events that warnings have been given of.
    events: usize,
    coupled: CoupledRecord,
    failure: Option<StepError>,
    fault: Option<String>,
}

impl Recording {
    /// Records the results of a model of a case into a folder from now on, as the witness of the model. Stages that are
    /// over leave no more than their times.
    ///
    /// # Errors
    /// The model is recorded already, or is of another case; the folder cannot be written, is in use, or holds inputs
    /// of the case under names of results.
    pub fn open(model: &mut Cosimulation, loaded: &LoadedCase, directory: &Path) -> Result<(), RecordingError> {
        if let Some(recording) = of(model) {
            return Err(RecordingError::On(recording.directory.clone()));
        }
        if model.hash() != loaded.hash {
            return Err(RecordingError::OtherCase { found: model.hash().to_owned(), own: loaded.hash.clone() });
        }
        let recording = Self::begin(model.simulation(), loaded, directory).map_err(RecordingError::Folder)?;
        model.set_witness(Some(Box::new(recording)));
        Ok(())
    }

    /// Writes a row and frames of this instant, those for ParaView also where the case asks for none. They are not kept
    /// back, so a host that repeats steps calls it when a step stands.
    ///
    /// # Errors
    /// Nothing is recorded, or could no longer be.
    pub fn write_frame(model: &mut Cosimulation) -> Result<(), RecordingError> {
        with(model, |recording, model| recording.show(model.simulation()).map_err(|error| error.to_string()))
    }

    /// Whether results of a model are recorded.
    pub fn is_on(model: &Cosimulation) -> bool {
        of(model).is_some()
    }

    /// Why recording has ended by itself: a result that could not be written. Steps go on without it.
    pub fn fault(model: &Cosimulation) -> Option<&str> {
        of(model)?.fault.as_deref()
    }

    /// Ends the recording: writes what is kept back, the last row, the pictures, the checkpoint, the page and the
    /// summary.
    ///
    /// # Errors
    /// Nothing is recorded, or a result could not be written, now or before.
    pub fn close(model: &mut Cosimulation) -> Result<Summary, RecordingError> {
        let summary = with(model, |recording, model| recording.end(model).map_err(|error| error.to_string()));
        if !matches!(summary, Err(RecordingError::Off)) {
            model.set_witness(None);
        }
        summary
    }

    fn begin(simulation: &Simulation, loaded: &LoadedCase, directory: &Path) -> io::Result<Self> {
        let clock = Instant::now();
        let folder = Folder::open(directory, loaded.source.inputs())?;
        results::draw_model(simulation, directory)?;
        let warnings = loaded.warnings.iter().chain(&simulation.built().warnings).cloned().collect();
        let setting = Setting { loaded, directory, command: "coupled", past: None, warnings, clock };
        let state = simulation.state();
        let mut recording = Self {
            recorder: Recorder::open(setting, simulation)?,
            loaded: loaded.clone(),
            directory: directory.to_owned(),
            folder: Some(folder),
            process: std::process::id(),
            last: Last::NONE,
            written: Last::NONE,
            held_from: simulation.time(),
            marks: Vec::new(),
            starts: Vec::new(),
            seen: None,
            events: state.events.list.len(),
            coupled: CoupledRecord { communication_steps: 0, returns: 0 },
            failure: None,
            fault: None,
        };
        recording.fill_past(simulation);
        recording.begin_stage(simulation)?;
        if state.step > 0 {
            recording.show_due(simulation, true)?;
            recording.row(simulation)?;
        }
        recording.release(simulation)?;
        Ok(recording)
    }

    /// Fails in a process that was forked from the one that records.
    fn check_process(&self) -> io::Result<()> {
        if self.is_own() {
            return Ok(());
        }
        Err(io::Error::other("this process was forked from the one that records"))
    }

    fn is_own(&self) -> bool {
        self.process == std::process::id()
    }

    fn begin_stage(&mut self, simulation: &Simulation) -> io::Result<()> {
        self.recorder.begin_stage(simulation)?;
        let stage = simulation.state().stage;
        self.seen = None;
        self.starts.retain(|(other, ..)| *other < stage);
        self.starts.push((stage, simulation.cuts().len(), self.recorder.progress.started.clone()));
        self.mark(stage, None);
        Ok(())
    }

    fn mark(&mut self, stage: u32, step: Option<u64>) {
        self.marks.push(Mark { stage, step, reports: self.recorder.progress.reports });
    }

    /// Records of stages that are over and were not seen.
    fn fill_past(&mut self, simulation: &Simulation) {
        let done = &mut self.recorder.progress.done;
        let unseen = done.len()..simulation.state().stage as usize;
        done.extend(unseen.map(|stage| StageRecord::unseen(simulation, simulation.state(), stage)));
    }

    /// Writes what is kept back, and keeps back what follows from now on.
    fn release(&mut self, simulation: &Simulation) -> io::Result<()> {
        self.recorder.release()?;
        self.written = self.last;
        self.held_from = simulation.time();
        self.recorder.hold();
        Ok(())
    }

    /// Writes frames and the row of this instant at once.
    fn show(&mut self, simulation: &Simulation) -> io::Result<()> {
        self.check_process()?;
        self.release(simulation)?;
        self.recorder.want_frames(simulation)?;
        self.show_due(simulation, true)?;
        self.row(simulation)?;
        self.release(simulation)
    }

    /// Takes frames of this instant that are due, or all; none twice.
    fn show_due(&mut self, simulation: &Simulation, all: bool) -> io::Result<()> {
        let (step, time) = (simulation.state().stage_step, simulation.time());
        if (all || self.recorder.frame_due(step)) && is_later(simulation, self.last.frame) {
            self.recorder.push_frame(simulation)?;
            self.last.frame = time;
        }
        if (all || self.recorder.plan().film_due(step)) && is_later(simulation, self.last.film) {
            if all {
                self.recorder.push_end_of_film(simulation)?;
            } else {
                self.recorder.push_film(simulation)?;
            }
            self.last.film = time;
        }
        Ok(())
    }

    /// Takes the row of this instant, unless it is there; the step that it needs is taken by a copy of the model.
    /// Returns whether a static stage is at rest by it.
    fn row(&mut self, simulation: &Simulation) -> io::Result<bool> {
        if !is_later(simulation, self.last.row) {
            return Ok(false);
        }
        let state = simulation.state();
        let mut copy = simulation.clone();
        // Inputs that the host has set since act from the next communication step on.
        copy.drive().hold_last();
        let at_rest = self.recorder.row_now(&mut copy, state)?;
        self.last.row = simulation.time();
        self.mark(state.stage, Some(state.stage_step));
        Ok(at_rest)
    }

    /// Looks before an internal step; returns whether its report is wanted.
    fn look_before(&mut self, simulation: &Simulation) -> io::Result<bool> {
        if self.recorder.held() > HELD_MAX {
            self.release(simulation)?;
        }
        let step = simulation.state().stage_step;
        if step == 0 {
            self.check_process()?;
        }
        self.recorder.follow_breaks(simulation);
        self.show_due(simulation, false)?;
        // Steps from between two points of the grid are not seen, so that a row may have been due meanwhile.
        let first = self.seen.map_or(step, |seen| seen + 1).min(step);
        let is_due = (first..=step).any(|step| self.recorder.plan().row_due(step));
        let is_row = is_due && is_later(simulation, self.last.row);
        self.seen = Some(step);
        if is_row {
            self.recorder.before_row(simulation);
            self.last.row = simulation.time();
        }
        Ok(is_row || step == 0)
    }

    fn look_after(&mut self, simulation: &Simulation, report: &StepReport) -> io::Result<()> {
        self.recorder.follow_breaks(simulation);
        let is_row = self.recorder.after_step(simulation, report)?;
        if is_row {
            self.mark(simulation.state().stage, self.seen);
        }
        Ok(())
    }

    fn end_stage(&mut self, simulation: &Simulation, last: Option<&StepReport>) -> io::Result<()> {
        let was_at_rest = last.is_some_and(|report| simulation.at_rest(report));
        let restless = last.map_or_else(Vec::new, |report| simulation.restless(report));
        self.show_due(simulation, true)?;
        self.recorder.draw_stage(simulation)?;
        let converged = self.row(simulation)? || was_at_rest;
        let record = self.recorder.stage_record(simulation, Some(converged));
        self.warn_of_overlaps(simulation)?;
        self.recorder.warn_of_stage(simulation, converged, &restless)?;
        self.recorder.keep_record(simulation, record)
    }

    fn warn_of_overlaps(&mut self, simulation: &Simulation) -> io::Result<()> {
        let known = std::mem::replace(&mut self.events, simulation.state().events.list.len());
        self.recorder.warn_of_overlaps(simulation, known)
    }

    /// Takes back what is later than a state to which the model has gone.
    fn go_back(&mut self, simulation: &Simulation) -> io::Result<()> {
        let (dt, time) = (simulation.model().dt, simulation.time());
        if self.last.latest() > time + 0.5 * dt {
            // A state between two points of the grid goes on from the one before.
            if self.written.latest() <= time + 0.5 * dt && self.held_from >= time - 1.5 * dt {
                self.recorder.discard();
                self.last = self.written;
            } else {
                let until = kept_until(simulation);
                self.recorder.cut(until)?;
                self.last = self.last.until(until);
                self.written = self.last;
            }
            self.recorder.hold();
            self.held_from = time;
        }
        self.take_up(simulation);
        Ok(())
    }

    /// Makes the progress that of a state.
    fn take_up(&mut self, simulation: &Simulation) {
        let state = simulation.state();
        let here = (state.stage, Some(state.stage_step));
        self.marks.retain(|mark| (mark.stage, mark.step) < here);
        let progress = &mut self.recorder.progress;
        progress.reports = self.marks.last().map_or_else(Reports::default, |mark| mark.reports);
        progress.done.truncate(state.stage as usize);
        let dynamic = progress.done.iter().filter(|stage| stage.kind == StageKind::Dynamic).count();
        progress.permanent.truncate(dynamic);
        progress.lines.retain(|line| line.number <= state.stage);
        let started = self.starts.iter().find(|(stage, ..)| *stage == state.stage);
        progress.started = match started {
            Some((_, breaks, started)) => simulation.after_breaks(*breaks, started),
            None if state.stage_displacement.is_empty() => state.displacement.clone(),
            None => Vec::new(),
        };
        self.fill_past(simulation);
        self.recorder.take_up(simulation);
        self.seen = None;
        self.events = self.events.min(state.events.list.len());
    }

    /// Writes the end of a recording.
    fn end(&mut self, model: &Cosimulation) -> io::Result<Summary> {
        self.check_process()?;
        let simulation = model.simulation();
        self.recorder.release()?;
        self.warn_of_overlaps(simulation)?;
        if simulation.state().step > 0 {
            self.show_due(simulation, true)?;
            self.recorder.draw_stage(simulation)?;
            self.row(simulation)?;
        }
        self.recorder.save(model.onward(), &self.loaded.hash)?;
        let stage = simulation.stage();
        if stage.kind == StageKind::Dynamic && simulation.state().stage_step > 0 {
            let record = self.recorder.stage_record(simulation, Some(true));
            self.recorder.warn_of_stage(simulation, true, &[])?;
            self.recorder.keep_record(simulation, record)?;
        }
        let status = if self.failure.is_some() { RunStatus::Failed } else { RunStatus::Finished };
        let failure = self.failure.as_ref();
        let closing = Closing { loaded: &self.loaded, status, failure, coupled: Some(self.coupled) };
        self.recorder.close(simulation, closing)
    }

    /// Ends recording by itself where a result could not be written.
    fn note<T: Default>(&mut self, act: impl FnOnce(&mut Self) -> io::Result<T>) -> T {
        if self.fault.is_some() {
            return T::default();
        }
        act(self).unwrap_or_else(|error| {
            self.fault = Some(error.to_string());
            T::default()
        })
    }
}

impl Witness for Recording {
    fn communication_step_begins(&mut self, simulation: &Simulation) {
        self.coupled.communication_steps += 1;
        self.failure = None;
        self.note(|recording| {
            recording.check_process()?;
            recording.warn_of_overlaps(simulation)?;
            recording.release(simulation)
        });
    }

    fn step_begins(&mut self, simulation: &Simulation) -> bool {
        self.note(|recording| recording.look_before(simulation))
    }

    fn step_ends(&mut self, simulation: &Simulation, report: &StepReport) {
        self.note(|recording| recording.look_after(simulation, report));
    }

    fn stage_ends(&mut self, simulation: &Simulation, last: Option<&StepReport>) {
        self.note(|recording| recording.end_stage(simulation, last));
    }

    fn stage_begins(&mut self, simulation: &Simulation) {
        self.note(|recording| recording.begin_stage(simulation));
    }

    fn returns(&mut self, simulation: &Simulation) {
        self.coupled.returns += 1;
        self.note(|recording| recording.go_back(simulation));
    }

    fn fails(&mut self, error: &StepError) {
        self.failure = Some(*error);
    }
}

impl Drop for Recording {
    /// The lock of the folder belongs to the process that took it.
    fn drop(&mut self) {
        if !self.is_own() {
            std::mem::forget(self.folder.take());
        }
    }
}

/// Whether the model is at a later time than that of the last output (s).
fn is_later(simulation: &Simulation, last: f64) -> bool {
    simulation.time() > last + SAME_TIME * simulation.model().dt
}

/// The recording of a model.
fn of(model: &Cosimulation) -> Option<&Recording> {
    let witness: &dyn Any = model.witness()?;
    witness.downcast_ref()
}

/// Lets the recording of a model act on it. What it could not write ends it.
fn with<T>(
    model: &mut Cosimulation,
    act: impl FnOnce(&mut Recording, &Cosimulation) -> Result<T, String>,
) -> Result<T, RecordingError> {
    let Some(mut witness) = model.set_witness(None) else { return Err(RecordingError::Off) };
    let as_any: &mut dyn Any = &mut *witness;
    let outcome = match as_any.downcast_mut::<Recording>() {
        None => Err(RecordingError::Off),
        Some(recording) => {
            let outcome = recording.fault.take().map_or_else(|| act(recording, model), Err);
            recording.fault = outcome.as_ref().err().cloned();
            outcome.map_err(RecordingError::Output)
        }
    };
    model.set_witness(Some(witness));
    outcome
}
