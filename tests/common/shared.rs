//! The folder of shared data, which stays outside the repository.

use std::path::{Path, PathBuf};

/// Finds the data above this checkout or where `ENMM_SHARED` says; says so when they are absent.
pub fn shared() -> Option<PathBuf> {
    let given = std::env::var_os("ENMM_SHARED").map(PathBuf::from);
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().skip(1).map(|folder| folder.join("shared"));
    let found = given.into_iter().chain(above).map(|folder| folder.join("data")).find(|data| data.is_dir());
    if found.is_none() {
        eprintln!("skipped: no shared data folder (set ENMM_SHARED)");
    }
    found
}
