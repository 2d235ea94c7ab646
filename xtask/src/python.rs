//! A virtual environment with what `python_tests` needs, and pytest in it.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::counts::{self, Counts};
use crate::repository::{self, Repository};
use crate::wheel;

/// Short case whose results the Python tests read.
const CASE: &str = "python_tests/short.toml";
const REQUIREMENTS: &str = "python_tests/requirements.txt";
/// Cases that the Python tests have as FMUs of both versions.
const FMUS: [&str; 2] = ["block_on_incline", "coupled_slope"];
/// Folder of the package `enmm`.
const PACKAGES: &str = "ffi/python";
const REMEDY: &str = "(Debian: apt-get install python3 python3-venv), then run `cargo xtask test` again";

/// Test of the pages of results, which needs a browser.
const BROWSER_TEST: &str = "python_tests/test_report.py";
/// Chromium by the names that systems give it, as `python_tests/browser.py` looks for it.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

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
    let mut pytest = command(repository)?;
    pytest.args(["-m", "pytest", "-p", "no:cacheprovider", "-ra"]).args(places).envs(extent);
    if !has_browser() {
        println!("SKIPPED {BROWSER_TEST}: there is no Chromium on this machine (Debian: apt-get install chromium)");
        pytest.args(["--ignore", BROWSER_TEST]);
    }
    pytest.env("ENMM_RESULTS", &results).env("ENMM_BIN", repository.enmm()).env("ENMM_FMUS", pack(repository)?);
    pytest.env("ENMM_EXAMPLE", repository.example("cosimulation")).env("ENMM_WHEEL", wheel::pack(repository)?);
    let (lines, good) = repository::run_and_listen(&mut pytest)?;
    let counts = counts::of_pytest(&lines);
    if !good && counts.failed == 0 {
        return Err("pytest failed without a failed test".to_owned());
    }
    Ok(counts)
}

/// Whether there is a Chromium; where Debian's packages can be installed it is installed first.
fn has_browser() -> bool {
    let found = || BROWSERS.iter().any(|name| succeeds(Command::new(name).arg("--version")));
    let is_root = || Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout.trim_ascii() == b"0");
    if found() || !is_root() {
        return found();
    }
    println!("installing Chromium for {BROWSER_TEST}");
    let apt = |args: &[&str]| succeeds(Command::new("apt-get").args(args).env("DEBIAN_FRONTEND", "noninteractive"));
    let install = ["install", "--yes", "--no-install-recommends", "chromium"];
    (apt(&install) || (apt(&["update"]) && apt(&install))) && found()
}

fn succeeds(command: &mut Command) -> bool {
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
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

/// The C library as `cargo build --release` leaves it.
fn library(repository: &Repository) -> PathBuf {
    let name = format!("{}enmm{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    repository.target.join("release").join(name)
}

/// Python of the environment, which finds the package `enmm` and its library.
///
/// # Errors
/// When the environment cannot be made.
pub fn command(repository: &Repository) -> Result<Command, String> {
    let mut python = repository.command(environment(repository)?);
    python.env("PYTHONDONTWRITEBYTECODE", "1").env("ENMM_LIBRARY", library(repository));
    python.env("ENMM_PROGRAM", repository.enmm());
    // Cargo names folders with our library here, which would hide that a search does not find it.
    python.env("PYTHONPATH", repository.root.join(PACKAGES)).env_remove("LD_LIBRARY_PATH");
    Ok(python)
}

/// Makes the environment where it is missing or was made for other requirements; returns its Python.
fn environment(repository: &Repository) -> Result<PathBuf, String> {
    let (system, version) = system_python()?;
    let wanted = std::fs::read_to_string(repository.root.join(REQUIREMENTS));
    let wanted = format!("{version}\n{}", wanted.map_err(|error| format!("{REQUIREMENTS}: {error}"))?);
    let place = repository.target.join("venv");
    let python = place.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let stamp = place.join("enmm-requirements");
    if python.exists() && std::fs::read_to_string(&stamp).is_ok_and(|found| found == wanted) {
        return Ok(python);
    }
    make_environment(system, &place)?;
    let mut pip = repository.command(&python);
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", REQUIREMENTS]);
    repository::run(&mut pip)?;
    std::fs::write(&stamp, wanted).map_err(|error| format!("{}: {error}", stamp.display()))?;
    Ok(python)
}

fn make_environment(system: &str, place: &Path) -> Result<(), String> {
    let mut make = Command::new(system);
    make.args(["-m", "venv", "--clear"]).arg(place);
    let problem = || format!("{system} -m venv {} failed: install Python's venv module {REMEDY}", place.display());
    if succeeds(&mut make) { Ok(()) } else { Err(problem()) }
}

/// The first Python 3 on the path, with its version.
fn system_python() -> Result<(&'static str, String), String> {
    let version = |name: &str| {
        let output = Command::new(name).arg("--version").output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
        text.starts_with("Python 3.").then_some(text)
    };
    let found = ["python3", "python"].into_iter().find_map(|name| version(name).map(|text| (name, text)));
    found.ok_or_else(|| format!("python3 was not found: install Python 3.11 or newer {REMEDY}"))
}
