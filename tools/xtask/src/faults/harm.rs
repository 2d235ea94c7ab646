//! The faults one by one.

use std::fs::{self, OpenOptions};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use super::place::{Place, complaint, refused};
use crate::steps::Verdict;

/// Runs that are ended before one may reach its end.
const KILLS: usize = 3;

/// A part of the duration of the undisturbed run, different every time: when a fault strikes is nothing that a seed
/// could repeat.
fn moment(place: &Place) -> Duration {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    place.duration.mul_f64(f64::from(now.subsec_micros() % 1000) / 1000.0)
}

/// Ends a child that was started here.
fn signal(name: &str, id: u32) -> Result<(), String> {
    let sent = Command::new("kill").args([name, &id.to_string()]).stderr(Stdio::null()).status();
    sent.map(|_| ()).map_err(|error| format!("kill does not run: {error}"))
}

pub fn killed(place: &Place, _round: u64) -> Result<Verdict, String> {
    let folder = place.fresh("killed")?;
    let (mut kills, mut moments) = (0, Vec::new());
    for _ in 0..KILLS {
        let checkpoint = folder.join("checkpoint.enmm");
        let mut child = place.start("killed", Some(checkpoint.as_path()).filter(|path| path.exists()))?;
        let moment = moment(place);
        std::thread::sleep(moment);
        moments.push(moment.as_millis());
        if child.try_wait().is_ok_and(|status| status.is_none()) {
            child.kill().map_err(|error| error.to_string())?;
            kills += 1;
        }
        let answer = place.finish(child)?;
        if answer.status.code().is_some_and(|code| code != 0) {
            return Err(format!("a run that went on ended with {}: {}", answer.status, complaint(&answer)));
        }
    }
    place.complete("killed").map_err(|harm| format!("{kills} kills after {moments:?} ms: {harm}"))?;
    Ok(Verdict::Good(format!("{kills} kills after {moments:?} ms, same bits")))
}

pub fn interrupted(place: &Place, round: u64) -> Result<Verdict, String> {
    let name = if round.is_multiple_of(2) { "-INT" } else { "-TERM" };
    let folder = place.fresh("interrupted")?;
    let child = place.start("interrupted", None)?;
    // Before the results are there a signal may end the program at once: nothing is lost then.
    while !folder.join("history.csv").exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(moment(place).mul_f64(0.5));
    signal(name, child.id())?;
    let answer = place.finish(child)?;
    if !matches!(answer.status.code(), Some(0 | 130)) {
        return Err(format!("{name} ended it with {}: {}", answer.status, complaint(&answer)));
    }
    if !folder.join("checkpoint.enmm").exists() {
        return Err(format!("{name} left no checkpoint"));
    }
    place.complete("interrupted")?;
    Ok(Verdict::Good(format!("{name}, status {}, same bits", answer.status.code().unwrap_or_default())))
}

pub fn closed_pipe(place: &Place, _round: u64) -> Result<Verdict, String> {
    place.fresh("pipe")?;
    let mut child = place.command(&["run", "case.toml", "--threads", "1", "-o", "pipe"]).spawn();
    let child = child.as_mut().map_err(|error| error.to_string())?;
    drop(child.stdout.take());
    drop(child.stderr.take());
    let status = child.wait().map_err(|error| error.to_string())?;
    if !status.success() {
        return Err(format!("ended with {status}"));
    }
    place.compare("pipe")?;
    Ok(Verdict::Good("status 0, same bits".to_owned()))
}

pub fn full_device(place: &Place, _round: u64) -> Result<Verdict, String> {
    place.fresh("device")?;
    let device = || OpenOptions::new().write(true).open("/dev/full");
    if let Err(error) = device() {
        return Ok(Verdict::LeftOut(format!("/dev/full: {error}")));
    }
    let mut seen = Vec::new();
    for words in [vec!["run", "case.toml", "-o", "device"], vec!["check", "case.toml"], vec!["schema"]] {
        let open = || device().map(Stdio::from).map_err(|error| error.to_string());
        let status = place.command(&words).stdout(open()?).stderr(open()?).status();
        let status = status.map_err(|error| error.to_string())?;
        seen.push(status.code());
        if !matches!(status.code(), Some(0 | 2 | 3)) {
            return Err(format!("`enmm {}` ended with {status}", words.join(" ")));
        }
    }
    place.compare("device")?;
    Ok(Verdict::Good(format!("run, check, schema: {seen:?}, results whole")))
}

pub fn read_only(place: &Place, _round: u64) -> Result<Verdict, String> {
    let Some(disk) = Disk::new(place, "read-only", "1m") else { return Ok(Verdict::LeftOut(NO_DISK.to_owned())) };
    disk.again("ro")?;
    let answer = place.finish(place.start("read-only", None)?)?;
    let seen = refused(&answer, "read-only")?;
    disk.again("rw,size=64m")?;
    place.complete("read-only")?;
    Ok(Verdict::Good(format!("{seen}; then same bits")))
}

/// The disk has room for a part of the results, more in every round; then it grows and the run goes on.
pub fn full_disk(place: &Place, round: u64) -> Result<Verdict, String> {
    let room = [64, 160, 256, 384, 512, 640][round as usize % 6];
    let Some(disk) = Disk::new(place, "full", &format!("{room}k")) else {
        return Ok(Verdict::LeftOut(NO_DISK.to_owned()));
    };
    let answer = place.finish(place.start("full", None)?)?;
    if answer.status.success() {
        return place.compare("full").map(|()| Verdict::Good(format!("{room} kB were enough, same bits")));
    }
    let seen = refused(&answer, "full")?;
    disk.again("size=64m")?;
    let from = if place.path("full/checkpoint.enmm").exists() { "its checkpoint" } else { "the start" };
    place.complete("full").map_err(|harm| format!("{room} kB, {seen}; then from {from}: {harm}"))?;
    Ok(Verdict::Good(format!("{room} kB: {seen}; then from {from}, same bits")))
}

/// A run whose folder is taken away says so, or had whole results there; never a part of them and a good status.
pub fn vanished(place: &Place, _round: u64) -> Result<Verdict, String> {
    let (folder, away) = (place.fresh("vanished")?, place.fresh("vanished-away")?);
    let child = place.start("vanished", None)?;
    while !folder.join("history.csv").exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(moment(place).mul_f64(0.1));
    fs::rename(&folder, away).map_err(|error| error.to_string())?;
    let answer = place.finish(child)?;
    if answer.status.success() {
        return place.compare("vanished-away").map(|()| Verdict::Good("it was at its end, same bits".to_owned()));
    }
    refused(&answer, "vanished").map(Verdict::Good)
}

pub fn no_folder(place: &Place, _round: u64) -> Result<Verdict, String> {
    let before = fs::read(place.path("case.toml")).map_err(|error| error.to_string())?;
    let answer = place.finish(place.start("case.toml", None)?)?;
    let seen = refused(&answer, "case.toml")?;
    let after = fs::read(place.path("case.toml")).map_err(|error| error.to_string())?;
    if before == after { Ok(Verdict::Good(seen)) } else { Err("the file was overwritten".to_owned()) }
}

/// The second run is refused while the first is there, with its number; each leaves the results of a whole run.
pub fn together(place: &Place, _round: u64) -> Result<Verdict, String> {
    place.fresh("together")?;
    let first = place.start("together", None)?;
    std::thread::sleep(moment(place).mul_f64(0.7));
    let second = place.start("together", None)?;
    let number = first.id().to_string();
    let answers = [place.finish(first)?, place.finish(second)?];
    let codes = answers.each_ref().map(|answer| answer.status.code());
    let told = answers.each_ref().map(complaint);
    // The first may have been at its end.
    let refused = told[1].contains(&format!("process {number} is writing its results here"));
    if codes[0] != Some(0) || !(codes[1] == Some(0) || codes[1] == Some(2) && refused) {
        return Err(format!("they ended with {codes:?}: {told:?}"));
    }
    place.compare("together").map_err(|harm| format!("they ended with {codes:?}; {harm}"))?;
    Ok(Verdict::Good(format!("they ended with {codes:?}, same bits")))
}

const NO_DISK: &str = "a disk of its own can only be made by root";

/// A disk in memory, mounted over a folder of the place; it goes away at the end.
struct Disk<'a> {
    place: &'a Place,
    name: &'a str,
}

impl<'a> Disk<'a> {
    /// Makes one of a size; none where that is not allowed.
    fn new(place: &'a Place, name: &'a str, size: &str) -> Option<Self> {
        place.fresh(name).ok()?;
        fs::create_dir_all(place.path(name)).ok()?;
        mount(&["-t", "tmpfs", "-o", &format!("size={size}"), "tmpfs"], &place.path(name)).ok()?;
        Some(Self { place, name })
    }

    /// Changes its size or whether it can be written to.
    fn again(&self, how: &str) -> Result<(), String> {
        mount(&["-o", &format!("remount,{how}")], &self.place.path(self.name))
    }
}

impl Drop for Disk<'_> {
    fn drop(&mut self) {
        // One that stays mounted is reported when the folder is next made.
        let _ = Command::new("umount").arg(self.place.path(self.name)).stderr(Stdio::null()).status();
    }
}

fn mount(words: &[&str], folder: &Path) -> Result<(), String> {
    let status = Command::new("mount").args(words).arg(folder).stderr(Stdio::null()).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        other => Err(format!("mount {}: {other:?}", words.join(" "))),
    }
}
