//! Files that are either whole or absent. Knows nothing of what is written into them.

use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Bytes that are gathered before they go to a file.
const BUFFER: usize = 1 << 18;

/// Makes errors name the file they speak of: `result.map_err(at_path(path))`.
pub fn at_path(path: &Path) -> impl FnOnce(io::Error) -> io::Error + '_ {
    move |error| io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// Replaces the file at `path` by `bytes` in one move, so that a reader or a killed run never sees half of it.
///
/// The bytes first go to a temporary file beside `path`. A missing directory is an error: one that is removed during a
/// run does not come back with a part of the results.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message; the old file is then untouched.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_atomic_by(path, |file| file.write_all(bytes))
}

/// As [`write_atomic`], with the bytes that `write` hands over piece by piece: they are never in memory together.
///
/// # Errors
/// As [`write_atomic`].
pub fn write_atomic_by(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let temporary = temporary_beside(path).map_err(at_path(path))?;
    let moved = fill(&temporary, write).and_then(|()| fs::rename(&temporary, path));
    if moved.is_err() {
        // The error that matters is the one above; a temporary file that cannot be removed adds nothing to it.
        let _ = fs::remove_file(&temporary);
    }
    moved.map_err(at_path(path))
}

/// A name in the directory of `path` that no other write of this or another process uses.
pub fn temporary_beside(path: &Path) -> io::Result<PathBuf> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let name = path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "no file name"))?;
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}-{}.tmp", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    Ok(path.with_file_name(hidden))
}

/// Opens a regular file to read it. A pipe, a socket or a device is not opened at all, so that nothing waits for its
/// other end.
///
/// # Errors
/// It is something else, or what the file system refuses.
pub fn open_input(path: &Path) -> io::Result<File> {
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is a directory, a pipe or a device and no file"));
    }
    File::open(path)
}

/// Reads a regular file.
///
/// # Errors
/// As [`open_input`].
pub fn read_input(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_input(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Kinds of files that runs and searches leave.
const KINDS: [&str; 8] = ["bin", "csv", "enmm", "html", "json", "png", "pvd", "vtu"];

/// Whether a file name is one that programs of ours give to files which they have not finished.
pub fn is_temporary(name: &str) -> bool {
    writer_of_temporary(name).is_some()
}

/// Copies a regular file to a place of its own: a link of that name is replaced and not followed.
///
/// # Errors
/// As [`open_input`], or what the file system refuses at the other end.
pub fn copy_file(from: &Path, to: &Path) -> io::Result<()> {
    let mut input = open_input(from).map_err(at_path(from))?;
    remove_if_there(to)
        .and_then(|()| File::create_new(to))
        .and_then(|mut out| io::copy(&mut input, &mut out))
        .map_err(at_path(to))?;
    Ok(())
}

/// Removes a file or a link, but not what the link leads to.
///
/// # Errors
/// What the file system refuses; a file that is not there is none.
pub fn remove_if_there(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        removed => removed,
    }
}

/// Removes temporary files that killed programs left in a directory; a missing directory has none.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn sweep_temporaries(directory: &Path) -> io::Result<()> {
    let entries = match fs::read_dir(directory) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        read => read.map_err(at_path(directory))?,
    };
    for entry in entries {
        let path = entry.map_err(at_path(directory))?.path();
        let writer = path.file_name().and_then(|name| name.to_str()).and_then(writer_of_temporary);
        // Where the system lists its processes, one that still writes is left alone.
        if writer.is_some_and(|process| !Path::new("/proc").join(process.to_string()).exists()) {
            fs::remove_file(&path).map_err(at_path(&path))?;
        }
    }
    Ok(())
}

/// The process that made a temporary file of this name, when it is one of ours.
fn writer_of_temporary(name: &str) -> Option<u32> {
    let (name, tail) = name.strip_prefix('.')?.strip_suffix(".tmp")?.rsplit_once('.')?;
    let (process, count) = tail.split_once('-')?;
    let ours = count.parse::<u64>().is_ok() && name.rsplit_once('.').is_some_and(|(_, kind)| KINDS.contains(&kind));
    process.parse().ok().filter(|_| ours)
}

fn fill(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut file = BufWriter::with_capacity(BUFFER, File::create(path)?);
    write(&mut file)?;
    file.into_inner()?.sync_data()
}
