//! Platforms whose libraries an FMU may contain: their folders in it, and whether a file is a library of one of them.

use object::read::macho::MachOFatFile32;
use object::{Architecture, BinaryFormat, FileKind, Object, ObjectKind};

use crate::table::Version;

/// A platform.
#[derive(Debug, PartialEq, Eq)]
pub struct Platform {
    /// Folder below `binaries` by the name of FMI 2; platforms of the same system and word length share one.
    fmi2: &'static str,
    /// The same of FMI 3, which also names the processor.
    fmi3: &'static str,
    suffix: &'static str,
    format: BinaryFormat,
    processor: Architecture,
}

use Architecture::{Aarch64, I386, X86_64};
use BinaryFormat::{Elf, MachO, Pe};

/// Platforms in the order in which an FMU contains their libraries.
pub const PLATFORMS: [Platform; 7] = [
    platform("linux64", "x86_64-linux", ".so", Elf, X86_64),
    platform("linux64", "aarch64-linux", ".so", Elf, Aarch64),
    platform("win64", "x86_64-windows", ".dll", Pe, X86_64),
    platform("win64", "aarch64-windows", ".dll", Pe, Aarch64),
    platform("win32", "x86-windows", ".dll", Pe, I386),
    platform("darwin64", "x86_64-darwin", ".dylib", MachO, X86_64),
    platform("darwin64", "aarch64-darwin", ".dylib", MachO, Aarch64),
];

const fn platform(
    fmi2: &'static str,
    fmi3: &'static str,
    suffix: &'static str,
    format: BinaryFormat,
    processor: Architecture,
) -> Platform {
    Platform { fmi2, fmi3, suffix, format, processor }
}

/// A library and the folder of the FMU that it belongs in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Library {
    /// Folder below `binaries`.
    pub folder: String,
    /// End of the file name, with its dot.
    pub suffix: &'static str,
    /// The file.
    pub bytes: Vec<u8>,
}

/// Why a file is not the library of a platform. The texts name neither the file nor where it was given.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotALibrary {
    /// No platform has this name.
    #[error("unknown platform {0:?}: known are {known}", known = known())]
    Platform(String),
    /// The file is of no known format.
    #[error("is not a shared library ({0}): give the {1} file of a build for {2}")]
    Format(String, &'static str, String),
    /// The file is a library of other platforms.
    #[error("is a library of {found}, not of {wanted}: give the name of its platform, or the library of {wanted}")]
    Other {
        /// Kind of the file.
        found: String,
        /// The name that was given.
        wanted: String,
    },
    /// The library lacks the entry points of the version.
    #[error("has no entry point {entry}: an FMU of FMI {number} needs the library `enmm` of that platform")]
    Entry {
        /// Entry point that it must have.
        entry: &'static str,
        /// Version of the standard.
        number: u8,
    },
}

/// Names of all platforms, those of FMI 2 first.
fn known() -> String {
    let mut names: Vec<&str> = PLATFORMS.iter().map(|platform| platform.fmi2).collect();
    names.dedup();
    names.extend(PLATFORMS.iter().map(|platform| platform.fmi3));
    names.join(", ")
}

impl Library {
    /// The library of this system, whose file is not looked into.
    pub fn of_this_system(version: Version, bytes: Vec<u8>) -> Self {
        Self { folder: crate::library::platform(version), suffix: std::env::consts::DLL_SUFFIX, bytes }
    }

    /// The library of the platform `name`, which either version of the standard may give it. A file for several
    /// processors (macOS) has a place among those of FMI 2; FMI 3 asks for the name of one of them.
    ///
    /// # Errors
    /// When no platform has this name, or the file is not the library of that platform for this version.
    pub fn of(name: &str, version: Version, bytes: Vec<u8>) -> Result<Self, NotALibrary> {
        let named = |platform: &&Platform| platform.fmi2 == name || platform.fmi3 == name;
        let wanted = PLATFORMS.iter().find(named).ok_or_else(|| NotALibrary::Platform(name.to_owned()))?;
        let found =
            platforms_of(&bytes).map_err(|reason| NotALibrary::Format(reason, wanted.suffix, name.to_owned()))?;
        let platform = found.iter().copied().find(named).ok_or_else(|| NotALibrary::Other {
            found: found.iter().map(|platform| platform.fmi3).collect::<Vec<_>>().join(" and "),
            wanted: name.to_owned(),
        })?;
        let (number, entry, folder) = match version {
            Version::Two => (2, "fmi2DoStep", platform.fmi2),
            Version::Three => (3, "fmi3DoStep", platform.fmi3),
        };
        if !bytes.windows(entry.len()).any(|part| part == entry.as_bytes()) {
            return Err(NotALibrary::Entry { entry, number });
        }
        Ok(Self { folder: folder.to_owned(), suffix: platform.suffix, bytes })
    }
}

/// The platforms for which a file is a shared library, at least one.
fn platforms_of(bytes: &[u8]) -> Result<Vec<&'static Platform>, String> {
    let damaged = |error: object::Error| format!("its header cannot be read: {error}");
    let kind = FileKind::parse(bytes).map_err(|_| "neither ELF, PE nor Mach-O".to_owned())?;
    if kind != FileKind::MachOFat32 {
        return platform_of(bytes).map(|platform| vec![platform]);
    }
    let parts = MachOFatFile32::parse(bytes).map_err(damaged)?;
    let found: Vec<_> = parts
        .arches()
        .iter()
        .map(|part| object::read::macho::FatArch::data(part, bytes).map_err(damaged).and_then(platform_of))
        .collect::<Result<_, _>>()?;
    if found.is_empty() { Err("a Mach-O file without parts".to_owned()) } else { Ok(found) }
}

fn platform_of(bytes: &[u8]) -> Result<&'static Platform, String> {
    let file = object::File::parse(bytes).map_err(|error| format!("its header cannot be read: {error}"))?;
    if file.kind() != ObjectKind::Dynamic {
        return Err(format!("a {:?} file of another kind, such as a program or an object", file.format()));
    }
    let (format, processor) = (file.format(), file.architecture());
    let is = |platform: &&Platform| platform.format == format && platform.processor == processor;
    PLATFORMS.iter().find(is).ok_or_else(|| format!("a {format:?} file for {processor:?}"))
}
