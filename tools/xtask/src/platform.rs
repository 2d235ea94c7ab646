//! Platforms that program and libraries are built for: this one, and those that Debian has cross compilers for.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX, OS};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::repository::{self, Repository, succeeds};

/// Names of files, tools and folders of a platform.
pub struct Platform {
    /// The word of its task; also its folder in the target folder.
    pub name: &'static str,
    /// Requirements of a cross build; none for this machine.
    pub cross: Option<Cross>,
    /// Version of the C library of Linux that programs are linked against by zig; none for that of this machine.
    pub glibc: Option<&'static str>,
    library: [&'static str; 2],
    program: &'static str,
    /// Program that removes symbols, with its options.
    strip: Option<&'static [&'static str]>,
    /// Folder of cargo in the target folder; empty for the target folder itself.
    cargo: &'static str,
    /// Folder of the profile by which whatever is shipped is built.
    profile: &'static str,
}

/// Requirements of a cross build.
pub struct Cross {
    /// Name of the target of the compiler.
    pub triple: &'static str,
    /// C compiler, which is the linker as well.
    pub compiler: &'static str,
    /// Variables of cargo for its builds.
    pub settings: &'static [(&'static str, &'static str)],
    /// Debian's package of the C compiler.
    pub compiler_package: &'static str,
    /// The platform as `sysconfig.get_platform()` of its Python names it.
    pub wheel: &'static str,
    /// Name of FMI 3, by which `enmm fmu --library` takes its libraries.
    pub fmi: &'static str,
    /// File that linkers of C programs take beside the shared library.
    pub import_library: Option<&'static str>,
    /// Program that runs its programs on this machine, with its options.
    pub emulator: &'static [&'static str],
    /// Debian's packages of the emulator.
    pub emulator_packages: &'static str,
}

/// This machine.
pub const HERE: Platform = Platform {
    name: "here",
    cross: None,
    glibc: None,
    library: [DLL_PREFIX, DLL_SUFFIX],
    program: EXE_SUFFIX,
    strip: match OS.as_bytes() {
        b"windows" => None,
        b"macos" => Some(&["strip", "-x"]),
        _ => Some(&["strip", "--strip-unneeded"]),
    },
    cargo: "",
    profile: "ship",
};

/// This machine with the C library of Linux systems of 2018 and later: Debian 10, RHEL 8.
pub const OLD_LINUX: Platform = Platform { name: "old-linux", glibc: Some("2.28"), ..HERE };

/// Windows by mingw-w64.
pub const WINDOWS: Platform = Platform {
    name: "windows",
    cross: Some(Cross {
        triple: "x86_64-pc-windows-gnu",
        compiler: "x86_64-w64-mingw32-gcc",
        settings: &[],
        compiler_package: "gcc-mingw-w64-x86-64-win32",
        wheel: "win-amd64",
        fmi: "x86_64-windows",
        import_library: Some("libenmm.dll.a"),
        emulator: &["wine"],
        emulator_packages: "wine wine64",
    }),
    library: ["", ".dll"],
    program: ".exe",
    strip: Some(&["x86_64-w64-mingw32-strip", "--strip-unneeded"]),
    ..HERE
};

/// Linux on ARM.
pub const AARCH64: Platform = Platform {
    name: "aarch64",
    cross: Some(Cross {
        triple: "aarch64-unknown-linux-gnu",
        compiler: "aarch64-linux-gnu-gcc",
        settings: &[("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER", "aarch64-linux-gnu-gcc")],
        compiler_package: "gcc-aarch64-linux-gnu libc6-dev-arm64-cross",
        wheel: "linux-aarch64",
        fmi: "aarch64-linux",
        import_library: None,
        emulator: &["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"],
        emulator_packages: "qemu-user",
    }),
    library: ["lib", ".so"],
    program: "",
    strip: Some(&["aarch64-linux-gnu-strip", "--strip-unneeded"]),
    ..HERE
};

/// Windows as `cargo xtask test --all` builds it.
pub const WINDOWS_QUICK: Platform = WINDOWS.for_tests("windows-quick");

/// ARM as `cargo xtask test --all` builds it.
pub const AARCH64_QUICK: Platform = AARCH64.for_tests("aarch64-quick");

impl Platform {
    /// The platform as tests build it: by their profile, with all symbols, and in a folder that cargo does not lock
    /// for the tests beside it.
    const fn for_tests(self, name: &'static str) -> Self {
        Self { name, strip: None, cargo: "cross-build", profile: "debug", ..self }
    }

    /// File name of the library `name`.
    pub fn library(&self, name: &str) -> String {
        let [prefix, suffix] = self.library;
        format!("{prefix}{name}{suffix}")
    }

    /// File name of the program.
    pub fn program(&self) -> String {
        format!("enmm{}", self.program)
    }

    /// File names of all that is shipped: the library, which FMUs have as well, and the program.
    pub fn binaries(&self) -> [String; 2] {
        [self.library("enmm"), self.program()]
    }

    /// Whether programs of the platform run on Windows.
    pub fn is_windows(&self) -> bool {
        self.cross.as_ref().map_or(cfg!(windows), |cross| cross.triple.contains("windows"))
    }

    /// Folder of cargo.
    pub fn cargo(&self, repository: &Repository) -> PathBuf {
        repository.target.join(self.cargo)
    }

    /// Name of the target of the compiler, where cargo is given one.
    pub fn triple(&self) -> Option<String> {
        let old = self.glibc.map(|_| format!("{ARCH}-unknown-linux-gnu"));
        self.cross.as_ref().map(|cross| cross.triple.to_owned()).or(old)
    }

    /// Folder in which cargo leaves what it builds.
    pub fn built(&self, repository: &Repository) -> PathBuf {
        self.cargo(repository).join(self.triple().unwrap_or_default()).join(self.profile)
    }

    /// Folder of the binaries as they are shipped.
    pub fn shipped(&self, repository: &Repository) -> PathBuf {
        repository.target.join(if self.triple().is_some() { self.name } else { "wheel-binaries" })
    }

    /// Folder of the wheel.
    pub fn wheels(&self, repository: &Repository) -> PathBuf {
        if self.triple().is_some() { self.shipped(repository).join("wheels") } else { repository.target.join("wheels") }
    }

    /// Copies a binary without its symbols and line tables, which only developers need.
    pub fn strip(&self, repository: &Repository, from: &Path, to: &Path) -> Result<(), String> {
        std::fs::copy(from, to).map_err(repository::at(from))?;
        let Some([program, options @ ..]) = self.strip else { return Ok(()) };
        repository::run(repository.command(program).args(options).arg(to))
    }
}

impl Cross {
    /// Whether the standard library of Rust for the platform is installed.
    pub fn has_standard_library(&self) -> bool {
        let print = Command::new("rustc").args(["--print", "target-libdir", "--target", self.triple]).output();
        let folder = print.map(|told| String::from_utf8_lossy(&told.stdout).trim().to_owned()).unwrap_or_default();
        !folder.is_empty() && Path::new(&folder).is_dir()
    }

    /// Whether there is a C compiler for the platform.
    pub fn has_compiler(&self) -> bool {
        succeeds(Command::new(self.compiler).arg("--version"))
    }

    /// Whether there is an emulator of the platform.
    pub fn has_emulator(&self) -> bool {
        self.emulator.first().is_some_and(|program| succeeds(Command::new(program).arg("--version")))
    }

    /// Requirements of a cross build that this machine lacks, with the commands that install them.
    pub fn missing(&self) -> Option<String> {
        let Self { triple, compiler, compiler_package, .. } = self;
        let mut missing = Vec::new();
        if !self.has_standard_library() {
            missing.push(format!("the standard library of Rust for {triple}: `rustup target add {triple}`"));
        }
        if !self.has_compiler() {
            missing.push(format!("the linker {compiler} (Debian: `apt-get install {compiler_package}`)"));
        }
        (!missing.is_empty()).then(|| format!("this machine lacks {}", missing.join(", and ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_have_the_names_of_their_platform() {
        assert_eq!(WINDOWS.binaries(), ["enmm.dll", "enmm.exe"]);
        assert_eq!(AARCH64.binaries(), ["libenmm.so", "enmm"]);
    }

    #[test]
    fn what_is_missing_is_named_with_its_remedy() {
        let known = AARCH64.cross.expect("a cross build");
        let (triple, compiler, compiler_package) = ("no-such-target", "no-such-compiler", "the-package");
        let cross = Cross { triple, compiler, compiler_package, ..known };
        let told = cross.missing().expect("something");
        assert!(told.contains("`rustup target add no-such-target`"), "{told}");
        assert!(told.contains("no-such-compiler (Debian: `apt-get install the-package`)"), "{told}");
    }
}
