//! Where the shared library is that FMUs hold: that of FMUs alone or, in a Python, that of the package `enmm`, which
//! has their entry points as well.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::path::{Path, PathBuf};

use crate::table::Version;

/// No library where it is looked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "cannot find {name}, which the FMU needs; looked in {searched}: build it with `cargo build --release -p enmm-fmu` \
     in the sources, or copy it beside the program"
)]
pub struct LibraryMissing {
    name: String,
    searched: String,
}

/// File name of the library on this system.
pub fn file_name() -> String {
    format!("{DLL_PREFIX}enmm_fmu{DLL_SUFFIX}")
}

/// Finds the library for the program at `program`: beside it, in `deps` there, in `../lib`, or in the package `enmm` of
/// the Python that the program was installed with. Of the first two the newer is taken: cargo does not always renew
/// both.
///
/// # Errors
/// When there is none, with the folders that were searched.
pub fn find(program: &Path) -> Result<PathBuf, LibraryMissing> {
    let folder = program.parent().unwrap_or(Path::new(""));
    let name = file_name();
    let folders = [folder.to_owned(), folder.join("deps"), folder.parent().unwrap_or(folder).join("lib")];
    let [beside, deps, installed] = folders.each_ref().map(|folder| folder.join(&name));
    let changed = |path: &Path| path.metadata().and_then(|metadata| metadata.modified()).ok();
    let newest = if changed(&deps) > changed(&beside) { deps } else { beside };
    let of_package = packages(folder).map(|package| package.join(format!("{DLL_PREFIX}enmm{DLL_SUFFIX}")));
    [newest, installed]
        .into_iter()
        .chain(of_package)
        .find(|path| path.is_file())
        .ok_or_else(|| LibraryMissing { name, searched: folders.map(|folder| folder.display().to_string()).join(", ") })
}

/// Where Pythons keep the package `enmm` whose program is in the folder `bin`: `../lib/python3.N/site-packages` as a
/// rule, `dist-packages` of Debian's own Python, `lib64` of Fedora's, `Lib/site-packages` on Windows.
fn packages(bin: &Path) -> impl Iterator<Item = PathBuf> {
    let root = bin.parent().unwrap_or(bin).to_owned();
    let libraries = ["lib", "lib64"].map(|name| root.join(name));
    let read = libraries.into_iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    let is_python = |path: &PathBuf| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("python3"));
    let mut pythons: Vec<PathBuf> = read.map(|entry| entry.path()).filter(is_python).collect();
    pythons.sort();
    pythons.push(root.join("Lib"));
    pythons.into_iter().flat_map(|python| ["site-packages", "dist-packages"].map(|name| python.join(name).join("enmm")))
}

/// Folder of an FMU, below `binaries`, for libraries of this system.
pub fn platform(version: Version) -> String {
    let system = if OS == "macos" { "darwin" } else { OS };
    match version {
        Version::Two => format!("{}{}", if OS == "windows" { "win" } else { system }, usize::BITS),
        Version::Three => format!("{}-{system}", if ARCH == "arm" { "aarch32" } else { ARCH }),
    }
}
