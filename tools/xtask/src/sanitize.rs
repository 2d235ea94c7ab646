//! Memory under the eyes of other tools: valgrind and the sanitizers of the C compiler over the hosts in C, the address
//! sanitizer of the nightly compiler over the share of fuzzing, its thread sanitizer over the claim of equal bits and
//! over the tables of handles, and its interpreter Miri over these tables. What is missing is reported with the command
//! that installs it, and is no failure.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::repository::{self, Repository, succeeds};
use crate::steps::{Verdict, attempt};

const SMALL: &str = "ffi/capi/tests/cases/small.toml";
/// Hosts in C with their arguments. Left out are the one that counts its own memory, where valgrind's would count as
/// well, and the one that forks, whose child has none of the threads that held memory in its parent.
const HOSTS: [(&str, &[&str]); 4] = [
    ("ffi/capi/tests/c/checks.c", &[SMALL]),
    ("ffi/capi/tests/c/unchanged.c", &[SMALL]),
    ("ffi/capi/tests/c/threads.c", &[SMALL]),
    ("ffi/c/coupled_reservoir.c", &["examples/cases/coupled_slope.toml"]),
];
const VALGRIND: [&str; 5] = [
    "--quiet",
    "--error-exitcode=99",
    "--leak-check=full",
    "--show-leak-kinds=definite",
    "--errors-for-leak-kinds=definite",
];
const HOST_FLAGS: [&str; 2] = ["-fsanitize=address,undefined", "-fno-sanitize-recover=undefined"];
/// A flood is a find, as without the sanitizer, which takes too much address space for a limit of that.
const ASAN_OPTIONS: &str = "detect_leaks=1:hard_rss_limit_mb=4096:allocator_may_return_null=1";

/// Name of a tool with what it looks at, and how it is run.
type Tool = (&'static str, fn(&Repository) -> Result<Verdict, String>);

const TOOLS: [Tool; 6] = [
    ("valgrind, hosts in C", valgrind),
    ("sanitizers of the C compiler, hosts in C", hosts),
    ("address sanitizer, share of fuzzing", addresses),
    ("thread sanitizer, equal bits at any number of threads", threads),
    ("thread sanitizer, handle tables", tables_with_threads),
    ("Miri, handle tables", tables_in_miri),
];

/// Runs all tools that are there, or those alone that look at the hosts in C and need no build of their own; fails when
/// one finds something.
pub fn run(repository: &Repository, hosts_alone: bool) -> Result<(), String> {
    let tools = if hosts_alone { &TOOLS[..2] } else { &TOOLS[..] };
    let mut bad = Vec::new();
    for &(name, act) in tools {
        if attempt(["clean", "FOUND"], name, || act(repository)) == Some(false) {
            bad.push(name);
        }
    }
    if bad.is_empty() { Ok(()) } else { Err(format!("something was found by {}: see above", bad.join("; "))) }
}

fn missing(what: &str) -> Result<Verdict, String> {
    Ok(Verdict::LeftOut(what.to_owned()))
}

fn valgrind(repository: &Repository) -> Result<Verdict, String> {
    if !succeeds(Command::new("valgrind").arg("--version")) {
        return missing("valgrind is not there (Debian: apt-get install valgrind)");
    }
    let libraries = libraries(repository)?;
    for (source, arguments) in HOSTS {
        let program = compile(repository, source, &libraries, &[])?;
        let mut watched = repository.command("valgrind");
        watched.args(VALGRIND).arg(program).args(arguments).stdout(Stdio::null());
        repository::run(&mut watched)?;
    }
    Ok(Verdict::Good(format!("{} programs", HOSTS.len())))
}

/// The hosts with address and undefined-behaviour sanitizers, which see what the library reads and writes by functions
/// of C, and every leak of it.
fn hosts(repository: &Repository) -> Result<Verdict, String> {
    let libraries = libraries(repository)?;
    for (k, (source, arguments)) in HOSTS.into_iter().enumerate() {
        let program = match compile(repository, source, &libraries, &HOST_FLAGS) {
            Err(_) if k == 0 => return missing("the C compiler makes no programs with sanitizers"),
            compiled => compiled?,
        };
        let mut watched = repository.command(program);
        watched.env("ASAN_OPTIONS", "detect_leaks=1").args(arguments).stdout(Stdio::null());
        repository::run(&mut watched)?;
    }
    Ok(Verdict::Good(format!("{} programs", HOSTS.len())))
}

/// Builds the libraries; returns their folder.
fn libraries(repository: &Repository) -> Result<PathBuf, String> {
    repository.build(&["--workspace"])?;
    Ok(repository.built())
}

/// Compiles a host in C against the library as it is built.
fn compile(repository: &Repository, source: &str, libraries: &Path, flags: &[&str]) -> Result<PathBuf, String> {
    let folder = repository.target.join("sanitize-hosts");
    repository::make(&folder)?;
    let program = folder.join(Path::new(source).file_stem().unwrap_or_default());
    let mut cc = repository.command(std::env::var_os("CC").unwrap_or_else(|| "cc".into()));
    cc.args(flags).args(["-std=c99", "-g", "-O1", "-Iinclude", source, "-o"]).arg(&program).arg("-L").arg(libraries);
    cc.args(["-lenmm", "-lm", "-lpthread"]).arg(format!("-Wl,-rpath,{}", libraries.display()));
    repository::run(&mut cc)?;
    Ok(program)
}

/// The nightly compiler, which alone has sanitizers.
struct Nightly {
    system: PathBuf,
    /// Must be named as the target, so that build scripts and macros, which run in the compiler, go without sanitizer.
    host: String,
}

impl Nightly {
    fn find() -> Option<Self> {
        let mut ask = Command::new("rustup");
        ask.args(["run", "nightly", "rustc", "--print", "sysroot", "--print", "host-tuple"]);
        let told = ask.stderr(Stdio::null()).output().ok().filter(|told| told.status.success())?;
        let told = String::from_utf8(told.stdout).ok()?;
        let mut lines = told.lines();
        Some(Self { system: lines.next()?.into(), host: lines.next()?.to_owned() })
    }

    /// Its cargo, which builds with a sanitizer into a folder of its own.
    fn cargo(&self, repository: &Repository, sanitizer: &str, arguments: &[&str]) -> Command {
        let mut cargo = repository.command("rustup");
        cargo.args(["run", "nightly", "cargo"]).args(arguments).args(["--release", "--target", &self.host]);
        cargo.env("CARGO_TARGET_DIR", place(repository)).env("RUSTFLAGS", format!("-Zsanitizer={sanitizer}"));
        cargo.env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1");
        cargo
    }
}

/// Where sanitized programs are built; the room is given back when they have run.
fn place(repository: &Repository) -> PathBuf {
    repository.target.join("sanitize")
}

fn addresses(repository: &Repository) -> Result<Verdict, String> {
    let Some(nightly) = Nightly::find() else {
        return missing("there is no nightly compiler (rustup toolchain install nightly)");
    };
    repository::run(&mut nightly.cargo(repository, "address", &["build", "--package", "enmm-fuzz"]))?;
    let mut fuzz = repository.command(place(repository).join(&nightly.host).join("release/enmm-fuzz"));
    fuzz.env("ASAN_OPTIONS", ASAN_OPTIONS).arg("--finds").arg(repository.target.join("fuzz-sanitized"));
    repository::run(&mut fuzz)?;
    repository::remove(&place(repository))?;
    Ok(Verdict::Good("all parts".to_owned()))
}

fn threads(repository: &Repository) -> Result<Verdict, String> {
    with_threads(repository, &["--test", "engine", "determinism"], "tests/determinism.rs")
}

fn tables_with_threads(repository: &Repository) -> Result<Verdict, String> {
    with_threads(repository, &["--package", "enmm-handles", "--lib"], "threads that make, find and remove objects")
}

/// The handle tables interpreted, where every access to memory and every lock is looked at.
fn tables_in_miri(repository: &Repository) -> Result<Verdict, String> {
    if !succeeds(Command::new("rustup").args(["run", "nightly", "cargo", "miri", "--version"])) {
        return missing("Miri is not there (rustup component add miri --toolchain nightly)");
    }
    let mut miri = repository.command("rustup");
    miri.args(["run", "nightly", "cargo", "miri", "test", "--package", "enmm-handles", "--lib"]);
    repository::run(miri.env("CARGO_TARGET_DIR", place(repository)).stdout(Stdio::null()))?;
    repository::remove(&place(repository))?;
    Ok(Verdict::Good("threads that make, find and remove objects".to_owned()))
}

/// Runs tests that the nightly compiler has built with its thread sanitizer.
fn with_threads(repository: &Repository, tests: &[&str], seen: &str) -> Result<Verdict, String> {
    let sources = |nightly: &Nightly| nightly.system.join("lib/rustlib/src/rust/library").is_dir();
    let Some(nightly) = Nightly::find().filter(sources) else {
        return missing(
            "the nightly compiler, or the sources of its standard library, which must be built along, are not there \
             (rustup component add rust-src --toolchain nightly)",
        );
    };
    let arguments = [&["test", "-Zbuild-std"], tests].concat();
    repository::run(&mut nightly.cargo(repository, "thread", &arguments))?;
    repository::remove(&place(repository))?;
    Ok(Verdict::Good(seen.to_owned()))
}
