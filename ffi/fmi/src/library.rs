//! Where the shared library of FMUs is.

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

/// Finds the library for the program at `program`: beside it, in `deps` there, or in `../lib`. Of the
/// first two the newer is taken: cargo does not always renew both.
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
    [newest, installed]
        .into_iter()
        .find(|path| path.is_file())
        .ok_or_else(|| LibraryMissing { name, searched: folders.map(|folder| folder.display().to_string()).join(", ") })
}

/// Folder of an FMU, below `binaries`, for libraries of this system.
pub fn platform(version: Version) -> String {
    let system = if OS == "macos" { "darwin" } else { OS };
    match version {
        Version::Two => format!("{}{}", if OS == "windows" { "win" } else { system }, usize::BITS),
        Version::Three => format!("{}-{system}", if ARCH == "arm" { "aarch32" } else { ARCH }),
    }
}
