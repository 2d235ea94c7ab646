//! A PDF of the report by a program that prints HTML.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use enmm_io::files::{Unfinished, is_running};
use tempfile::TempDir;

/// Browsers of the family of Chromium, in the order in which they are looked for.
const BROWSERS: [&str; 7] =
    ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "microsoft-edge", "msedge"];
/// Where they are installed without being on the path.
const PLACES: [&str; 5] = [
    "C:\\Program Files\\Google\\Chrome\\Application\\chrome.exe",
    "C:\\Program Files (x86)\\Microsoft\\Edge\\Application\\msedge.exe",
    "C:\\Program Files\\Microsoft\\Edge\\Application\\msedge.exe",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
];
/// Programs that take the HTML file and the PDF file.
const OTHERS: [&str; 2] = ["weasyprint", "wkhtmltopdf"];
/// Longest time that a converter may take.
const PATIENCE: Duration = Duration::from_secs(180);
/// Time between two looks at it.
const LOOK: Duration = Duration::from_millis(50);

/// Begin of the names of profiles, before the number of our process.
const PROFILE: &str = "enmm_browser.";

/// A program that makes a PDF of an HTML file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Converter {
    program: PathBuf,
    is_browser: bool,
}

/// Why there is no PDF.
#[derive(Debug, thiserror::Error)]
pub enum PdfError {
    /// The converter did not start, or the PDF cannot be written.
    #[error("{}: {error}", program.display())]
    Io {
        /// The converter.
        program: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The converter went on for too long.
    #[error(
        "{} did not end within {} s: print {} from a browser",
        program.display(), PATIENCE.as_secs(), page.display()
    )]
    Slow {
        /// The converter.
        program: PathBuf,
        /// The page.
        page: PathBuf,
    },
    /// The user has ended it.
    #[error("interrupted: print {} from a browser, or run the command again", .0.display())]
    Interrupted(PathBuf),
    /// The converter failed.
    #[error("{} made no PDF (status {status}): print {} from a browser", program.display(), page.display())]
    Failed {
        /// The converter.
        program: PathBuf,
        /// Its exit status.
        status: i32,
        /// The page.
        page: PathBuf,
    },
}

impl Converter {
    /// The first converter that is installed.
    pub fn find() -> Option<Self> {
        let browsers = BROWSERS.iter().filter_map(|name| on_path(name));
        let places = PLACES.iter().map(PathBuf::from).filter(|path| path.is_file());
        let browsers = browsers.chain(places).map(|program| Self { program, is_browser: true });
        let others = OTHERS.iter().filter_map(|name| on_path(name));
        browsers.chain(others.map(|program| Self { program, is_browser: false })).next()
    }

    /// A program that the user names: one whose name is that of no other converter is taken for a browser.
    pub fn named(program: &Path) -> Self {
        let name = program.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        Self { program: program.to_owned(), is_browser: !OTHERS.contains(&name.as_str()) }
    }

    /// The program.
    pub fn program(&self) -> &Path {
        &self.program
    }

    /// Prints a page into a PDF, whole or not at all; `interrupt` ends the converter.
    ///
    /// # Errors
    /// See [`PdfError`].
    pub fn convert(&self, page: &Path, pdf: &Path, interrupt: &AtomicBool) -> Result<(), PdfError> {
        let io = |error| PdfError::Io { program: self.program.clone(), error };
        let page = page.canonicalize().map_err(io)?;
        let (made, file) = Unfinished::beside(pdf).map_err(io)?;
        drop(file);
        let profile = profile().map_err(io)?;
        let mut child = self.command(&page, made.path(), profile.path()).spawn().map_err(io)?;
        let ended = wait(&mut child, interrupt).map_err(io)?;
        if ended.is_none() {
            let _ = child.kill();
            let _ = child.wait();
        }
        let program = self.program.clone();
        let is_pdf = fs::read(made.path()).is_ok_and(|bytes| bytes.starts_with(b"%PDF-"));
        match ended {
            Some(status) if status.success() && is_pdf => made.finish().map_err(io),
            Some(status) => Err(PdfError::Failed { program, status: status.code().unwrap_or(-1), page }),
            None if interrupt.load(Ordering::Relaxed) => Err(PdfError::Interrupted(page)),
            None => Err(PdfError::Slow { program, page }),
        }
    }

    fn command(&self, page: &Path, made: &Path, profile: &Path) -> Command {
        let mut command = Command::new(&self.program);
        if self.is_browser {
            command.args(["--headless", "--disable-gpu", "--no-first-run", "--no-pdf-header-footer"]);
            command.args(["--disable-background-networking", "--disable-dev-shm-usage"]);
            command.arg(format!("--user-data-dir={}", profile.display()));
            command.arg(format!("--print-to-pdf={}", made.display()));
            if is_root() {
                // Its sandbox cannot start for root; the page is ours and holds no script.
                command.arg("--no-sandbox");
            }
            command.arg(page);
        } else {
            command.args([page, made]);
        }
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command
    }
}

/// Waits for a converter; none when it takes too long or the user interrupts.
fn wait(child: &mut Child, interrupt: &AtomicBool) -> io::Result<Option<ExitStatus>> {
    let start = Instant::now();
    while start.elapsed() < PATIENCE && !interrupt.load(Ordering::Relaxed) {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        thread::sleep(LOOK);
    }
    Ok(None)
}

/// A folder for the profile of a browser, which no other user can make beforehand or enter; it goes when it is dropped.
/// Those that killed processes of this user have left go now.
fn profile() -> io::Result<TempDir> {
    let prefix = format!("{PROFILE}{}-", std::process::id());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
    let profile = builder.tempdir()?;
    for entry in fs::read_dir(env::temp_dir())?.flatten() {
        let name = entry.file_name();
        let process = name.to_str().and_then(|name| name.strip_prefix(PROFILE)?.split_once('-')?.0.parse().ok());
        let is_left = process.is_some_and(|process| !is_running(process));
        if is_left && is_own(&entry.path(), profile.path()) {
            // One that cannot go stays for the next report.
            let _ = fs::remove_dir_all(entry.path());
        }
    }
    Ok(profile)
}

/// Whether a path is a folder, and no link to one, of the user whose folder the other is.
#[cfg(unix)]
fn is_own(path: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let owner = |path: &Path| fs::symlink_metadata(path).ok().filter(fs::Metadata::is_dir).map(|found| found.uid());
    owner(path).is_some_and(|found| owner(other) == Some(found))
}

/// Whether a path is a folder; each user has a place for temporary files.
#[cfg(not(unix))]
fn is_own(path: &Path, _: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

/// A program on the search path.
fn on_path(name: &str) -> Option<PathBuf> {
    let folders = env::var_os("PATH")?;
    let file = if cfg!(windows) { format!("{name}.exe") } else { name.to_owned() };
    env::split_paths(&folders).map(|folder| folder.join(&file)).find(|path| path.is_file())
}

#[cfg(unix)]
fn is_root() -> bool {
    fs::metadata("/proc/self").is_ok_and(|metadata| std::os::unix::fs::MetadataExt::uid(&metadata) == 0)
}

#[cfg(not(unix))]
fn is_root() -> bool {
    false
}
