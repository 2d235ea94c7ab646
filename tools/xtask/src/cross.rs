//! Program, libraries and wheel for other platforms, and their tests on emulators.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::bits;
use crate::counts::Counts;
use crate::debian;
use crate::emulator::Emulator;
use crate::install;
use crate::platform::{Cross, Platform};
use crate::repository::succeeds;
use crate::repository::{self, Repository};
use crate::venv::{self, Packages};
use crate::wheel;

/// Header that C programs need.
const HEADER: &str = "include/enmm.h";
/// Host of the C library whose checks call every function, and its case.
const C_CHECKS: [&str; 2] = ["ffi/capi/tests/c/checks.c", "ffi/capi/tests/cases/small.toml"];
/// Host of FMUs.
const FMU_HOST: &str = "ffi/fmi/tests/c/host.c";
/// Installs a Python for Windows with the wheel, and runs it.
const PYTHON: &str = "python_tests/windows/run.py";
/// Case of the FMU that takes many steps.
const FMU_CASE: &str = "examples/cases/coupled_slope.toml";
/// Steps before its rollback.
const FMU_STEPS: &str = "50";
/// Most bytes of an FMU for each platform.
const FMU_SIZE_MAX: u64 = 8_000_000;

/// Builds for a platform; with `--test` in `words` it then tests what it has built.
///
/// # Errors
/// When the words are others, the machine lacks something, something does not build, or a test fails.
pub fn run(repository: &Repository, platform: &Platform, words: &[&str]) -> Result<(), String> {
    let cross = platform.cross.as_ref().ok_or("no cross build is needed for this machine")?;
    match words {
        [] => build(repository, platform, cross).map(|_| ()),
        ["--test"] => test(repository, platform, cross),
        _ => Err(format!("usage: cargo xtask {} [--test]", platform.name)),
    }
}

/// Builds libraries and program for a platform by the profile of tests, compares quick results of that build, on its
/// emulator, with the golden table, with those of FMUs and a rollback, and calls every function of the C library. Says
/// what it leaves out where the machine lacks something.
pub fn quick(repository: &Repository, platform: &Platform) -> Result<Counts, String> {
    let purpose = format!("tests for {}", platform.name);
    let Some(cross) = platform.cross.as_ref().filter(|cross| is_ready(cross, &purpose)) else {
        return Ok(Counts::default());
    };
    let runs = has_emulator(cross, &purpose);
    let mut cargo = repository.cargo(&[if runs { "build" } else { "check" }, "--target", cross.triple]);
    cargo.args(wheel::packages()).envs(cross.settings.iter().copied());
    repository::run(cargo.env("CARGO_TARGET_DIR", platform.cargo(repository)))?;
    if !runs {
        return Ok(Counts::default());
    }
    let place = Place::new(repository, platform, cross)?;
    let (built, shipped) = (platform.built(repository), platform.shipped(repository));
    platform
        .binaries()
        .iter()
        .try_for_each(|name| platform.strip(repository, &built.join(name), &shipped.join(name)))?;
    install::link_series(platform, &shipped)?;
    place.c_library()?;
    bits::elsewhere(repository, platform, &place.emulator, &place.compile(FMU_HOST, &[])?)
}

/// Whether standard library and compiler are there, installed where they can be. Says what is missing.
fn is_ready(cross: &Cross, purpose: &str) -> bool {
    if !cross.has_standard_library() {
        succeeds(Command::new("rustup").args(["target", "add", cross.triple]));
    }
    debian::provide(purpose, cross.compiler_package, || cross.has_compiler());
    cross.missing().map(|missing| println!("SKIPPED {purpose}: {missing}")).is_none()
}

/// Whether the emulator is there, installed where Debian's packages can be; says what is left out without it.
fn has_emulator(cross: &Cross, purpose: &str) -> bool {
    let is_there = debian::provide(purpose, cross.emulator_packages, || cross.has_emulator());
    if !is_there {
        let [emulator, packages] = [cross.emulator[0], cross.emulator_packages];
        println!(
            "SKIPPED {purpose}: nothing that is built can be run, because {emulator} is missing (Debian: `apt-get \
             install {packages}`)"
        );
    }
    is_there
}

/// Builds all that is shipped, and lists it; returns the path of the wheel.
fn build(repository: &Repository, platform: &Platform, cross: &Cross) -> Result<PathBuf, String> {
    let wheel = wheel::build(repository, platform)?;
    let shipped = platform.shipped(repository);
    let copy = |from: &Path| {
        let to = shipped.join(from.file_name().unwrap_or_default());
        std::fs::copy(from, to).map(|_| ()).map_err(repository::at(from))
    };
    cross.import_library.map_or(Ok(()), |name| copy(&platform.built(repository).join(name)))?;
    copy(&repository.root.join(HEADER))?;
    install::link_series(platform, &shipped)?;
    for (name, bytes) in repository::files_of(&shipped)? {
        println!("{:>6.1} MB  {}", bytes.len() as f64 / 1e6, shipped.join(name).display());
    }
    Ok(wheel)
}

/// Builds and tests; says what it leaves out where the machine lacks something that cannot be installed.
fn test(repository: &Repository, platform: &Platform, cross: &Cross) -> Result<(), String> {
    let purpose = format!("cargo xtask {} --test", platform.name);
    if !is_ready(cross, &purpose) {
        return Ok(());
    }
    let wheel = build(repository, platform, cross)?;
    if !has_emulator(cross, &purpose) {
        return Ok(());
    }
    repository.build(&["--workspace"])?;
    let place = Place::new(repository, platform, cross)?;
    place.c_library()?;
    let host = place.compile(FMU_HOST, &[])?;
    // Versions of FMI whose FMUs have a folder for the platform beside that of this machine.
    for version in ["2", "3"].into_iter().filter(|version| bits::has_folder(platform, version)) {
        place.fmu(version, &host)?;
    }
    if platform.is_windows() {
        place.python(&wheel)?;
    }
    bits::all_good(bits::elsewhere(repository, platform, &place.emulator, &host)?)
}

/// Where the tests of a platform run.
struct Place<'a> {
    repository: &'a Repository,
    platform: &'a Platform,
    cross: &'a Cross,
    emulator: Emulator,
    folder: PathBuf,
}

impl<'a> Place<'a> {
    /// Sets up the emulator, and an empty folder.
    fn new(repository: &'a Repository, platform: &'a Platform, cross: &'a Cross) -> Result<Self, String> {
        let folder = repository::fresh(platform.shipped(repository).join("tests"))?;
        Ok(Self { repository, platform, cross, emulator: Emulator::of(repository, cross)?, folder })
    }

    /// Compiles a program in C99 for the platform.
    fn compile(&self, source: &str, libraries: &[&str]) -> Result<PathBuf, String> {
        let name = Path::new(source).file_stem().unwrap_or_default().to_string_lossy();
        let program = self.folder.join(format!("{name}.exe"));
        let mut compile = self.repository.command(self.cross.compiler);
        compile.args(["-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-Iinclude", source, "-o"]).arg(&program);
        compile.arg("-L").arg(self.platform.shipped(self.repository)).args(libraries);
        repository::run(&mut compile)?;
        Ok(program)
    }

    /// Calls every function of the C library.
    fn c_library(&self) -> Result<(), String> {
        let shipped = self.platform.shipped(self.repository);
        let [source, case] = C_CHECKS;
        let checks = self.compile(source, &["-lenmm", "-lm", &format!("-Wl,-rpath,{}", shipped.display())])?;
        let library = self.platform.library("enmm");
        // Windows looks beside the program.
        let from = shipped.join(&library);
        std::fs::copy(&from, self.folder.join(&library)).map_err(repository::at(&from))?;
        repository::run(self.emulator.command(self.repository, checks).arg(case))?;
        println!("the C library does what {source} checks");
        Ok(())
    }

    /// Compares what the wheel does in a Python for Windows with the package on this machine.
    fn python(&self, wheel: &Path) -> Result<(), String> {
        let mut python = venv::command(self.repository, Packages::All)?;
        python.arg(PYTHON).arg(wheel).arg(&self.folder).arg(self.cross.compiler).args(self.emulator.words());
        self.emulator.prepare(&mut python);
        repository::run(&mut python)
    }

    /// Packs an FMU for both platforms, has FMPy check and run it here, and compares its steps on both platforms.
    fn fmu(&self, version: &str, host: &Path) -> Result<(), String> {
        let packed = self.folder.join(format!("coupled_slope_fmi{version}.fmu"));
        let mut pack = self.repository.command(self.repository.enmm());
        pack.args(["fmu", FMU_CASE, "--fmi", version, "--library"]);
        repository::run(pack.arg(bits::library(self.repository, self.platform)).arg("-o").arg(&packed))?;
        let size = packed.metadata().map_err(repository::at(&packed))?.len();
        if size > 2 * FMU_SIZE_MAX {
            return Err(format!("{}: has {size} bytes, must have at most {}", packed.display(), 2 * FMU_SIZE_MAX));
        }
        for words in [&["validate"] as &[&str], &["simulate", "--stop-time", "0.1"]] {
            let mut fmpy = venv::command(self.repository, Packages::Usual)?;
            fmpy.args(["-m", "fmpy", words[0]]).arg(&packed).args(&words[1..]);
            repository::capture(&mut fmpy)?;
        }
        let steps = |name: &str, words: &[&str]| -> Result<_, String> {
            let folder = self.folder.join(format!("{name}_fmi{version}"));
            let mut steps = venv::command(self.repository, Packages::Usual)?;
            steps.arg("python_tests/fmu_bits.py").arg(&packed).arg(&folder).args(["--before", FMU_STEPS]).args(words);
            self.emulator.prepare(&mut steps);
            repository::run(&mut steps)?;
            repository::files_of(&folder)
        };
        let here = steps("here", &[])?;
        let words = bits::host_words(self.platform, &self.emulator, version, host);
        let there = steps("there", &words.iter().map(String::as_str).collect::<Vec<_>>())?;
        if here != there {
            return Err(format!(
                "FMI {version}: {FMU_STEPS} steps and a rollback have other bits: {}",
                self.folder.display()
            ));
        }
        println!("FMI {version}: {FMU_STEPS} steps and a rollback have the same bits, {:.1} MB", size as f64 / 1e6);
        Ok(())
    }
}
