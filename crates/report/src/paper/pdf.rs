//! A PDF of the report by a program that prints HTML.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use enmm_io::files::temporary_beside;

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

    /// Prints a page into a PDF, whole or not at all.
    ///
    /// # Errors
    /// See [`PdfError`].
    pub fn convert(&self, page: &Path, pdf: &Path) -> Result<(), PdfError> {
        let io = |error| PdfError::Io { program: self.program.clone(), error };
        let page = page.canonicalize().map_err(io)?;
        let made = temporary_beside(pdf).map_err(io)?;
        let profile = temporary_beside(&env::temp_dir().join("enmm_browser")).map_err(io)?;
        let outcome = self.run(&page, &made, &profile);
        // The profile of the browser is of no use afterwards; one that cannot go stays.
        let _ = fs::remove_dir_all(&profile);
        let outcome = outcome.and_then(|()| fs::rename(&made, pdf).map_err(io));
        if outcome.is_err() {
            let _ = fs::remove_file(&made);
        }
        outcome
    }

    fn run(&self, page: &Path, made: &Path, profile: &Path) -> Result<(), PdfError> {
        let io = |error| PdfError::Io { program: self.program.clone(), error };
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
        let mut child = command.spawn().map_err(io)?;
        let start = Instant::now();
        let status = loop {
            match child.try_wait().map_err(io)? {
                Some(status) => break status,
                None if start.elapsed() > PATIENCE => {
                    let _ = child.kill();
                    let _ = child.wait();
                    return Err(PdfError::Slow { program: self.program.clone(), page: page.to_owned() });
                }
                None => thread::sleep(LOOK),
            }
        };
        let is_pdf = fs::read(made).is_ok_and(|bytes| bytes.starts_with(b"%PDF-"));
        if status.success() && is_pdf {
            return Ok(());
        }
        let status = status.code().unwrap_or(-1);
        Err(PdfError::Failed { program: self.program.clone(), status, page: page.to_owned() })
    }
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
