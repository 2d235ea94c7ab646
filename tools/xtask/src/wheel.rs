//! One wheel for a platform: package, library, program and the libraries that `enmm fmu` packs.

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
const PACKAGES: [&str; 4] = ["enmm-cli", "enmm-capi", "enmm-fmi2", "enmm-fmi3"];
/// Largest size (bytes): that of the program, the library and the two libraries of FMUs, all of which can record
/// results, with a little room. What is larger holds something that does not belong there.
const SIZE_MAX: u64 = 21_000_000;

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
    let build = |cargo: &mut Command| {
        let cross = platform.cross.iter();
        let settings = cross.clone().flat_map(|cross| cross.settings.iter().copied());
        repository::run(cargo.args(cross.flat_map(|cross| ["--target", cross.triple])).envs(settings))
    };
    let mut cargo = match (platform.glibc, platform.triple()) {
        (Some(glibc), Some(triple)) => zig::build(repository, &triple, glibc)?,
        _ => repository.cargo_to_ship(&["build", "--release"]),
    };
    build(cargo.args(packages()))?;
    for name in platform.cross.iter().flat_map(|cross| cross.alone) {
        let library = ["rustc", "--release", "--package", name, "--lib", "--crate-type", "cdylib"];
        build(&mut repository.cargo_to_ship(&library))?;
    }
    let wheel = pack(repository, platform)?;
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

/// Makes the wheel of what has been built.
pub fn pack(repository: &Repository, platform: &Platform) -> Result<PathBuf, String> {
    let (binaries, wheels) = (platform.shipped(repository), platform.wheels(repository));
    repository::fresh(binaries.clone())?;
    repository::fresh(wheels.clone())?;
    for name in platform.binaries() {
        platform.strip(repository, &platform.built(repository).join(&name), &binaries.join(&name))?;
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
