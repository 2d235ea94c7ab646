//! Puts the programs, libraries and headers where other builds find them.

mod names;

use std::path::Path;

use crate::platform::{HERE, Platform};
use crate::repository::{self, Profile, Repository, write};
use crate::wheel;
use names::{Names, System};

/// Headers by their place in the repository.
const HEADERS: [&str; 2] = ["include/enmm.h", "ffi/cpp/enmm.hpp"];

/// Builds program and libraries and installs them below `prefix`.
pub fn install(repository: &Repository, prefix: &Path) -> Result<(), String> {
    let mut cargo = match repository.profile {
        Profile::Shipped => repository.cargo_to_ship(&["build", "--release"]),
        Profile::Tested => repository.cargo(&["build"]),
    };
    repository::run(cargo.args(wheel::packages()))?;
    let version = env!("CARGO_PKG_VERSION");
    let names = System::of(&HERE).names(version);
    copy(&repository.enmm(), &prefix.join("bin").join(HERE.program()))?;
    install_libraries(&names, &repository.built(), prefix)?;
    for name in HEADERS {
        let file = name.rsplit('/').next().unwrap_or(name);
        copy(&repository.root.join(name), &prefix.join("include").join(file))?;
    }
    for (name, text, mark) in [
        ("pkgconfig/enmm.pc", PKG_CONFIG, " "),
        ("cmake/enmm/enmmConfig.cmake", CMAKE, ";"),
        ("cmake/enmm/enmmConfigVersion.cmake", CMAKE_VERSION, ";"),
    ] {
        write(&prefix.join("lib").join(name), filled(text, version, &names, mark))?;
    }
    println!("installed in {}", prefix.display());
    Ok(())
}

/// Installs the C library, with the links to it and the files that linkers take, and the library of FMUs.
fn install_libraries(names: &Names, built: &Path, prefix: &Path) -> Result<(), String> {
    let [shared, place] = &names.shared;
    copy(&built.join(shared), &prefix.join(place))?;
    let folder = prefix.join(names.folder());
    let file = place.rsplit('/').next().unwrap_or(place);
    for name in &names.links {
        link(file, &folder.join(name))?;
    }
    for [name, place] in names.import.iter().chain([&names.archive]) {
        copy(&built.join(name), &prefix.join(place))?;
    }
    let of_fmus = HERE.library("enmm_fmu");
    copy(&built.join(&of_fmus), &folder.join(&of_fmus))?;
    // Its older names, of a time when each version of FMI had a library.
    ["enmm_fmi2", "enmm_fmi3"].iter().try_for_each(|name| link(&of_fmus, &folder.join(HERE.library(name))))
}

/// Links the name that linked programs look for to the C library of a platform in a folder.
pub fn link_series(platform: &Platform, folder: &Path) -> Result<(), String> {
    let names = System::of(platform).names(env!("CARGO_PKG_VERSION"));
    let file = &names.shared[0];
    names.links.iter().filter(|name| *name != file).try_for_each(|name| link(file, &folder.join(name)))
}

/// The file of pkg-config; its prefix is where it lies, so that the whole may be moved.
const PKG_CONFIG: &str = include_str!("enmm.pc");
/// The targets for CMake.
const CMAKE: &str = include_str!("enmmConfig.cmake");
/// The version file for CMake.
const CMAKE_VERSION: &str = include_str!("enmmConfigVersion.cmake");

/// A file with the version, its series (the same major version and, before 1.0, the same minor one), the names of the
/// library and the libraries of the system, which a mark parts.
fn filled(text: &str, version: &str, names: &Names, mark: &str) -> String {
    let mut parts = version.split('.');
    let (major, minor) = (parts.next().unwrap_or("0"), parts.next().unwrap_or("0"));
    let series = if major == "0" { format!("0.{minor}") } else { major.to_owned() };
    let text = text.replace("@VERSION@", version).replace("@SERIES@", &series);
    let text = text.replace("@SHARED_PROPERTIES@", &names.properties()).replace("@STATIC_LIBRARY@", names.archive[1]);
    text.replace("@SYSTEM_LIBRARIES@", &names.needed.replace(' ', mark))
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    repository::make(to.parent().ok_or("a path without a folder")?)?;
    // A library that a program has open is replaced, not written over.
    let _ = std::fs::remove_file(to);
    std::fs::copy(from, to).map(|_| ()).map_err(repository::at(from))
}

/// Makes a link to a file of the same folder, or a copy of it where the system has no links.
fn link(file: &str, link: &Path) -> Result<(), String> {
    let _ = std::fs::remove_file(link);
    #[cfg(unix)]
    return std::os::unix::fs::symlink(file, link).map_err(repository::at(link));
    #[cfg(not(unix))]
    return copy(&link.with_file_name(file), link);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_of_a_series_agree() {
        let of = |text, version| filled(text, version, &System::Linux.names(version), ";");
        assert!(of(CMAKE_VERSION, "0.1.0").contains(r#"MATCHES "^0.1[.]""#));
        assert!(of(CMAKE_VERSION, "2.3.4").contains(r#"MATCHES "^2[.]""#));
        assert!(of(PKG_CONFIG, "0.1.0").contains("\nVersion: 0.1.0\n"));
    }

    #[test]
    fn every_system_has_whole_files() {
        for system in [System::Linux, System::Mac, System::Mingw, System::Msvc] {
            let names = system.names("0.1.0");
            for (text, mark) in [(PKG_CONFIG, " "), (CMAKE, ";")] {
                let text = filled(text, "0.1.0", &names, mark);
                assert!(!text.replace("@rpath/", "").contains('@'), "{system:?}: {text}");
                assert!(text.contains(&names.needed.replace(' ', mark)), "{system:?}: {text}");
            }
            let cmake = filled(CMAKE, "0.1.0", &names, ";");
            assert!(cmake.contains(&names.shared[1]) && cmake.contains(names.archive[1]), "{system:?}: {cmake}");
        }
    }
}
