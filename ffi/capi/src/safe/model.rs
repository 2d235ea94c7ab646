//! A model behind a handle: the façade, the log of its host, and the calls that make it move.

use engine::model::case::keys::rounded;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, TryLockError};

use engine::cosimulation::{Cosimulation, CosimulationError, Event, EventKind, Interpolation, StepInfo};
use engine::model::SlopeFailure;
use enmm_io::{LoadedCase, load_case, parse_case};

use super::control::{Interrupt, Progress};
use super::failure::{Failure, Outcome};
use super::handles::Table;
use crate::numbers::enmm_block_state;
use crate::types::{enmm_interpolation, enmm_log_level, enmm_start_info, enmm_status, enmm_step_info};

/// Models that are alive.
pub static MODELS: Table<Shared> = Table::new(0x10, "model");

/// Where messages of a model go.
pub type Sink = std::sync::Arc<dyn Fn(enmm_log_level, &str) + Send + Sync>;

/// A model that one thread at a time may use.
pub struct Shared {
    model: Mutex<Model>,
    /// Thread that is in a call, messages of the call included; 0 for none.
    owner: AtomicUsize,
    /// Wish that the call ends, beside the model, so that it needs no turn.
    pub interrupt: Interrupt,
}

/// The right of one thread to a model. The outermost call of the thread gives it back.
pub struct Turn<'a>(Option<&'a AtomicUsize>);

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        if let Some(owner) = self.0 {
            owner.store(0, Ordering::Release);
        }
    }
}

/// A number of this thread that no other living thread has; never 0.
fn this_thread() -> usize {
    thread_local! { static HERE: u8 = const { 0 } }
    HERE.with(|here| std::ptr::from_ref(here).addr())
}

fn busy(message: &str) -> Failure {
    Failure::new(enmm_status::ENMM_BUSY, message)
}

impl Shared {
    /// Takes the model for a call of this thread until its messages are out; calls of a callback come inside.
    ///
    /// # Errors
    /// Another thread is in a call.
    pub fn enter(&self) -> Result<Turn<'_>, Failure> {
        let here = this_thread();
        match self.owner.compare_exchange(0, here, Ordering::Acquire, Ordering::Relaxed) {
            Ok(_) => Ok(Turn(Some(&self.owner))),
            Err(owner) if owner == here => Ok(Turn(None)),
            Err(_) => Err(busy("another thread is using this model; let one thread at a time use it")),
        }
    }

    /// The model while a call works on it; it is free again when messages go out.
    ///
    /// # Errors
    /// A call is working on it, or a panic has left it broken.
    pub fn lock(&self) -> Result<MutexGuard<'_, Model>, Failure> {
        self.model.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => {
                busy("a call of this thread is working on this model; use it when that call has returned")
            }
            TryLockError::Poisoned(_) => {
                let message = "an internal error has broken this model; destroy it, and create it anew";
                Failure::new(enmm_status::ENMM_PANIC, message)
            }
        })
    }
}

/// A model and the log of its host.
pub struct Model {
    /// The façade.
    pub inner: Cosimulation,
    log: Log,
    warnings: Vec<String>,
    /// States of the blocks that the host looks at in place.
    pub(super) viewed: Vec<enmm_block_state>,
    pub(super) interrupt: Interrupt,
    /// Whether the slope had failed at the end of the last search for the initial equilibrium.
    has_failed_at_start: bool,
    /// The case, which records of results show.
    pub(super) loaded: LoadedCase,
    /// Whether the host has heard that recording has ended by itself.
    pub(super) lost_record: bool,
}

/// Messages of one call, and where they go.
#[derive(Default)]
pub struct Log {
    sink: Option<Sink>,
    pending_messages: Vec<(enmm_log_level, String)>,
}

impl Log {
    fn write(&mut self, level: enmm_log_level, message: impl FnOnce() -> String) {
        if self.sink.is_some() {
            self.pending_messages.push((level, message()));
        }
    }
}

/// Messages to be delivered when the model is free again, so that the host may call it.
pub struct Mail(Vec<(enmm_log_level, String)>);

impl Mail {
    /// Hands each message to the sink that is set by then: a callback may set another, or destroy the model.
    pub fn deliver(self, handle: usize, shared: &Shared) {
        for (level, message) in &self.0 {
            let alive = MODELS.find(handle).is_ok();
            let sink = shared.lock().ok().filter(|_| alive).and_then(|model| model.log.sink.clone());
            let Some(sink) = sink else { return };
            sink(*level, message);
        }
    }
}

/// Builds a model from a case file and returns its handle.
///
/// # Errors
/// The file cannot be read, or the case cannot be used.
pub fn create_from_file(path: &str) -> Result<usize, Failure> {
    create(load_case(Path::new(path))?)
}

/// Builds a model from the text of a case and returns its handle.
///
/// # Errors
/// The case cannot be used.
pub fn create_from_string(toml: &str, base_dir: &str) -> Result<usize, Failure> {
    create(parse_case(toml, "case", Path::new(base_dir))?)
}

/// Reads a case from text without a model of it; `base_dir` is where the files are that it names.
///
/// # Errors
/// The case cannot be used.
pub fn check_case(toml: &str, base_dir: &str) -> Result<(), Failure> {
    parse_case(toml, "case", Path::new(base_dir))?;
    Ok(())
}

fn create(loaded: LoadedCase) -> Result<usize, Failure> {
    let mut inner = loaded.cosimulation()?;
    let interrupt = Interrupt::default();
    inner.set_watch(Some(interrupt.watch(None)));
    let warnings = loaded.warnings.iter().chain(inner.warnings()).cloned().collect();
    let model = Model {
        inner,
        log: Log::default(),
        warnings,
        viewed: Vec::new(),
        interrupt: interrupt.clone(),
        has_failed_at_start: false,
        loaded,
        lost_record: false,
    };
    MODELS.insert(Shared { model: Mutex::new(model), owner: AtomicUsize::new(0), interrupt })
}

impl Model {
    /// Sets or takes away the host's log; a first one gets the warnings of the case.
    pub fn set_sink(&mut self, sink: Option<Sink>) {
        self.log.sink = sink;
        if self.log.sink.is_some() {
            for warning in std::mem::take(&mut self.warnings) {
                self.log.write(enmm_log_level::ENMM_LOG_WARNING, || warning);
            }
        }
    }

    /// Sets or takes away what sees the progress of calls.
    pub fn set_progress(&mut self, progress: Option<Progress>) {
        self.inner.set_watch(Some(self.interrupt.watch(progress)));
    }

    /// Messages that have come together.
    pub fn take_mail(&mut self) -> Mail {
        Mail(std::mem::take(&mut self.log.pending_messages))
    }

    /// Seeks the initial equilibrium.
    ///
    /// # Errors
    /// A numerical failure, or an interrupt.
    pub fn start(&mut self) -> Outcome {
        self.interrupt.clear();
        let was_started = self.inner.is_started();
        let result = self.inner.start().map_err(Failure::from);
        self.note_start(was_started);
        if let Err(failure) = &result {
            self.log_failure(failure);
        }
        self.log_start(was_started);
        self.log_record();
        result
    }

    /// How the search for the initial equilibrium ended.
    pub fn start_info(&self) -> enmm_start_info {
        let (is_started, unbalanced) = (self.inner.is_started(), self.inner.initial_residual());
        enmm_start_info {
            struct_size: size_of::<enmm_start_info>(),
            started: u32::from(is_started),
            settled: u32::from(is_started && unbalanced.is_none()),
            failed: u32::from(is_started && self.has_failed_at_start),
            reserved: 0,
            steps: self.inner.initial_steps(),
            unbalanced: unbalanced.unwrap_or_default(),
        }
    }

    /// Advances from `t` over `h`.
    ///
    /// # Errors
    /// Times that do not fit, a numerical failure, or an interrupt.
    pub fn do_step(&mut self, t: f64, h: f64) -> Result<enmm_step_info, Failure> {
        self.interrupt.clear();
        let was_started = self.inner.is_started();
        let result = self.cover(t, h).map_err(Failure::from);
        self.log_start(was_started);
        match &result {
            Ok(info) => self.log_step(info),
            Err(failure) => self.log_failure(failure),
        }
        self.log_record();
        let info = result?;
        Ok(enmm_step_info {
            struct_size: size_of::<enmm_step_info>(),
            time: info.time,
            steps: info.steps,
            dt: info.dt,
            event_count: info.events.len(),
            first_event: self.inner.events().len() - info.events.len(),
            halved: info.halved,
            unsettled: info.unsettled,
        })
    }

    /// Covers the interval, and looks at the initial equilibrium when the step begins with it.
    fn cover(&mut self, t: f64, h: f64) -> Result<StepInfo, CosimulationError> {
        let was_started = self.inner.is_started();
        let mut interval = self.inner.begin(t, h)?;
        self.note_start(was_started);
        while self.inner.advance(&mut interval)? {}
        Ok(interval.info().clone())
    }

    /// Notes whether the slope has failed in the initial equilibrium that has just been sought.
    fn note_start(&mut self, was_started: bool) {
        if !was_started && self.inner.is_started() {
            self.has_failed_at_start = self.inner.failure().is_some();
        }
    }

    /// Logs a call that failed; one that the host ended is no error.
    fn log_failure(&mut self, failure: &Failure) {
        let level = match failure.status {
            enmm_status::ENMM_INTERRUPTED => enmm_log_level::ENMM_LOG_INFO,
            _ => enmm_log_level::ENMM_LOG_ERROR,
        };
        self.log.write(level, || failure.message.clone());
    }

    /// Logs once that recording has ended by itself.
    fn log_record(&mut self) {
        if let (Some(fault), false) = (self.record_fault(), self.lost_record) {
            self.lost_record = true;
            self.log.write(enmm_log_level::ENMM_LOG_ERROR, || fault);
        }
    }

    /// Logs the initial equilibrium when this call has computed it.
    fn log_start(&mut self, was_started: bool) {
        if was_started || !self.inner.is_started() {
            return;
        }
        let steps = self.inner.simulation().state().step;
        let message = || format!("the initial equilibrium was sought in {steps} steps");
        self.log.write(enmm_log_level::ENMM_LOG_INFO, message);
        // Those of the call itself come later.
        let before: Vec<Event> = self.inner.events().take_while(|event| event.time <= 0.0).collect();
        before.iter().for_each(|event| self.log_event(event));
        if let Some(ratio) = self.inner.initial_residual() {
            let message = || {
                format!(
                    "the model is not at rest at time 0 (unbalanced ratio {ratio:.2e}): the slope moves, or its static \
                     stage needs a longer duration"
                )
            };
            self.log.write(enmm_log_level::ENMM_LOG_WARNING, message);
        }
        if self.log.sink.is_some() {
            self.warn_of_failure(self.inner.failure());
            self.warn_of(self.inner.doubt());
        }
    }

    /// Warns of a motion that is worthless, which no status reports.
    fn warn_of(&mut self, doubt: Option<String>) {
        if let Some(text) = doubt {
            self.log.write(enmm_log_level::ENMM_LOG_WARNING, || text);
        }
    }

    /// Warns of a slope that has failed: how much of it, how far and in which way.
    fn warn_of_failure(&mut self, failure: Option<SlopeFailure>) {
        self.warn_of(failure.map(|failure| format!("the slope has failed {failure}")));
    }

    fn log_event(&mut self, event: &Event) {
        let mesh_size = self.inner.case().mesh.size;
        let level = match event.kind {
            EventKind::Overlapped => enmm_log_level::ENMM_LOG_WARNING,
            EventKind::Detached | EventKind::Slipped | EventKind::Failed | EventKind::Broken | EventKind::Cut => {
                enmm_log_level::ENMM_LOG_INFO
            }
        };
        self.log.write(level, || sentence(event, mesh_size));
    }

    fn log_step(&mut self, info: &StepInfo) {
        for event in &info.events {
            self.log_event(event);
        }
        if info.unsettled > 0 {
            let (count, end) = (info.unsettled, info.time);
            let message =
                || format!("up to t = {} s: contact forces did not settle in {count} sub-steps", rounded(end));
            self.log.write(enmm_log_level::ENMM_LOG_WARNING, message);
        }
        self.warn_of_failure(info.failure);
        self.warn_of(info.doubt.clone());
    }

    /// How inputs go through a communication step, as a value of `enmm_interpolation`.
    pub fn interpolation(&self) -> i32 {
        match self.inner.interpolation() {
            Interpolation::Hold => enmm_interpolation::ENMM_INTERPOLATION_HOLD as i32,
            Interpolation::Linear => enmm_interpolation::ENMM_INTERPOLATION_LINEAR as i32,
        }
    }

    /// Sets how inputs go through a communication step.
    ///
    /// # Errors
    /// An unknown way.
    pub fn set_interpolation(&mut self, mode: i32) -> Outcome {
        let mode = interpolation(mode)?;
        self.inner.set_interpolation(mode);
        Ok(())
    }
}

/// The way that a number of C stands for.
///
/// # Errors
/// Another number.
pub fn interpolation(mode: i32) -> Result<Interpolation, Failure> {
    let hold = enmm_interpolation::ENMM_INTERPOLATION_HOLD as i32;
    let linear = enmm_interpolation::ENMM_INTERPOLATION_LINEAR as i32;
    match mode {
        _ if mode == hold => Ok(Interpolation::Hold),
        _ if mode == linear => Ok(Interpolation::Linear),
        _ => Err(Failure::invalid(format!("mode: is {mode}, must be {hold} (hold) or {linear} (linear)"))),
    }
}

/// An event in words; the mesh size (m) is what the depth of an overlap is compared with.
fn sentence(event: &Event, mesh_size: f64) -> String {
    let (subject, time) = (event.subject, rounded(event.time));
    match event.kind {
        EventKind::Detached => format!("t = {time} s: block {subject} lost its last contact"),
        EventKind::Slipped if subject == u32::MAX => format!("t = {time} s: a contact away from joints slipped"),
        EventKind::Slipped => format!("t = {time} s: joint {subject} slipped"),
        EventKind::Broken => format!("t = {time} s: the last bond of joint {subject} broke"),
        EventKind::Failed => format!("t = {time} s: block {subject} moved beyond the failure displacement"),
        EventKind::Cut => {
            format!("t = {time} s: block {subject} broke in two; the other part is block {}", event.other)
        }
        EventKind::Overlapped => {
            format!("t = {time} s: {}: results about them are wrong from here on", event.overlap_text(mesh_size))
        }
    }
}
