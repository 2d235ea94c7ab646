//! One wheel for this platform: package, library, program and the libraries that `enmm fmu` packs.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
use std::path::{Path, PathBuf};

use crate::repository::{self, Repository};
use crate::supply;
use crate::venv;

/// Folder of the package `enmm`.
const PACKAGE: &str = "ffi/python";
/// What a package index takes without asking, with room to spare (bytes).
const SIZE_MAX: u64 = 15_000_000;

/// Builds program and libraries, and the wheel of them in `wheels` of the target folder; returns its path.
///
/// # Errors
/// When something does not build, or the wheel is too large.
pub fn build(repository: &Repository) -> Result<PathBuf, String> {
    let packages = ["enmm-cli", "enmm-capi", "enmm-fmi2", "enmm-fmi3"];
    let args = ["build", "--release"].into_iter().chain(packages.iter().flat_map(|name| ["--package", name]));
    repository::run(&mut repository.cargo_to_ship(&args.collect::<Vec<_>>()))?;
    let wheel = pack(repository)?;
    let binaries = std::fs::read_dir(binaries(repository)).map_err(|error| format!("binaries: {error}"))?;
    binaries.flatten().try_for_each(|file| supply::no_build_paths(&file.path(), &repository.build_folders()))?;
    Ok(wheel)
}

/// Makes the wheel of what has been built.
///
/// # Errors
/// As [`build`].
pub fn pack(repository: &Repository) -> Result<PathBuf, String> {
    let binaries = binaries(repository);
    let wheels = repository.target.join("wheels");
    for folder in [&binaries, &wheels] {
        repository::remove(folder)?;
        std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    let libraries = ["enmm", "enmm_fmi2", "enmm_fmi3"].map(|name| format!("{DLL_PREFIX}{name}{DLL_SUFFIX}"));
    for name in libraries.into_iter().chain([format!("enmm{EXE_SUFFIX}")]) {
        strip(repository, &repository.target.join("release").join(&name), &binaries.join(&name))?;
    }
    let mut pip = venv::command(repository)?;
    pip.args(["-m", "pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-build-isolation"]);
    repository::run(pip.arg("--wheel-dir").arg(&wheels).arg(PACKAGE).env("ENMM_BINARIES", &binaries))?;
    let entries = std::fs::read_dir(&wheels).map_err(|error| format!("{}: {error}", wheels.display()))?;
    let wheel =
        entries.flatten().map(|entry| entry.path()).find(|path| path.extension().is_some_and(|end| end == "whl"));
    let wheel = wheel.ok_or_else(|| format!("{}: pip left no wheel", wheels.display()))?;
    let size = wheel.metadata().map_err(|error| format!("{}: {error}", wheel.display()))?.len();
    if size > SIZE_MAX {
        return Err(format!("{}: has {size} bytes, must have at most {SIZE_MAX}", wheel.display()));
    }
    println!("wrote {} ({:.1} MB)", wheel.display(), size as f64 / 1e6);
    Ok(wheel)
}

/// Folder of the binaries as they are in the wheel.
fn binaries(repository: &Repository) -> PathBuf {
    repository.target.join("wheel-binaries")
}

/// Copies a binary without its symbols and line tables, which only developers need.
fn strip(repository: &Repository, from: &Path, to: &Path) -> Result<(), String> {
    std::fs::copy(from, to).map_err(|error| format!("{}: {error}", from.display()))?;
    let options: &[&str] = match std::env::consts::OS {
        "windows" => return Ok(()),
        "macos" => &["-x"],
        _ => &["--strip-unneeded"],
    };
    repository::run(repository.command("strip").args(options).arg(to))
}
