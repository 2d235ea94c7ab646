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
///
/// # Errors
/// When something does not build or cannot be copied.
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
    let cmake = CMAKE.replace("@SYSTEM_LIBRARIES@", &SYSTEM_LIBRARIES.replace(' ', ";"));
    write(&prefix.join("lib/pkgconfig/enmm.pc"), pkg_config(version))?;
    write(&prefix.join("lib/cmake/enmm/enmmConfig.cmake"), cmake)?;
    write(&prefix.join("lib/cmake/enmm/enmmConfigVersion.cmake"), cmake_version(version))?;
    println!("installed in {}", prefix.display());
    Ok(())
}

/// The file of pkg-config; its prefix is where it lies, so that the whole may be moved.
fn pkg_config(version: &str) -> String {
    [
        "prefix=${pcfiledir}/../..",
        "libdir=${prefix}/lib",
        "includedir=${prefix}/include",
        "",
        "Name: enmm",
        "Description: Explicit numerical manifold method for jointed rock",
        &format!("Version: {version}"),
        "Libs: -L${libdir} -lenmm",
        &format!("Libs.private: {SYSTEM_LIBRARIES}"),
        "Cflags: -I${includedir}",
        "",
    ]
    .join("\n")
}

const CMAKE: &str = r#"# find_package(enmm) gives the targets enmm::enmm (shared) and enmm::static, with their headers.
get_filename_component(_enmm_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
if(NOT TARGET enmm::enmm)
  add_library(enmm::enmm SHARED IMPORTED)
  set_target_properties(enmm::enmm PROPERTIES
    IMPORTED_LOCATION "${_enmm_prefix}/lib/libenmm.so"
    IMPORTED_SONAME "libenmm.so"
    INTERFACE_INCLUDE_DIRECTORIES "${_enmm_prefix}/include")
  add_library(enmm::static STATIC IMPORTED)
  set_target_properties(enmm::static PROPERTIES
    IMPORTED_LOCATION "${_enmm_prefix}/lib/libenmm.a"
    INTERFACE_LINK_LIBRARIES "@SYSTEM_LIBRARIES@"
    INTERFACE_INCLUDE_DIRECTORIES "${_enmm_prefix}/include")
endif()
unset(_enmm_prefix)
"#;

/// A version file: the same major version and, before 1.0, the same minor one.
fn cmake_version(version: &str) -> String {
    let mut parts = version.split('.');
    let (major, minor) = (parts.next().unwrap_or("0"), parts.next().unwrap_or("0"));
    let series = if major == "0" { format!("0.{minor}") } else { major.to_owned() };
    format!(
        r#"set(PACKAGE_VERSION "{version}")
if(PACKAGE_FIND_VERSION VERSION_GREATER PACKAGE_VERSION OR NOT "${{PACKAGE_FIND_VERSION}}." MATCHES "^{series}[.]")
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
else()
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
  if(PACKAGE_FIND_VERSION VERSION_EQUAL PACKAGE_VERSION)
    set(PACKAGE_VERSION_EXACT TRUE)
  endif()
endif()
"#
    )
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
        assert!(cmake_version("0.1.0").contains(r#"MATCHES "^0.1[.]""#));
        assert!(cmake_version("2.3.4").contains(r#"MATCHES "^2[.]""#));
        assert!(pkg_config("0.1.0").contains("\nVersion: 0.1.0\n"));
    }
}
