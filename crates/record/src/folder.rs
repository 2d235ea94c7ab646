//! The folder of results of a command: looked at before anything is written, and held by one process at a time.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use enmm_io::files::{at_path, is_running, read_result, unfinished_name};
use same_file::Handle;
use serde_json::Value;

use crate::along::ALONG;
use crate::flow::FLOW;
use crate::lines::LINES;

/// Name of the file by which a process holds a folder.
const LOCK: &str = ".enmm.lock";
/// Most attempts to take it.
const TURNS: usize = 100;
/// Name of the store of samples, unless another is given.
pub const STORE: &str = "ensemble.sqlite";
/// Folder of frames in a folder of results.
pub(crate) const FRAMES: &str = "frames";
/// Names of results beside the pictures of stages.
const FILES: [&str; 48] = [
    "blocks.csv",
    ALONG,
    "bound.json",
    "checkpoint.enmm",
    "covers.png",
    "covers.svg",
    "deformed.png",
    "deformed.svg",
    "earthquake.csv",
    "energy.png",
    "energy.svg",
    "ensemble.csv",
    "ensemble.json",
    "ensemble.png",
    "ensemble.svg",
    STORE,
    "failure.png",
    "failure.svg",
    "film.bin",
    FLOW,
    "fos.csv",
    "fos.json",
    "fos.png",
    "fos.svg",
    "history.csv",
    "history.png",
    "history.svg",
    LINES,
    "model.png",
    "model.svg",
    "record.png",
    "record.svg",
    "report.html",
    "report_a4.html",
    "report_a4.pdf",
    "run.pvd",
    "seismic.csv",
    "seismic.png",
    "seismic.svg",
    "spectra.csv",
    "spectra.png",
    "spectra.svg",
    "summary.json",
    "sweep.csv",
    "sweep.json",
    "sweep.png",
    "sweep.svg",
    "sweep.xlsx",
];

/// A folder of results that no other process writes to until this is dropped.
#[derive(Debug)]
pub struct Folder {
    /// Folders that were made for it, outermost first.
    made: Vec<PathBuf>,
    lock: Option<Lock>,
}

/// A lock that its process holds; the system takes it back when the process ends in any way.
#[derive(Debug)]
struct Lock {
    path: PathBuf,
    _file: File,
}

impl Folder {
    /// Makes a folder or takes one that is there, and removes what killed processes left half written in it.
    ///
    /// # Errors
    /// Another process holds it; a result would replace one of the `inputs`; the name of a result is taken by what is
    /// no regular file; or whatever the file system refuses. Each names the path.
    pub fn open(path: &Path, inputs: &[PathBuf]) -> io::Result<Self> {
        let mut folder = Self { made: Vec::new(), lock: None };
        for missing in missing_folders(path) {
            fs::create_dir(missing).map_err(at_path(missing))?;
            folder.made.push(missing.to_owned());
        }
        if !path.is_dir() {
            return Err(taken(path, "is no directory"));
        }
        let inputs = handles(inputs);
        check_lock(&path.join(LOCK), &inputs)?;
        folder.lock = Some(Lock::take(path)?);
        check(path, &inputs)?;
        sweep(path)?;
        Ok(folder)
    }
}

impl Drop for Folder {
    /// Gives the folder free; what was made for it and holds nothing goes again.
    fn drop(&mut self) {
        self.lock = None;
        for made in self.made.iter().rev() {
            // One that has results stays.
            let _ = fs::remove_dir(made);
        }
    }
}

/// Removes results that killed processes have left unfinished.
fn sweep(folder: &Path) -> io::Result<()> {
    for name in names(folder)? {
        // Where the system lists its processes, one that still writes is left alone.
        if unfinished_result(&name).is_some_and(|process| !is_running(process)) {
            let path = folder.join(name);
            fs::remove_file(&path).map_err(at_path(&path))?;
        }
    }
    Ok(())
}

/// The process that has begun a result, of a path in a folder of results that is the name of an unfinished one.
fn unfinished_result(path: &Path) -> Option<u32> {
    let (name, process) = unfinished_name(path.file_name()?.to_str()?)?;
    is_result(&path.with_file_name(name)).then_some(process)
}

/// Makes the folder of frames in a folder of results, unless it is there.
pub fn make_frames(directory: &Path) -> io::Result<()> {
    let frames = directory.join(FRAMES);
    match fs::create_dir(&frames) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(()),
        made => made.map_err(at_path(&frames)),
    }
}

/// The folders of a path that are not there, outermost first.
fn missing_folders(path: &Path) -> Vec<&Path> {
    let is_missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
    let mut missing: Vec<&Path> = path.ancestors().take_while(is_missing).collect();
    missing.reverse();
    missing
}

impl Lock {
    fn take(folder: &Path) -> io::Result<Self> {
        let path = folder.join(LOCK);
        for _ in 0..TURNS {
            let opened = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
            let mut file = opened.map_err(at_path(&path))?;
            match file.try_lock() {
                Err(TryLockError::WouldBlock) => return Err(held(folder, &mut file)),
                Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
                Err(TryLockError::Error(error)) => return Err(at_path(&path)(error)),
                Ok(()) => {}
            }
            // The process that held it may have removed it between the two calls above.
            if is_at(&file, &path).map_err(at_path(&path))? {
                let written = file.set_len(0).and_then(|()| write!(file, "{}", std::process::id()));
                let lock = Self { path, _file: file };
                written.map_err(at_path(&lock.path))?;
                return Ok(lock);
            }
        }
        Err(taken(&path, "is another file at each look: choose a directory of another file system"))
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Whoever finds it later takes it over.
        let _ = fs::remove_file(&self.path);
    }
}

/// Whether a path leads to a file; one that is gone does not.
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    match Handle::from_path(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        there => Ok(Handle::from_file(file.try_clone()?)? == there?),
    }
}

fn held(folder: &Path, lock: &mut File) -> io::Error {
    let mut number = String::new();
    // Some systems let nobody read a locked file.
    let read = lock.read_to_string(&mut number).is_ok() && number.parse::<u32>().is_ok();
    let process = if read { format!("process {number}") } else { "another process".to_owned() };
    io::Error::new(io::ErrorKind::ResourceBusy, format!("{}: {process} is writing its results here", folder.display()))
}

/// Files of results that name their case.
const RECORDS: [&str; 5] = ["bound.json", "ensemble.json", "fos.json", "summary.json", "sweep.json"];
/// Largest of them that is read (bytes).
const RECORD_MAX: u64 = 256 << 20;

/// Refuses a folder that holds results of another case than the one of a file.
///
/// # Errors
/// The other case, and the remedy.
pub fn check_owner(folder: &Path, case_file: &str) -> io::Result<()> {
    let owners = RECORDS.iter().filter_map(|name| owner(&folder.join(name)));
    match owners.into_iter().find(|owner| !is_one_case(owner, case_file)) {
        None => Ok(()),
        Some(other) => Err(io::Error::new(
            io::ErrorKind::AlreadyExists,
            format!(
                "{}: holds results of another case, {other}: choose another directory with -o, or replace them with \
                 --force",
                folder.display()
            ),
        )),
    }
}

/// The case file that a record names.
fn owner(record: &Path) -> Option<String> {
    let record: Value = serde_json::from_slice(&read_result(record, RECORD_MAX).ok()?).ok()?;
    Some(record["case_file"].as_str()?.to_owned())
}

/// Whether two paths name one file; of one that is not to be found, as one that was given from elsewhere, the name
/// decides.
fn is_one_case(a: &str, b: &str) -> bool {
    same_file::is_same_file(a, b).unwrap_or_else(|_| Path::new(a).file_name() == Path::new(b).file_name())
}

/// Whether a path in a folder of results is the name of a result.
pub fn is_result(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    match path.parent() {
        Some(parent) if parent == Path::new(FRAMES) => name.ends_with(".vtu"),
        Some(parent) if parent == Path::new("") => FILES.contains(&name) || is_stage_picture(name),
        _ => false,
    }
}

/// Whether a name is that of a picture of a stage, such as `stage1_joints.png`.
fn is_stage_picture(name: &str) -> bool {
    let rest = name.strip_prefix("stage").and_then(|rest| rest.strip_suffix(".png").or(rest.strip_suffix(".svg")));
    rest.and_then(|rest| rest.split_once('_')).is_some_and(|(number, _)| number.parse::<u32>().is_ok())
}

/// Looks at the place of the lock, into which a number is written: a link would lead it into another file.
fn check_lock(path: &Path, inputs: &[(&Path, Handle)]) -> io::Result<()> {
    let Ok(metadata) = fs::symlink_metadata(path) else { return Ok(()) };
    if !metadata.is_file() || has_other_names(&metadata) {
        return Err(taken(path, "is no file of its own, but a lock goes into a file of this name"));
    }
    check_against(path, inputs)
}

#[cfg(unix)]
fn has_other_names(metadata: &fs::Metadata) -> bool {
    std::os::unix::fs::MetadataExt::nlink(metadata) > 1
}

#[cfg(not(unix))]
fn has_other_names(_: &fs::Metadata) -> bool {
    false
}

/// Looks at all that has the name of a result, or of one that is not finished, which is removed.
fn check(folder: &Path, inputs: &[(&Path, Handle)]) -> io::Result<()> {
    let frames = folder.join(FRAMES);
    if frames.is_symlink() || frames.exists() && !frames.is_dir() {
        return Err(taken(
            &frames,
            "is no directory, or a link to one, but frames go into a directory of this name, and old ones leave it",
        ));
    }
    let goes = |name: &PathBuf| is_result(name) || unfinished_result(name).is_some();
    let results = names(folder)?.into_iter().filter(goes);
    results.map(|name| folder.join(name)).try_for_each(|path| check_against(&path, inputs))
}

/// Looks at the place of a result that is not in a folder of its own, such as an FMU.
///
/// # Errors
/// The file is one of the `inputs`, or no regular file; with the path in the message.
pub fn check_output(path: &Path, inputs: &[PathBuf]) -> io::Result<()> {
    check_against(path, &handles(inputs))
}

/// Makes a directory for results and looks at the places of its `files`, before the work that leads to them.
///
/// # Errors
/// The directory cannot be made, or one of the files is there and no regular file; with the path in the message.
pub fn make_place(directory: &Path, files: &[&str]) -> io::Result<()> {
    fs::create_dir_all(directory).map_err(|error| {
        let place = directory.display();
        io::Error::new(error.kind(), format!("cannot write to {place} ({error}): choose another directory"))
    })?;
    files.iter().try_for_each(|file| check_output(&directory.join(file), &[]))
}

/// Inputs that are files, with what the system knows them by; to ask that of a pipe would wait for its other end.
fn handles(inputs: &[PathBuf]) -> Vec<(&Path, Handle)> {
    let files = inputs.iter().filter(|input| input.is_file());
    files.filter_map(|input| Some((input.as_path(), Handle::from_path(input).ok()?))).collect()
}

fn check_against(path: &Path, inputs: &[(&Path, Handle)]) -> io::Result<()> {
    let Ok(metadata) = fs::metadata(path) else { return Ok(()) };
    if !metadata.is_file() {
        return Err(taken(path, "is no regular file, but a result goes into a file of this name"));
    }
    let handle = Handle::from_path(path).map_err(at_path(path))?;
    match inputs.iter().find(|(_, input)| *input == handle) {
        Some((input, _)) => {
            Err(taken(path, &format!("a result would replace this, which is the input {}", input.display())))
        }
        None => Ok(()),
    }
}

fn taken(path: &Path, message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::AlreadyExists, format!("{}: {message}", path.display()))
}

/// Paths in a folder and its folder of frames, relative to it.
fn names(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut names = Vec::new();
    for below in ["", FRAMES] {
        let place = folder.join(below);
        if place.is_dir() {
            for entry in fs::read_dir(&place).map_err(at_path(&place))? {
                names.push(Path::new(below).join(entry.map_err(at_path(&place))?.file_name()));
            }
        }
    }
    Ok(names)
}
