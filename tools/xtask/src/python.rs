//! Pytest, with the results, FMUs and the wheel that `python_tests` reads.

use std::path::PathBuf;
use std::process::Command;

use crate::counts::{self, Counts};
use crate::debian;
use crate::platform::HERE;
use crate::repository::{self, Repository};
use crate::venv;
use crate::wheel;

/// Short case whose results the Python tests read.
const CASE: &str = "python_tests/short.toml";
/// Cases that the Python tests have as FMUs of both versions.
const FMUS: [&str; 2] = ["block_on_incline", "coupled_slope"];

/// Test of the pages of results, which needs a browser.
const BROWSER_TEST: &str = "python_tests/test_report.py";
/// Test of a drawing by pyvista, which needs a library that draws without a screen.
const DRAWING_TEST: &str = "python_tests/test_pyvista.py";
/// Chromium by the names that systems give it, as `python_tests/browser.py` looks for it.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Processes that run the Python tests, file by file.
const WORKERS: &str = "2";

/// All Python tests.
pub const ALL: &str = "python_tests";

/// Runs the short case, then pytest over its results in these files or folders.
///
/// # Errors
/// When the environment cannot be made or the case does not run.
pub fn test(repository: &Repository, places: &[&str]) -> Result<Counts, String> {
    pytest(repository, places, None)
}

/// The same with ENMM_LONG, so that campaigns run in full.
///
/// # Errors
/// As [`test()`].
pub fn test_in_full(repository: &Repository, places: &[&str]) -> Result<Counts, String> {
    pytest(repository, places, Some(("ENMM_LONG", "1")))
}

fn pytest(repository: &Repository, places: &[&str], extent: Option<(&str, &str)>) -> Result<Counts, String> {
    let results = repository.target.join("python-results");
    if results.exists() {
        std::fs::remove_dir_all(&results).map_err(|error| format!("{}: {error}", results.display()))?;
    }
    repository::run(repository.command(repository.enmm()).args(["run", CASE, "--quiet", "-o"]).arg(&results))?;
    let mut pytest = venv::command(repository)?;
    pytest.args(["-m", "pytest", "-p", "no:cacheprovider", "-ra", "-n", WORKERS, "--dist", "loadfile"]);
    pytest.args(places).envs(extent);
    // Without it the test says that it was left out.
    let library = "import ctypes; ctypes.CDLL('libEGL.so.1')";
    let draws = || venv::command(repository).is_ok_and(|mut python| venv::succeeds(python.args(["-c", library])));
    debian::provide(DRAWING_TEST, "libegl1 libgl1-mesa-dri", draws);
    if !has_browser() {
        println!("SKIPPED {BROWSER_TEST}: there is no Chromium on this machine (Debian: apt-get install chromium)");
        pytest.args(["--ignore", BROWSER_TEST]);
    }
    pytest.env("ENMM_RESULTS", &results).env("ENMM_BIN", repository.enmm()).env("ENMM_FMUS", pack(repository)?);
    pytest.env("ENMM_EXAMPLE", repository.example("cosimulation")).env("ENMM_WHEEL", wheel::pack(repository, &HERE)?);
    let (lines, good) = repository::run_and_listen(&mut pytest)?;
    let counts = counts::of_pytest(&lines);
    if !good && counts.failed == 0 {
        return Err("pytest failed without a failed test".to_owned());
    }
    Ok(counts)
}

/// Whether there is a Chromium; where Debian's packages can be installed it is installed first.
fn has_browser() -> bool {
    let found = || BROWSERS.iter().any(|name| venv::succeeds(Command::new(name).arg("--version")));
    debian::provide(BROWSER_TEST, "chromium", found)
}

/// Packs the FMUs of the tests; returns their folder.
fn pack(repository: &Repository) -> Result<PathBuf, String> {
    let folder = repository.target.join("fmus");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for case in FMUS {
        for version in ["2", "3"] {
            let mut enmm = repository.command(repository.enmm());
            enmm.arg("fmu").arg(format!("examples/cases/{case}.toml")).args(["--fmi", version, "-o"]);
            repository::run(enmm.arg(folder.join(format!("{case}_fmi{version}.fmu"))))?;
        }
    }
    Ok(folder)
}
