//! Names of the installed C library on the systems that programs are linked on.
//!
//! A program that was linked with the library of one series looks for the file of that series, so that another one can
//! be installed beside it. On Windows there is one name, and the folder of the program decides.

use crate::platform::Platform;

/// A system, by its names of libraries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum System {
    /// Linux and its like.
    Linux,
    /// macOS.
    Mac,
    /// Windows with the tools of GNU.
    Mingw,
    /// Windows with those of Microsoft.
    Msvc,
}

/// Names of the C library on a system; paths are relative to the prefix.
#[derive(Debug, PartialEq, Eq)]
pub struct Names {
    /// The shared library as cargo builds it, and its place.
    pub shared: [String; 2],
    /// Links in the folder of the shared library that lead to it.
    pub links: Vec<String>,
    /// Name that a linked program looks for.
    pub wanted: String,
    /// The import library as cargo builds it, and its place.
    pub import: Option<[&'static str; 2]>,
    /// The static library as cargo builds it, and its place.
    pub archive: [&'static str; 2],
    /// Libraries of the system that the static one needs, as linkers take them.
    pub needed: &'static str,
}

impl System {
    /// That of a platform.
    pub fn of(platform: &Platform) -> Self {
        let is_here = platform.cross.is_none();
        match platform.is_windows() {
            true if is_here && cfg!(target_env = "msvc") => Self::Msvc,
            true => Self::Mingw,
            false if is_here && cfg!(target_os = "macos") => Self::Mac,
            false => Self::Linux,
        }
    }

    /// Names of the library of a version, such as 0.1.0.
    pub fn names(self, version: &str) -> Names {
        let major = version.split('.').next().unwrap_or("0");
        let dll = || ["enmm.dll", "bin/enmm.dll"].map(str::to_owned);
        match self {
            Self::Linux => Names {
                shared: ["libenmm.so".to_owned(), format!("lib/libenmm.so.{version}")],
                links: vec![format!("libenmm.so.{major}"), "libenmm.so".to_owned()],
                wanted: format!("libenmm.so.{major}"),
                import: None,
                archive: ["libenmm.a", "lib/libenmm.a"],
                needed: "-lgcc_s -lutil -lrt -lpthread -lm -ldl -lc",
            },
            Self::Mac => Names {
                shared: ["libenmm.dylib".to_owned(), format!("lib/libenmm.{version}.dylib")],
                links: vec![format!("libenmm.{major}.dylib"), "libenmm.dylib".to_owned()],
                wanted: format!("@rpath/libenmm.{major}.dylib"),
                import: None,
                archive: ["libenmm.a", "lib/libenmm.a"],
                needed: "-lSystem -lc -lm",
            },
            Self::Mingw => Names {
                shared: dll(),
                links: Vec::new(),
                wanted: "enmm.dll".to_owned(),
                import: Some(["libenmm.dll.a", "lib/libenmm.dll.a"]),
                archive: ["libenmm.a", "lib/libenmm.a"],
                needed: "-lkernel32 -lntdll -luserenv -lws2_32 -ldbghelp",
            },
            Self::Msvc => Names {
                shared: dll(),
                links: Vec::new(),
                wanted: "enmm.dll".to_owned(),
                import: Some(["enmm.dll.lib", "lib/enmm.lib"]),
                archive: ["enmm.lib", "lib/enmm_static.lib"],
                needed: "kernel32.lib ntdll.lib userenv.lib ws2_32.lib dbghelp.lib",
            },
        }
    }
}

impl Names {
    /// Folder of the shared library.
    pub fn folder(&self) -> &str {
        self.shared[1].split('/').next().unwrap_or("lib")
    }

    /// Properties by which CMake links programs with the shared library, a line each.
    pub fn properties(&self) -> String {
        let place = |place: &str| format!("\"${{_enmm_prefix}}/{place}\"");
        let location = format!("IMPORTED_LOCATION {}", place(&self.shared[1]));
        let second = match self.import {
            Some([_, import]) => format!("IMPORTED_IMPLIB {}", place(import)),
            None => format!("IMPORTED_SONAME \"{}\"", self.wanted),
        };
        format!("{location}\n    {second}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_finds_the_library_of_its_series_by_a_link() {
        let linux = System::Linux.names("0.1.0");
        assert_eq!(linux.shared, ["libenmm.so", "lib/libenmm.so.0.1.0"]);
        assert_eq!(linux.links, ["libenmm.so.0", "libenmm.so"]);
        let mac = System::Mac.names("2.3.4");
        assert_eq!(mac.shared, ["libenmm.dylib", "lib/libenmm.2.3.4.dylib"]);
        assert_eq!(mac.links, ["libenmm.2.dylib", "libenmm.dylib"]);
        for names in [linux, mac] {
            let wanted = names.wanted.trim_start_matches("@rpath/");
            assert!(names.links.iter().any(|link| link == wanted), "{names:?}");
            assert_eq!(names.folder(), "lib");
        }
    }

    #[test]
    fn windows_has_the_library_beside_programs_and_what_linkers_take_in_lib() {
        for system in [System::Mingw, System::Msvc] {
            let names = system.names("0.1.0");
            assert_eq!((names.folder(), names.links.len()), ("bin", 0));
            let [_, import] = names.import.expect("an import library");
            assert!(import != names.archive[1] && import.starts_with("lib/"), "{names:?}");
        }
    }

    #[test]
    fn cmake_links_with_the_import_library_where_there_is_one() {
        let of = |system: System| system.names("0.1.0").properties();
        assert_eq!(
            of(System::Linux),
            "IMPORTED_LOCATION \"${_enmm_prefix}/lib/libenmm.so.0.1.0\"\n    IMPORTED_SONAME \"libenmm.so.0\""
        );
        assert!(of(System::Mac).ends_with("IMPORTED_SONAME \"@rpath/libenmm.0.dylib\""));
        assert!(of(System::Mingw).ends_with("IMPORTED_IMPLIB \"${_enmm_prefix}/lib/libenmm.dll.a\""));
        assert!(of(System::Msvc).ends_with("IMPORTED_IMPLIB \"${_enmm_prefix}/lib/enmm.lib\""));
    }
}
