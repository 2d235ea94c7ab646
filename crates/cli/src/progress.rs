//! How a run shows on the screen: a bar on a terminal, plain lines elsewhere, nothing when it is to be quiet.

use std::io::{IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use enmm::model::BuildStage;
use enmm_run::{EnsembleProgress, Observer, RunProgress};
use indicatif::{ProgressBar, ProgressStyle};

/// Time between plain lines.
const LINES: Duration = Duration::from_secs(5);
/// Time after which parts of a build are printed.
const BUILD: Duration = Duration::from_secs(1);
/// Time between changes of the bar.
const REDRAW: Duration = Duration::from_millis(100);
/// Steps of the bar.
const BAR: u64 = 1000;

/// A bar of some length on a terminal; none elsewhere, or when it is to be quiet.
fn terminal_bar(quiet: bool, length: u64, template: &str) -> Bar {
    let style = || ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
    let terminal = std::io::stderr().is_terminal() && !quiet;
    Bar(terminal.then(|| ProgressBar::new(length).with_style(style())))
}

/// The bar of a command, removed from the screen when it is dropped.
struct Bar(Option<ProgressBar>);

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.iter().for_each(ProgressBar::finish_and_clear);
    }
}

/// Shows how a build and a run go.
pub struct Screen {
    bar: Bar,
    quiet: bool,
    start: Instant,
    start_time: Option<f64>,
    shown: Option<Instant>,
    stage: usize,
}

impl Screen {
    /// A bar on a terminal, plain lines elsewhere.
    pub fn new(quiet: bool) -> Self {
        let bar = terminal_bar(quiet, BAR, "{wide_bar} {percent:>3} %  {msg}");
        Self { bar, quiet, start: Instant::now(), start_time: None, shown: None, stage: 0 }
    }

    fn line(&self, progress: &RunProgress) -> String {
        let RunProgress { stage, stage_number, stage_count, time, time_left, time_expected, unbalanced, .. } =
            *progress;
        let wall = self.start.elapsed().as_secs_f64();
        let rate = (time - self.start_time.unwrap_or(time)) / wall.max(1e-9);
        let left = match (time_expected, rate > 0.0) {
            (_, false) => "time left unknown yet".to_owned(),
            (Some(expected), true) => format!("about {} left", clock(expected / rate)),
            (None, true) => format!("at most {} left", clock(time_left / rate)),
        };
        let fall =
            unbalanced.map_or_else(String::new, |[now, target]| format!("unbalanced {now:.1e} → {target:.0e}  "));
        format!("{stage} ({stage_number}/{stage_count})  simulated {time:.4} s ({rate:.3} s per second)  {fall}{left}")
    }
}

impl Observer for Screen {
    fn build(&mut self, stage: BuildStage) {
        let line = format!("building the model: {}", stage.name());
        match &self.bar.0 {
            Some(bar) => {
                bar.set_position((BAR as f64 * stage.share()) as u64);
                bar.set_message(line);
                bar.tick();
            }
            // A small model is built before anyone would read this.
            None if !self.quiet && self.start.elapsed() >= BUILD => drop(writeln!(std::io::stderr(), "{line}")),
            None => {}
        }
    }

    fn step(&mut self, progress: &RunProgress) {
        if self.start_time.is_none() {
            (self.start, self.start_time) = (Instant::now(), Some(progress.time));
        }
        if self.quiet {
            return;
        }
        let wait = if self.bar.0.is_some() { REDRAW } else { LINES };
        let due = self.shown.is_none_or(|shown| shown.elapsed() >= wait) || self.stage != progress.stage_number;
        if !due {
            return;
        }
        self.shown = Some(Instant::now());
        self.stage = progress.stage_number;
        let line = self.line(progress);
        match &self.bar.0 {
            Some(bar) => {
                let whole = progress.time + progress.time_expected.unwrap_or(progress.time_left);
                let share = (BAR as f64 * progress.time / whole.max(f64::MIN_POSITIVE)) as u64;
                bar.set_position(share.max(bar.position()));
                bar.set_message(line);
            }
            None => drop(writeln!(std::io::stderr(), "{line}")),
        }
    }

    fn note(&mut self, message: &str) {
        self.tell(&format!("note: {message}"));
    }

    fn warn(&mut self, message: &str) {
        self.tell(&format!("warning: {message}"));
    }
}

impl Screen {
    /// Writes a line above the bar.
    fn tell(&self, line: &str) {
        match &self.bar.0 {
            _ if self.quiet => {}
            Some(bar) => bar.suspend(|| drop(writeln!(std::io::stderr(), "{line}"))),
            None => drop(writeln!(std::io::stderr(), "{line}")),
        }
    }
}

/// Shows on a terminal how a search for a factor of safety goes.
pub struct Search {
    bar: Bar,
    start: Instant,
}

impl Search {
    /// A bar on a terminal; nothing elsewhere, or when it is to be quiet.
    pub fn new(quiet: bool) -> Self {
        let bar = terminal_bar(quiet, 0, "{spinner} {bar:30} {msg}  ({elapsed})");
        if let Some(bar) = &bar.0 {
            bar.set_message("the slope comes to rest before the first trial");
            bar.enable_steady_tick(REDRAW);
        }
        Self { bar, start: Instant::now() }
    }

    /// Prints by a function while the bar is away, and goes on after `done` of about `expected` trials.
    pub fn trial(&self, done: usize, expected: usize, print: impl FnOnce()) {
        let Some(bar) = &self.bar.0 else { return print() };
        bar.suspend(print);
        let left = self.start.elapsed().as_secs_f64() * (expected - done.min(expected)) as f64 / done.max(1) as f64;
        bar.set_length(expected as u64);
        bar.set_position(done as u64);
        bar.set_message(format!("{done} of about {expected} trials, about {} left", clock(left)));
    }
}

/// Shows how an ensemble goes: a bar on a terminal, plain lines elsewhere.
pub struct Count {
    bar: Bar,
    quiet: bool,
    shown: Mutex<Shown>,
}

/// Last line of an ensemble on the screen.
#[derive(Default)]
struct Shown {
    /// When it was printed, where there is no bar.
    printed: Option<Instant>,
    /// The line, without the last trial.
    text: String,
}

impl Count {
    /// Nothing when it is to be quiet.
    pub fn new(quiet: bool) -> Self {
        let bar = terminal_bar(quiet, 0, "{wide_bar} {msg}");
        Self { bar, quiet, shown: Mutex::default() }
    }

    /// Samples are done.
    pub fn tell(&self, progress: &EnsembleProgress) {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        let EnsembleProgress { stored, done, wanted, .. } = *progress;
        let is_an_end = done == stored || done == wanted;
        shown.text = line(progress);
        match &self.bar.0 {
            Some(bar) => {
                bar.set_length(wanted as u64);
                bar.set_position(done as u64);
                bar.set_message(shown.text.clone());
            }
            None if self.quiet || wanted == 0 => {}
            None if is_an_end || shown.printed.is_none_or(|last| last.elapsed() >= LINES) => {
                shown.printed = Some(Instant::now());
                drop(writeln!(std::io::stderr(), "{}", shown.text));
            }
            None => {}
        }
    }

    /// A trial of a sample has ended.
    pub fn trial(&self, sample: usize, text: &str) {
        if let Some(bar) = &self.bar.0 {
            let shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
            bar.set_message(format!("{}; sample {sample}: {text}", shown.text));
        }
    }
}

/// How many samples are done, how many of them fail, which took longest, and how long the others will take.
fn line(progress: &EnsembleProgress) -> String {
    let EnsembleProgress { output, begun, stored, done, wanted, answered, below, slowest } = *progress;
    let rate = (done - stored) as f64 / begun.elapsed().as_secs_f64().max(1e-9);
    let mut line = format!("{done} of {wanted} samples ({})", output.name().replace('_', " "));
    if answered > 0 {
        line += &format!(", {below} below the limit ({:.3})", below as f64 / answered as f64);
    }
    if let Some((sample, seconds)) = slowest.filter(|(_, seconds)| *seconds >= 1.0) {
        line += &format!(", slowest {sample} ({})", clock(seconds));
    }
    if rate > 0.0 && done < wanted {
        line += &format!(", about {} left", clock((wanted - done) as f64 / rate));
    }
    line
}

/// `1 h 02 min`, `3 min 05 s` or `7 s`.
fn clock(seconds: f64) -> String {
    let whole = seconds.min(1e12).ceil() as u64;
    match (whole / 3600, whole / 60 % 60, whole % 60) {
        (0, 0, s) => format!("{s} s"),
        (0, m, s) => format!("{m} min {s:02} s"),
        (h, m, _) => format!("{h} h {m:02} min"),
    }
}
