//! One wheel for a platform: package, program and the library, which `enmm fmu` packs as well.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::parts;
use crate::platform::Platform;
use crate::repository::{self, Repository};
use crate::supply;
use crate::venv;
use crate::zig;

/// Folder of the package `enmm`.
const PACKAGE: &str = "ffi/python";
/// Packages of the binaries.
const PACKAGES: [&str; 3] = ["enmm-cli", "enmm-capi", "enmm-fmu"];
/// Largest size (bytes). What is larger holds something that does not belong there.
const SIZE_MAX: u64 = 15_000_000;

/// Packages of the binaries, as cargo takes them.
pub fn packages() -> impl Iterator<Item = &'static str> {
    PACKAGES.into_iter().flat_map(|name| ["--package", name])
}

/// Builds program and libraries for a platform, and the wheel of them; returns its path.
///
/// # Errors
/// When the machine lacks what a cross build needs, something does not build, or the wheel is too large.
pub fn build(repository: &Repository, platform: &Platform) -> Result<PathBuf, String> {
    if let Some(cross) = &platform.cross {
        cross.missing().map_or(Ok(()), Err)?;
    }
    repository::run(to_ship(repository, platform, "build")?.args(packages()))?;
    let wheel = pack(repository, platform, &platform.built(repository))?;
    let shipped = platform.shipped(repository);
    for name in platform.binaries() {
        supply::no_build_paths(&shipped.join(name), &repository.build_folders())?;
    }
    let size = size_of(&wheel)?;
    if size > SIZE_MAX {
        return Err(format!("{}: has {size} bytes, must have at most {SIZE_MAX}", wheel.display()));
    }
    Ok(wheel)
}

/// A command of cargo that builds for a platform what leaves this machine.
fn to_ship(repository: &Repository, platform: &Platform, command: &str) -> Result<Command, String> {
    let mut cargo = match (platform.glibc, platform.triple()) {
        (Some(glibc), Some(triple)) => zig::cargo(repository, command, &triple, glibc)?,
        _ => repository.cargo_to_ship(&[command]),
    };
    if let Some(cross) = &platform.cross {
        cargo.args(["--target", cross.triple]).envs(cross.settings.iter().copied());
    }
    cargo.args(["--profile", "ship"]);
    Ok(cargo)
}

/// Makes the wheel of what has been built in the folder `built`.
pub fn pack(repository: &Repository, platform: &Platform, built: &Path) -> Result<PathBuf, String> {
    let (binaries, wheels) = (platform.shipped(repository), platform.wheels(repository));
    repository::fresh(binaries.clone())?;
    repository::fresh(wheels.clone())?;
    for name in platform.binaries() {
        platform.strip(repository, &built.join(&name), &binaries.join(&name))?;
    }
    // The licences of all crates in the binaries, and the list of these crates.
    let made = parts::of(Some(&repository.root))?;
    repository::write(&binaries.join(parts::LIST), made.list)?;
    repository::write(&binaries.join(parts::LICENSES), made.licenses)?;
    let mut pip = venv::command(repository, venv::Packages::Usual)?;
    pip.args(["-m", "pip", "wheel", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-build-isolation"]);
    pip.envs(platform.cross.as_ref().map(|cross| ("ENMM_PLATFORM", cross.wheel)));
    repository::run(pip.arg("--wheel-dir").arg(&wheels).arg(PACKAGE).env("ENMM_BINARIES", &binaries))?;
    let entries = std::fs::read_dir(&wheels).map_err(repository::at(&wheels))?;
    let wheel =
        entries.flatten().map(|entry| entry.path()).find(|path| path.extension().is_some_and(|end| end == "whl"));
    let wheel = wheel.ok_or_else(|| format!("{}: pip left no wheel", wheels.display()))?;
    println!("wrote {} ({:.1} MB)", wheel.display(), size_of(&wheel)? as f64 / 1e6);
    Ok(wheel)
}

fn size_of(file: &Path) -> Result<u64, String> {
    file.metadata().map(|data| data.len()).map_err(repository::at(file))
}
