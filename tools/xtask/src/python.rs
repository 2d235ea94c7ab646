//! Pytest, with the results, FMUs and the wheel that `python_tests` reads.

use std::path::PathBuf;
use std::process::Command;

use crate::counts::{self, Counts};
use crate::debian;
use crate::platform::HERE;
use crate::repository::{self, Repository, succeeds};
use crate::venv::{self, Packages};
use crate::wheel;

/// Compares the page of the Python API with the package, or writes it.
const API: &str = "python_tests/test_api_page.py";
/// Short case whose results the Python tests read.
const CASE: &str = "python_tests/short.toml";
/// Cases that the Python tests have as FMUs of both versions.
const FMUS: [&str; 2] = ["block_on_incline", "coupled_slope"];

/// Chromium by the names that systems give it, as `python_tests/browser.py` looks for it.
const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Those of the interfaces: the C library by ctypes, FMUs by FMPy, results, coupling. They need the usual packages
/// alone.
const USUAL: [&str; 13] = [
    API,
    "python_tests/test_coupling.py",
    "python_tests/test_ctypes.py",
    "python_tests/test_ctypes_life.py",
    "python_tests/test_fmu_description.py",
    "python_tests/test_fmu_errors.py",
    "python_tests/test_fmu_fmi3.py",
    "python_tests/test_fmu_runs.py",
    "python_tests/test_fmu_standard.py",
    "python_tests/test_fmu_states.py",
    "python_tests/test_parameters.py",
    "python_tests/test_recorded.py",
    "python_tests/test_results.py",
];

/// A share of the Python tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Share {
    /// That of `cargo xtask test`.
    Usual,
    /// The others.
    Others,
    /// All.
    All,
    /// The campaigns of the ensembles, in full.
    Ensembles,
}

impl Share {
    /// Arguments by which pytest finds it.
    fn arguments(self) -> Vec<&'static str> {
        match self {
            Self::Usual => USUAL.to_vec(),
            Self::Others => {
                ["python_tests"].into_iter().chain(USUAL.into_iter().flat_map(|file| ["--ignore", file])).collect()
            }
            Self::All => vec!["python_tests"],
            Self::Ensembles => vec!["python_tests/test_ensemble.py"],
        }
    }
}

/// Runs the short case, then pytest over a share of the tests.
pub fn test(repository: &Repository, share: Share) -> Result<Counts, String> {
    let results = repository.target.join("python-results");
    repository::remove(&results)?;
    repository::run(repository.command(repository.enmm()).args(["run", CASE, "--quiet", "-o"]).arg(&results))?;
    let mut pytest = venv::command(repository, if share == Share::Usual { Packages::Usual } else { Packages::All })?;
    pytest.args(["-m", "pytest", "-p", "no:cacheprovider", "-ra", "-n", "2", "--dist", "loadfile"]);
    pytest.args(share.arguments());
    if share == Share::Ensembles {
        pytest.env("ENMM_LONG", "1");
    }
    pytest.env("ENMM_RESULTS", &results).env("ENMM_BIN", repository.enmm()).env("ENMM_FMUS", pack(repository)?);
    pytest.env("ENMM_EXAMPLE", repository.program("examples/cosimulation"));
    if share != Share::Usual {
        install(repository);
        pytest.env("ENMM_WHEEL", wheel::pack(repository, &HERE, &repository.built())?);
    }
    let (lines, good) = repository::run_and_listen(&mut pytest)?;
    let counts = counts::of_pytest(&lines);
    if !good && counts.failed == 0 {
        return Err("pytest failed without a failed test".to_owned());
    }
    Ok(counts)
}

/// Writes the page of the Python API from the docstrings of the package.
pub fn write_api(repository: &Repository) -> Result<(), String> {
    let mut pytest = venv::command(repository, Packages::Usual)?;
    repository::run(pytest.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", API]).env("ENMM_WRITE_API", "1"))
}

/// Installs programs and libraries that a few tests need, where Debian's packages can be; without them these tests skip
/// themselves.
pub fn install(repository: &Repository) {
    let load = ["-c", "import ctypes; ctypes.CDLL('libEGL.so.1')"];
    let draws = || venv::command(repository, Packages::All).is_ok_and(|mut python| succeeds(python.args(load)));
    debian::provide("python_tests/test_pyvista.py", "libegl1 libgl1-mesa-dri", draws);
    let browses = || BROWSERS.iter().any(|name| succeeds(Command::new(name).arg("--version")));
    debian::provide("python_tests/test_report.py", "chromium", browses);
}

/// Packs the FMUs of the tests; returns their folder.
fn pack(repository: &Repository) -> Result<PathBuf, String> {
    let folder = repository.target.join("fmus");
    repository::make(&folder)?;
    for case in FMUS {
        for version in ["2", "3"] {
            let mut enmm = repository.command(repository.enmm());
            enmm.arg("fmu").arg(format!("examples/cases/{case}.toml")).args(["--fmi", version, "-o"]);
            repository::run(enmm.arg(folder.join(format!("{case}_fmi{version}.fmu"))))?;
        }
    }
    Ok(folder)
}
