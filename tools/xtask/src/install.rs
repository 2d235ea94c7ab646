//! Puts the programs, libraries and headers where other builds find them.

use std::path::Path;

use crate::repository::{self, Repository, write};

/// Libraries of the C ABI, and of the FMUs where they have been built.
const LIBRARIES: [&str; 4] = ["libenmm.so", "libenmm.a", "libenmm_fmi2.so", "libenmm_fmi3.so"];
/// Headers by their place in the repository.
const HEADERS: [&str; 2] = ["include/enmm.h", "ffi/cpp/enmm.hpp"];
/// System libraries that the static library needs.
const SYSTEM_LIBRARIES: &str = "-lgcc_s -lutil -lrt -lpthread -lm -ldl -lc";

/// Builds everything and installs it below `prefix`.
pub fn install(repository: &Repository, prefix: &Path) -> Result<(), String> {
    repository.build(&["--workspace"])?;
    let from = |name: &str| repository.built().join(name);
    copy(&repository.enmm(), &prefix.join("bin"))?;
    for name in LIBRARIES.into_iter().filter(|name| name.starts_with("libenmm.") || from(name).exists()) {
        copy(&from(name), &prefix.join("lib"))?;
    }
    for name in HEADERS {
        copy(&repository.root.join(name), &prefix.join("include"))?;
    }
    let version = env!("CARGO_PKG_VERSION");
    for (name, text, mark) in [
        ("pkgconfig/enmm.pc", PKG_CONFIG, " "),
        ("cmake/enmm/enmmConfig.cmake", CMAKE, ";"),
        ("cmake/enmm/enmmConfigVersion.cmake", CMAKE_VERSION, ";"),
    ] {
        write(&prefix.join("lib").join(name), filled(text, version, mark))?;
    }
    println!("installed in {}", prefix.display());
    Ok(())
}

/// The file of pkg-config; its prefix is where it lies, so that the whole may be moved.
const PKG_CONFIG: &str = include_str!("install/enmm.pc");
/// The targets for CMake.
const CMAKE: &str = include_str!("install/enmmConfig.cmake");
/// The version file for CMake.
const CMAKE_VERSION: &str = include_str!("install/enmmConfigVersion.cmake");

/// A file with the version, its series (the same major version and, before 1.0, the same minor one) and the libraries
/// of the system, which a mark parts.
fn filled(text: &str, version: &str, mark: &str) -> String {
    let mut parts = version.split('.');
    let (major, minor) = (parts.next().unwrap_or("0"), parts.next().unwrap_or("0"));
    let series = if major == "0" { format!("0.{minor}") } else { major.to_owned() };
    let text = text.replace("@VERSION@", version).replace("@SERIES@", &series);
    text.replace("@SYSTEM_LIBRARIES@", &SYSTEM_LIBRARIES.replace(' ', mark))
}

fn copy(from: &Path, folder: &Path) -> Result<(), String> {
    let to = folder.join(from.file_name().ok_or("a path without a name")?);
    repository::make(folder)?;
    // A library that a program has open is replaced, not written over.
    let _ = std::fs::remove_file(&to);
    std::fs::copy(from, &to).map(|_| ()).map_err(repository::at(from))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_a_series_agree() {
        assert!(filled(CMAKE_VERSION, "0.1.0", ";").contains(r#"MATCHES "^0.1[.]""#));
        assert!(filled(CMAKE_VERSION, "2.3.4", ";").contains(r#"MATCHES "^2[.]""#));
        assert!(filled(PKG_CONFIG, "0.1.0", " ").contains("\nVersion: 0.1.0\n"));
    }
}
