//! Folders of the runs, the undisturbed results, and what it takes to compare with them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::repository::{Repository, files_of, fresh, remove, write};

const CASE: &str = include_str!("case.toml");
/// Results that hold wall times, or the same frames and rows in other pieces.
const MAY_DIFFER: [&str; 3] = ["summary.json", "film.bin", "report.html"];
/// Wall time after which a run counts as endless.
const PATIENCE: Duration = Duration::from_secs(120);

/// Where the runs are.
pub struct Place {
    program: PathBuf,
    folder: PathBuf,
    whole: BTreeMap<String, Vec<u8>>,
    /// Wall time of the undisturbed run.
    pub duration: Duration,
}

impl Place {
    /// Makes the folder and runs the case undisturbed.
    pub fn new(repository: &Repository) -> Result<Self, String> {
        let folder = fresh(repository.target.join("faults"))?;
        write(&folder.join("case.toml"), CASE)?;
        let mut place =
            Self { program: repository.enmm(), folder, whole: BTreeMap::new(), duration: Duration::default() };
        let start = Instant::now();
        let answer = place.finish(place.start("whole", None)?)?;
        place.duration = start.elapsed();
        if !answer.status.success() {
            return Err(format!("the undisturbed run ended with {}: {}", answer.status, complaint(&answer)));
        }
        place.whole = files_of(&place.path("whole"))?;
        Ok(place)
    }

    /// A path in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// A folder for results that is not there yet.
    pub fn fresh(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.path(name);
        remove(&path)?;
        Ok(path)
    }

    /// The program in the folder.
    pub fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(&self.program);
        command.args(words).current_dir(&self.folder);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Starts a run into `name`, from a checkpoint where one is given.
    pub fn start(&self, name: &str, resume: Option<&Path>) -> Result<Child, String> {
        let mut command = self.command(&["run", "case.toml", "--quiet", "--threads", "1", "-o", name]);
        if let Some(checkpoint) = resume {
            command.arg("--resume").arg(checkpoint);
        }
        command.spawn().map_err(|error| format!("the program does not start: {error}"))
    }

    /// Waits for the end of a run; one that does not end is ended, and an error.
    pub fn finish(&self, mut child: Child) -> Result<Output, String> {
        let start = Instant::now();
        while child.try_wait().map_err(|error| error.to_string())?.is_none() {
            if start.elapsed() > PATIENCE {
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("no end within {} s", PATIENCE.as_secs()));
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        child.wait_with_output().map_err(|error| error.to_string())
    }

    /// Goes on from the checkpoint in `name`, or from the start where there is none, to the end; compares.
    pub fn complete(&self, name: &str) -> Result<(), String> {
        let checkpoint = self.path(name).join("checkpoint.enmm");
        let answer = self.finish(self.start(name, Some(checkpoint.as_path()).filter(|path| path.exists()))?)?;
        if !answer.status.success() {
            return Err(format!("the run that went on ended with {}: {}", answer.status, complaint(&answer)));
        }
        self.compare(name)
    }

    /// Compares results with those of the undisturbed run.
    pub fn compare(&self, name: &str) -> Result<(), String> {
        let found = files_of(&self.path(name))?;
        let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
        let missing: Vec<String> = names(&self.whole).into_iter().filter(|name| !found.contains_key(name)).collect();
        let more: Vec<String> = names(&found).into_iter().filter(|name| !self.whole.contains_key(name)).collect();
        if !missing.is_empty() || !more.is_empty() {
            return Err(format!("files missing in {name}: {missing:?}; too many: {more:?}"));
        }
        let differ = |file: &&String| !MAY_DIFFER.contains(&file.as_str()) && self.whole[*file] != found[*file];
        let others: Vec<&String> = found.keys().filter(differ).collect();
        if others.is_empty() { Ok(()) } else { Err(format!("other bytes in {name}: {others:?}")) }
    }
}

/// Complaint of a run.
pub fn complaint(answer: &Output) -> String {
    String::from_utf8_lossy(&answer.stderr).trim().to_owned()
}

/// An error unless a run named the fault in one line and ended with a status of the program's own.
pub fn refused(answer: &Output, names: &str) -> Result<String, String> {
    let told = complaint(answer);
    let good = matches!(answer.status.code(), Some(2 | 3)) && told.starts_with("error: ") && told.lines().count() == 1;
    match good && told.contains(names) {
        true => Ok(format!("status {}, {told:?}", answer.status.code().unwrap_or_default())),
        false => Err(format!("ended with {} and told {told:?}, which should name {names}", answer.status)),
    }
}
