//! Writes the results of a model while it goes through its stages; whoever makes the steps calls it around them.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use enmm::geometry::Vector;
use enmm::model::case::StageKind;
use enmm::model::tables::Seconds;
use enmm::model::{Simulation, State, StepError, StepReport};
use enmm_io::{LoadedCase, checkpoint};
use enmm_observe::{Joints, Snapshot};
use enmm_report::{Axis, FILM, Note};

use crate::along::{ALONG, write_along};
use crate::blocks::write_blocks;
use crate::breaks::SectionRecord;
use crate::earthquake::{self, EarthquakeRecord};
use crate::film::{Film, Opening, numbers};
use crate::flow::{FLOW, FlowRecord, write_flow};
use crate::history::HistoryWriter;
use crate::input::input_record;
use crate::lines::{LINES, LineRecord, write_lines};
use crate::motion::{FailureOfStage, PermanentMotion};
use crate::progress::{CHECKPOINT, Progress, Saved};
use crate::results;
use crate::rows::{self, Plan, Readings};
use crate::summary::{CoupledRecord, FAILED, RunRecord, RunStatus, StageRecord, Summary, WallSeconds};
use crate::verdict::Verdict;
use crate::vtu::{Part, PvdWriter, Structures};

/// Where results go and what they belong to.
#[derive(Debug)]
pub struct Setting<'a> {
    /// The case.
    pub loaded: &'a LoadedCase,
    /// Folder of the results.
    pub directory: &'a Path,
    /// The command that makes them, as the page names it.
    pub command: &'static str,
    /// Progress of the run whose results go on; none for a new one.
    pub past: Option<Progress>,
    /// Warnings so far.
    pub warnings: Vec<String>,
    /// When the run began.
    pub clock: Instant,
}

/// How a run ends.
#[derive(Debug)]
pub struct Closing<'a> {
    /// The case.
    pub loaded: &'a LoadedCase,
    /// How the run ended.
    pub status: RunStatus,
    /// Numerical failure, if any.
    pub failure: Option<&'a StepError>,
    /// Communication steps of a coupled run.
    pub coupled: Option<CoupledRecord>,
}

/// A row that is taken by a step: what is known before it.
#[derive(Debug)]
struct RowStart {
    monitors: Vec<(Vector, Vector)>,
    readings: Readings,
    /// Lengths of the step before and of this one (s).
    dt: [f64; 2],
    sweeps_mean: f64,
}

/// Results of a model in time.
#[derive(Debug)]
pub struct Recorder {
    directory: PathBuf,
    /// How far the results are beyond the state of the model.
    pub progress: Progress,
    /// Warnings so far.
    pub warnings: Vec<String>,
    history: HistoryWriter,
    frames: Option<PvdWriter>,
    pub(crate) film: Film,
    pub(crate) joints: Joints,
    /// Sections of rock that have broken, as far as they are known here.
    breaks: usize,
    plan: Plan,
    row: Option<RowStart>,
    clock: Instant,
    stage_clock: Instant,
}

impl Recorder {
    /// Begins results, or continues those of the past of a restored state.
    ///
    /// # Errors
    /// Whatever the file system refuses, with the path in the message.
    pub fn open(setting: Setting, simulation: &Simulation) -> io::Result<Self> {
        let Setting { loaded, directory, command, past, warnings, clock } = setting;
        let until = past.is_some().then(|| kept_until(simulation));
        let (history, frames) = writers(simulation, directory, until)?;
        let film = film(loaded, simulation, (directory, command), until, &warnings)?;
        Ok(Self {
            directory: directory.to_owned(),
            progress: past.unwrap_or_default(),
            warnings,
            history,
            frames,
            film,
            joints: Joints::of(simulation),
            breaks: simulation.cuts().len(),
            plan: Plan::of(simulation),
            row: None,
            clock,
            stage_clock: Instant::now(),
        })
    }

    /// Keeps back what follows until [`Recorder::release`] writes it or [`Recorder::discard`] forgets it.
    pub(crate) fn hold(&mut self) {
        self.history.hold();
        self.film.hold();
        self.frames.iter_mut().for_each(PvdWriter::hold);
    }

    /// Writes what has been kept back.
    pub(crate) fn release(&mut self) -> io::Result<()> {
        self.history.release()?;
        self.film.release()?;
        self.frames.iter_mut().try_for_each(PvdWriter::release)
    }

    /// Forgets what has been kept back.
    pub(crate) fn discard(&mut self) {
        self.history.discard();
        self.film.discard();
        self.frames.iter_mut().for_each(PvdWriter::discard);
    }

    /// Bytes that are kept back.
    pub(crate) fn held(&self) -> usize {
        self.film.held()
    }

    /// Removes what is later than a time (s).
    pub(crate) fn cut(&mut self, until: f64) -> io::Result<()> {
        self.history.cut(until)?;
        self.film.cut(until)?;
        self.frames.iter_mut().try_for_each(|frames| frames.cut(until))
    }

    /// When outputs of the stage in progress are due.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Takes note that a stage begins.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn begin_stage(&mut self, simulation: &Simulation) -> io::Result<()> {
        self.stage_clock = Instant::now();
        self.plan = Plan::of(simulation);
        if !simulation.stage().cuts.is_empty() {
            self.joints = Joints::of(simulation);
        }
        self.begin_row(simulation);
        let (state, progress) = (simulation.state(), &mut self.progress);
        progress.reports.unsettled_before = state.counters.unsettled;
        progress.reports.potential_start = None;
        progress.reports.penetration_max = 0.0;
        progress.started.clear();
        if state.stage_displacement.is_empty() {
            progress.started.clone_from(&state.displacement);
        }
        self.note_stage(simulation, None, "")
    }

    /// Takes the plan of the stage in progress of a state that has been restored.
    pub(crate) fn take_up(&mut self, simulation: &Simulation) {
        self.plan = Plan::of(simulation);
        self.row = None;
        let breaks = simulation.cuts().len();
        if std::mem::replace(&mut self.breaks, breaks) != breaks {
            self.joints = Joints::of(simulation);
        }
    }

    /// Notes in the film that the stage begins, or how it ended.
    fn note_stage(&mut self, simulation: &Simulation, end: Option<f64>, outcome: &str) -> io::Result<()> {
        let (stage, state) = (simulation.stage(), simulation.state());
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
        self.film.note(simulation.time(), &note)
    }

    /// Whether a frame for ParaView is due at the start of a step.
    pub fn frame_due(&self, step: u64) -> bool {
        self.frames.is_some() && self.plan.frame_due(step)
    }

    /// Begins frames for ParaView of a case that asks for none.
    pub(crate) fn want_frames(&mut self, simulation: &Simulation) -> io::Result<()> {
        if self.frames.is_none() {
            self.frames = Some(PvdWriter::new(&self.directory, Part::of(simulation))?);
        }
        Ok(())
    }

    /// Writes a frame for ParaView, if the case asks for them.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn push_frame(&mut self, simulation: &Simulation) -> io::Result<()> {
        let Some(frames) = &mut self.frames else { return Ok(()) };
        let beside = Structures::of(simulation, &self.joints);
        frames.push(&Snapshot::of(simulation), &beside)
    }

    /// Appends a frame to the film.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn push_film(&mut self, simulation: &Simulation) -> io::Result<()> {
        self.film.frame(simulation)
    }

    /// Appends a frame to the film in any case with its elements, as at the end of a stage.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn push_end_of_film(&mut self, simulation: &Simulation) -> io::Result<()> {
        self.film.frame_at(simulation, simulation.time())
    }

    /// Looks at the model before a step whose report becomes a row.
    pub fn before_row(&mut self, simulation: &Simulation) {
        self.row = Some(self.row_start(simulation));
        self.begin_row(simulation);
    }

    /// Takes note of the report of a step, and writes the row for which [`Recorder::before_row`] has looked before it;
    /// returns whether there was one.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn after_step(&mut self, simulation: &Simulation, report: &StepReport) -> io::Result<bool> {
        self.note(report);
        let Some(start) = self.row.take() else { return Ok(false) };
        self.write_row(simulation, report, &start)?;
        Ok(true)
    }

    /// Takes over what is known by covers and joints into a model in which blocks have broken since the last look, or
    /// into that of an earlier state whose progress is there.
    pub fn follow_breaks(&mut self, simulation: &Simulation) {
        let breaks = simulation.cuts().len();
        let known = std::mem::replace(&mut self.breaks, breaks);
        if breaks == known {
            return;
        }
        self.joints = Joints::of(simulation);
        if !self.progress.started.is_empty() {
            self.progress.started = simulation.after_breaks(known, &self.progress.started);
        }
    }

    fn row_start(&self, simulation: &Simulation) -> RowStart {
        let state = simulation.state();
        RowStart {
            monitors: rows::monitors(simulation),
            readings: Readings::of(simulation),
            dt: [state.dt_last, state.rest_of_step(simulation.model())],
            sweeps_mean: self.sweeps_mean(simulation),
        }
    }

    /// Notes that there is a row now.
    fn begin_row(&mut self, simulation: &Simulation) {
        let counters = &simulation.state().counters;
        self.progress.reports.row_sweeps = [counters.sweeps, counters.substeps];
    }

    fn note(&mut self, report: &StepReport) {
        let reports = &mut self.progress.reports;
        reports.potential_start.get_or_insert(report.ledger.potential);
        reports.penetration_max = reports.penetration_max.max(report.penetration_max);
        reports.unbalanced = report.unbalanced;
        reports.ledger = report.ledger;
    }

    /// Mean sweeps of a sub-step since the last row.
    fn sweeps_mean(&self, simulation: &Simulation) -> f64 {
        let counters = &simulation.state().counters;
        let [sweeps, substeps] = self.progress.reports.row_sweeps;
        counters.sweeps.saturating_sub(sweeps) as f64 / counters.substeps.saturating_sub(substeps).max(1) as f64
    }

    fn write_row(&mut self, simulation: &Simulation, report: &StepReport, start: &RowStart) -> io::Result<()> {
        let after = rows::monitors(simulation);
        let tensions = rows::tensions(simulation);
        let stage = simulation.state().stage;
        let beside = (start.sweeps_mean, &start.readings);
        let mut row = rows::row(stage, report, &start.monitors, &after, start.dt, beside, &tensions);
        if earthquake::is_shaken(simulation.case()) {
            let columns = rows::columns(simulation.case());
            let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
            row.extend(earthquake::accelerations(simulation, &names, self.history.last(), &row));
        }
        self.history.row(&row)?;
        self.film.row(&row)
    }

    /// Frames, pictures and row of an instant at which a stage ends; the step that the row needs is taken back, to the
    /// state `now`. Returns whether a static stage is at rest by it.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn show_end(&mut self, simulation: &mut Simulation, now: &State) -> io::Result<bool> {
        if self.frames.is_some() {
            simulation.drop_buffers();
        }
        self.push_frame(simulation)?;
        self.push_end_of_film(simulation)?;
        self.draw_stage(simulation)?;
        self.row_now(simulation, now)
    }

    /// Draws the end of a stage: those pictures that the case requests.
    pub(crate) fn draw_stage(&self, simulation: &Simulation) -> io::Result<()> {
        let before = (self.began(simulation), &self.progress.lines[..]);
        results::draw_stage(simulation, &self.joints, before, &self.directory)
    }

    /// The row of an instant; the step that it needs is taken back, to the state `now`. Returns whether a static stage
    /// is at rest by its report.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub(crate) fn row_now(&mut self, simulation: &mut Simulation, now: &State) -> io::Result<bool> {
        let start = self.row_start(simulation);
        let Ok(report) = simulation.advance(true) else {
            simulation.return_to(now);
            return Ok(false);
        };
        self.note(&report);
        let at_rest = simulation.at_rest(&report);
        self.write_row(simulation, &report, &start)?;
        simulation.return_to(now);
        Ok(at_rest)
    }

    /// Displacements of the covers (m) at the start of the stage in progress.
    pub fn began<'a>(&'a self, simulation: &'a Simulation) -> &'a [Vector] {
        let of_state = &simulation.state().stage_displacement;
        if of_state.is_empty() { &self.progress.started } else { of_state }
    }

    /// Record of the stage in progress.
    pub fn stage_record(&self, simulation: &Simulation, converged: Option<bool>) -> StageRecord {
        let (stage, state, reports) = (simulation.stage(), simulation.state(), &self.progress.reports);
        let potential = reports.ledger.potential;
        let is_at_rest = stage.kind == StageKind::Dynamic || converged.unwrap_or(true);
        let began = self.began(simulation);
        StageRecord {
            name: stage.name.clone(),
            kind: stage.kind,
            start: state.stage_start,
            time: simulation.time() - state.stage_start,
            steps: state.stage_step,
            converged: converged.filter(|_| stage.kind == StageKind::Static),
            ended_early: false,
            displacement: simulation.farthest_since(began).map_or(0.0, |farthest| farthest.displacement),
            failure: simulation.failure_since(began, is_at_rest).map(FailureOfStage::from),
            wall_seconds: Some(self.stage_clock.elapsed().as_secs_f64()),
            unbalanced: reports.unbalanced,
            kinetic_energy: reports.ledger.kinetic,
            potential_released: reports.potential_start.unwrap_or(potential) - potential,
            unsettled: self.unsettled(simulation),
            penetration_max: reports.penetration_max,
        }
    }

    /// Sub-steps of the stage that ended unsettled.
    pub(crate) fn unsettled(&self, simulation: &Simulation) -> u64 {
        simulation.state().counters.unsettled.saturating_sub(self.progress.reports.unsettled_before)
    }

    /// Keeps the record of a stage that is over.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn keep_record(&mut self, simulation: &Simulation, record: StageRecord) -> io::Result<()> {
        if record.kind == StageKind::Dynamic {
            let motion = PermanentMotion::of(simulation, &self.joints, self.began(simulation));
            self.progress.permanent.push(motion);
        }
        self.progress.lines.extend(LineRecord::all(simulation));
        // The table of stages on the page is narrow, and the verdict above it has the rest.
        let outcome = if record.failure.is_some() { FAILED.to_owned() } else { record.outcome() };
        self.note_stage(simulation, Some(simulation.time()), &outcome)?;
        self.progress.done.push(record);
        Ok(())
    }

    /// Writes a checkpoint of a state with the progress of a run, by default that up to now.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn save(&self, state: &State, hash: &str) -> io::Result<()> {
        let mut progress = self.progress.clone();
        progress.done.iter_mut().for_each(|stage| stage.wall_seconds = None);
        progress.done.truncate(state.stage as usize + 1);
        checkpoint::save(&self.directory.join(CHECKPOINT), &Saved { state, progress }, hash)
    }

    /// Writes what a run leaves at its end beside the checkpoint, the summary last.
    ///
    /// # Errors
    /// As [`Recorder::open`].
    pub fn close(&mut self, simulation: &Simulation, closing: Closing) -> io::Result<Summary> {
        let Closing { loaded, status, failure, coupled } = closing;
        self.history.check_place()?;
        write_blocks(&self.directory.join("blocks.csv"), simulation)?;
        write_along(&self.directory.join(ALONG), simulation)?;
        let flows = FlowRecord::all(simulation);
        if !flows.is_empty() {
            write_flow(&self.directory.join(FLOW), &flows)?;
        }
        let lines = self.close_lines(simulation)?;
        let earthquakes = self.close_earthquakes(simulation)?;
        if status != RunStatus::Interrupted {
            results::draw_end(simulation, &earthquakes, &self.directory)?;
        }
        let mut stages = self.progress.done.clone();
        if stages.len() <= simulation.state().stage as usize {
            stages.push(self.stage_record(simulation, None));
        }
        let ledger = self.progress.reports.ledger;
        let doubt = simulation.doubt(&ledger).filter(|_| status == RunStatus::Finished);
        self.warnings.extend(doubt.clone());
        let verdict = Verdict::of(&stages, status);
        let time = simulation.time();
        let note = Note::Verdict { text: verdict.text.clone(), failed: verdict.failed };
        self.film.note(time, &note)?;
        self.film.note_breaks(simulation, time)?;
        if let Some(worst) = SectionRecord::worst(simulation).first() {
            self.film.note(time, &worst.note())?;
        }
        self.close_film(time, status, failure, doubt.as_ref())?;
        let record = RunRecord {
            case_file: loaded.source.file(),
            case_hash: &loaded.hash,
            settings: &loaded.settings,
            status,
            failure,
            coupled,
            stages,
            permanent: self.progress.permanent.clone(),
            lines,
            earthquakes,
            failed: verdict.failed,
            verdict: verdict.text,
            ledger: &ledger,
            wall: self.wall(simulation),
            warnings: std::mem::take(&mut self.warnings),
            input: input_record(loaded),
            doubt,
        };
        let summary = Summary::new(simulation, record);
        summary.write(&self.directory.join("summary.json"))?;
        Ok(summary)
    }

    /// Writes the tables of the earthquakes, and warns of histories that are too coarse for them.
    fn close_earthquakes(&mut self, simulation: &Simulation) -> io::Result<Vec<EarthquakeRecord>> {
        let earthquakes = EarthquakeRecord::all(simulation, &self.directory.join("history.csv"))?;
        if !earthquakes.is_empty() {
            earthquake::write(&self.directory, &earthquakes)?;
        }
        let doubts: Vec<String> = earthquakes.iter().filter_map(EarthquakeRecord::doubt).collect();
        doubts.into_iter().try_for_each(|text| self.warn(simulation, text))?;
        Ok(earthquakes)
    }

    /// Writes the lines at the ends of the stages so far, and of one that is not over as they are now.
    fn close_lines(&self, simulation: &Simulation) -> io::Result<Vec<LineRecord>> {
        let mut lines = self.progress.lines.clone();
        if self.progress.done.len() <= simulation.state().stage as usize {
            lines.extend(LineRecord::all(simulation));
        }
        if !lines.is_empty() {
            write_lines(&self.directory.join(LINES), &lines)?;
        }
        Ok(lines)
    }

    fn wall(&self, simulation: &Simulation) -> WallSeconds {
        let parts: &Seconds = &simulation.workspace().seconds;
        WallSeconds::of(parts, self.clock.elapsed().as_secs_f64())
    }

    /// Writes the page of the run.
    fn close_film(
        &mut self,
        time: f64,
        status: RunStatus,
        failure: Option<&StepError>,
        doubt: Option<&String>,
    ) -> io::Result<()> {
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

/// Begins histories and frames, or continues those up to a time (s).
fn writers(
    simulation: &Simulation,
    directory: &Path,
    until: Option<f64>,
) -> io::Result<(HistoryWriter, Option<PvdWriter>)> {
    let (path, columns) = (directory.join("history.csv"), rows::columns(simulation.case()));
    let frames = simulation.case().output.frames;
    let Some(until) = until else {
        results::clear(directory)?;
        let history = HistoryWriter::new(&path, &columns)?;
        return Ok((history, frames.then(|| PvdWriter::new(directory, Part::of(simulation))).transpose()?));
    };
    let history = HistoryWriter::open_for_append(&path, &columns, until)?;
    Ok((history, frames.then(|| PvdWriter::open_for_append(directory, Part::of(simulation), until)).transpose()?))
}

/// Begins a film in a directory by a command, or continues that up to a time (s). Its first notes are the warnings so
/// far.
fn film(
    loaded: &LoadedCase,
    simulation: &Simulation,
    (directory, command): (&Path, &'static str),
    until: Option<f64>,
    warnings: &[String],
) -> io::Result<Film> {
    let columns = rows::columns(simulation.case());
    let opening = Opening {
        command,
        film: directory.join(FILM),
        axis: Axis::time(),
        numbers: numbers(simulation),
        elements: true,
        columns: &columns,
    };
    let mut film = Film::open(directory, loaded, simulation, opening, until)?;
    for text in warnings {
        film.note(simulation.time(), &Note::Warning { text: text.clone() })?;
    }
    film.note_changes(simulation)?;
    Ok(film)
}

/// Time (s) up to which rows and frames belong to the past of a restored state; it writes those of its own time
/// again, but for those of the start of a later stage, which the stage before wrote.
pub(crate) fn kept_until(simulation: &Simulation) -> f64 {
    let state = simulation.state();
    let half = 0.5 * simulation.model().dt;
    if state.stage > 0 && state.stage_step == 0 { simulation.time() + half } else { simulation.time() - half }
}
