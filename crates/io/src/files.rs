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
    let fill = |(unfinished, file): (Unfinished, File)| {
        let mut file = BufWriter::with_capacity(BUFFER, file);
        write(&mut file)?;
        file.into_inner()?.sync_data()?;
        unfinished.finish()
    };
    Unfinished::beside(path).and_then(fill).map_err(at_path(path))
}

/// A file that is not finished: it lies hidden beside its place, and goes when this is dropped before it is finished.
#[derive(Debug)]
pub struct Unfinished {
    path: PathBuf,
    place: PathBuf,
}

impl Unfinished {
    /// Makes an empty one in the directory of `place`. What has its name already, such as a link that somebody has
    /// laid there, is left alone, and the next number taken. The file is to be closed before it is finished.
    ///
    /// # Errors
    /// `place` has no file name, or what the file system refuses.
    pub fn beside(place: &Path) -> io::Result<(Self, File)> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let name = place.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "no file name"))?;
        // No result has so long a name, and a file system has no room for more than 255 bytes.
        let name = if name.len() > 200 { std::ffi::OsStr::new("unfinished") } else { name };
        loop {
            let mut hidden = std::ffi::OsString::from(".");
            hidden.push(name);
            hidden.push(format!(".{}-{}.tmp", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
            let path = place.with_file_name(hidden);
            match File::create_new(&path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                made => return made.map(|file| (Self { path, place: place.to_owned() }, file)),
            }
        }
    }

    /// Where it lies.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Moves it to its place, where it replaces what is there.
    ///
    /// # Errors
    /// Whatever the file system refuses.
    pub fn finish(self) -> io::Result<()> {
        fs::rename(&self.path, &self.place)
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        // Finished, it has another name. One that cannot be removed is swept by the next run.
        let _ = fs::remove_file(&self.path);
    }
}

/// The name of a file that programs of ours give to it while it is not finished: that of the file, and the process.
pub fn unfinished_name(name: &str) -> Option<(&str, u32)> {
    let (name, tail) = name.strip_prefix('.')?.strip_suffix(".tmp")?.rsplit_once('.')?;
    let (process, count) = tail.split_once('-')?;
    count.parse::<u64>().ok()?;
    Some((name, process.parse().ok()?))
}

/// Whether a process still runs, where the system lists its processes.
pub fn is_running(process: u32) -> bool {
    Path::new("/proc").join(process.to_string()).exists()
}

/// Opens a regular file to read it. A pipe, a socket or a device is not opened at all, so that nothing waits for its
/// other end.
///
/// # Errors
/// It is something else, or what the file system refuses.
pub fn open_input(path: &Path) -> io::Result<File> {
    open_regular(path, fs::metadata(path)?, 0)
}

/// Opens a file of a folder of results to read it, as [`open_input`]. A link is not followed: whoever made the folder
/// could have it lead to any file of the reader.
///
/// # Errors
/// It is no regular file, or what the file system refuses.
pub fn open_result(path: &Path) -> io::Result<File> {
    let metadata = fs::symlink_metadata(path)?;
    if metadata.is_symlink() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is a link: put the file itself in its place"));
    }
    open_regular(path, metadata, NO_LINK)
}

/// Reads a file of a folder of results, of at most `most` bytes.
///
/// # Errors
/// As [`open_result`], or it is longer.
pub fn read_result(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_result(path)?.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let message = format!("it has more than {most} bytes, the limit");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

#[cfg(unix)]
const NO_LINK: i32 = libc::O_NOFOLLOW;
#[cfg(not(unix))]
const NO_LINK: i32 = 0;

fn open_regular(path: &Path, before: fs::Metadata, flags: i32) -> io::Result<File> {
    let irregular = || io::Error::new(io::ErrorKind::InvalidInput, "it is a directory, a pipe or a device and no file");
    if !before.is_file() {
        return Err(irregular());
    }
    let file = open_without_waiting(path, flags)?;
    // Another thing may have come to the place between the two calls above.
    if file.metadata()?.is_file() { Ok(file) } else { Err(irregular()) }
}

#[cfg(unix)]
fn open_without_waiting(path: &Path, flags: i32) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    fs::OpenOptions::new().read(true).custom_flags(flags | libc::O_NONBLOCK).open(path)
}

#[cfg(not(unix))]
fn open_without_waiting(path: &Path, _: i32) -> io::Result<File> {
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

/// Copies a file of a folder of results to a place of its own: a link of that name is replaced and not followed.
///
/// # Errors
/// As [`open_result`], or what the file system refuses at the other end.
pub fn copy_file(from: &Path, to: &Path) -> io::Result<()> {
    let mut input = open_result(from).map_err(at_path(from))?;
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
