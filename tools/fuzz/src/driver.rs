//! The campaign: gives parts their turns, each in a child process, and keeps what they find.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use crate::parts::{PARTS, Part};
use crate::{USAGE, say};

/// Processor time after which an input counts as endless, far above what the slowest takes.
const PATIENCE: Duration = Duration::from_secs(60);
/// Times as long, by the clock, that it may take beside other work, or sleep.
const WAITS_MAX: u32 = 20;
/// Finds after which there is enough to look at.
const ENOUGH: usize = 40;

/// Options of a run.
pub struct Plan {
    minutes: Option<f64>,
    seed: u64,
    part: Option<String>,
    from: u64,
    inputs: Option<u64>,
    finds: PathBuf,
}

/// Work of a part so far.
#[derive(Default)]
struct Tally {
    inputs: u64,
    skipped: u64,
    calls: u64,
    seconds: f64,
    finds: u64,
}

/// How a child ended.
enum End {
    /// With all its inputs.
    Whole,
    /// At an input, for a reason.
    At(u64, String),
}

impl Plan {
    /// Reads the arguments.
    pub fn read(words: &[&str]) -> Result<Self, String> {
        let mut plan = Self { minutes: None, seed: 1, part: None, from: 0, inputs: None, finds: "finds".into() };
        for pair in words.chunks(2) {
            let [name, value] = *pair else { return Err(USAGE.to_owned()) };
            let number = || value.parse::<u64>().map_err(|_| format!("{name}: {value} is no number"));
            match name {
                "--minutes" => plan.minutes = Some(value.parse().map_err(|_| format!("{value} is no number"))?),
                "--seed" => plan.seed = number()?,
                "--part" => plan.part = Some(crate::parts::find(value)?.name.to_owned()),
                "--from" => plan.from = number()?,
                "--inputs" => plan.inputs = Some(number()?),
                "--finds" => plan.finds = value.into(),
                _ => return Err(USAGE.to_owned()),
            }
        }
        Ok(plan)
    }

    /// Runs the campaign; false when something was found.
    pub fn run(&self) -> Result<bool, String> {
        fs::create_dir_all(&self.finds).map_err(|error| format!("{}: {error}", self.finds.display()))?;
        let deadline = self.minutes.map(|minutes| Instant::now() + Duration::from_secs_f64(60.0 * minutes.max(0.0)));
        let mut tallies = BTreeMap::<&str, Tally>::new();
        let parts = || PARTS.iter().filter(|part| self.part.as_deref().is_none_or(|name| name == part.name));
        let mut turn = 0;
        loop {
            for part in parts() {
                let count = self.inputs.unwrap_or(part.turn);
                self.turn(part, self.from + turn * count, count, tallies.entry(part.name).or_default())?;
                let found: u64 = tallies.values().map(|tally| tally.finds).sum();
                if found as usize >= ENOUGH || deadline.is_some_and(|deadline| Instant::now() >= deadline) {
                    return Ok(close(self.seed, &tallies));
                }
            }
            turn += 1;
            if deadline.is_none() {
                return Ok(close(self.seed, &tallies));
            }
        }
    }

    /// Takes inputs of a part, with a new child after each one that ends a child.
    fn turn(&self, part: &Part, from: u64, count: u64, tally: &mut Tally) -> Result<(), String> {
        let (start, end) = (Instant::now(), from + count);
        let mut next = from;
        while next < end && (tally.finds as usize) < ENOUGH {
            let mut child = self.child(part, next, end - next, None)?;
            match self.listen(part, &mut child, tally)? {
                End::Whole => break,
                End::At(index, reason) => {
                    self.keep(part, index, &reason, tally)?;
                    next = index + 1;
                }
            }
        }
        tally.seconds += start.elapsed().as_secs_f64();
        Ok(())
    }

    fn child(&self, part: &Part, from: u64, count: u64, trace: Option<&PathBuf>) -> Result<Child, String> {
        let program = std::env::current_exe().map_err(|error| error.to_string())?;
        let complaints = self.finds.join(if trace.is_some() { "stderr-again" } else { "stderr" });
        let stderr = File::create(&complaints).map_err(|error| format!("{}: {error}", complaints.display()))?;
        let mut command = Command::new(program);
        command.args(["worker", part.name]).args([self.seed, from, count].map(|number| number.to_string())).args(trace);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(stderr);
        command.spawn().map_err(|error| format!("a child does not start: {error}"))
    }

    /// Follows a child to its end, or ends it when it is silent for too long.
    fn listen(&self, part: &Part, child: &mut Child, tally: &mut Tally) -> Result<End, String> {
        let lines = lines_of(child);
        let mut at = None;
        let silent = loop {
            let line = match next_line(&lines, child) {
                Ok(line) => line,
                Err(why) => break why == RecvTimeoutError::Timeout,
            };
            let mut words = line.splitn(3, ' ');
            let (kind, index) = (words.next().unwrap_or_default(), words.next().and_then(|word| word.parse().ok()));
            let Some(index) = index else { return Err(format!("{}: {line}", part.name)) };
            at = Some(index).filter(|_| kind == "at");
            tally.inputs += u64::from(kind == "done" || kind == "bad");
            match kind {
                "done" => tally.calls += words.next().and_then(|word| word.parse::<u64>().ok()).unwrap_or_default(),
                "skip" => tally.skipped += 1,
                "bad" => self.keep(part, index, words.next().unwrap_or_default(), tally)?,
                _ => (),
            }
        };
        if silent {
            let _ = child.kill();
        }
        let status = child.wait().map_err(|error| error.to_string())?;
        Ok(match at {
            None if status.success() => End::Whole,
            None => return Err(format!("{}: a child ended with {status} between two inputs", part.name)),
            Some(index) if silent => End::At(index, format!("no end within {} s", PATIENCE.as_secs())),
            Some(index) => {
                let complaint = fs::read_to_string(self.finds.join("stderr")).unwrap_or_default();
                End::At(index, format!("ended the process with {status}: {}", complaint.trim().replace('\n', " ")))
            }
        })
    }

    /// Writes what is known of a find, and the input as a second run of it shows it.
    fn keep(&self, part: &Part, index: u64, reason: &str, tally: &mut Tally) -> Result<(), String> {
        tally.finds += 1;
        let place = self.finds.join(format!("{}-{}-{index}", part.name, self.seed));
        fs::create_dir_all(&place).map_err(|error| format!("{}: {error}", place.display()))?;
        let again = format!("cargo xtask fuzz --part {} --seed {} --from {index} --inputs 1", part.name, self.seed);
        let told = format!("{reason}\nagain: {again}\n");
        fs::write(place.join("what"), &told).map_err(|error| format!("{}: {error}", place.display()))?;
        say(&format!("FOUND by {} in input {index}: {told}       input: {}", part.name, place.join("input").display()));
        let mut child = self.child(part, index, 1, Some(&place.join("input")))?;
        let lines = lines_of(&mut child);
        while lines.recv_timeout(PATIENCE).is_ok() {}
        let _ = child.kill();
        child.wait().map(|_| ()).map_err(|error| error.to_string())
    }
}

/// The next line of a child, waited for until it is silent for too long.
fn next_line(lines: &Receiver<String>, child: &Child) -> Result<String, RecvTimeoutError> {
    let before = processor_time(child);
    for _ in 1..WAITS_MAX {
        let line = lines.recv_timeout(PATIENCE);
        let is_over = || processor_time(child).zip(before).is_none_or(|(now, before)| now - before >= PATIENCE);
        if line != Err(RecvTimeoutError::Timeout) || is_over() {
            return line;
        }
    }
    lines.recv_timeout(PATIENCE)
}

/// Processor time of a child so far; none where the system has no such file.
fn processor_time(child: &Child) -> Option<Duration> {
    let stat = fs::read_to_string(format!("/proc/{}/stat", child.id())).ok()?;
    // User and system time, in hundredths of a second, are the 14th and 15th word; the second is a name in brackets.
    let words = stat.rsplit_once(')')?.1.split_whitespace().skip(11).take(2);
    Some(Duration::from_millis(10 * words.filter_map(|word| word.parse::<u64>().ok()).sum::<u64>()))
}

/// Lines of the standard output of a child, as they come.
fn lines_of(child: &mut Child) -> Receiver<String> {
    let (tell, lines) = channel();
    if let Some(stdout) = child.stdout.take() {
        std::thread::spawn(move || {
            BufReader::new(stdout).lines().map_while(Result::ok).try_for_each(|line| tell.send(line))
        });
    }
    lines
}

/// Prints what was done; true when nothing was found.
fn close(seed: u64, tallies: &BTreeMap<&str, Tally>) -> bool {
    say(&format!(
        "seed {seed}\n{:<10} {:>9} {:>9} {:>11} {:>8} {:>6}",
        "part", "inputs", "left out", "calls", "s", "finds"
    ));
    for (name, Tally { inputs, skipped, calls, seconds, finds }) in tallies {
        say(&format!("{name:<10} {inputs:>9} {skipped:>9} {calls:>11} {seconds:>8.1} {finds:>6}"));
    }
    let found: u64 = tallies.values().map(|tally| tally.finds).sum();
    say(&format!("{found} found"));
    found == 0
}
