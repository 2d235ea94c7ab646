//! Builds the library as hosts see it, compiles hosts against it, and runs them.
#![allow(dead_code)]

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

pub const SMALL: &str = "ffi/capi/tests/cases/small.toml";

/// Root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Directory of the libraries, built like the tests themselves.
pub fn libraries() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        // The test runs as target/PROFILE/deps/NAME. Cargo does not build cdylibs for tests, so it is asked to; all of
        // the workspace is built so that it is what `cargo build --workspace` has left behind.
        let test = std::env::current_exe().expect("a test that knows where it is");
        let directory = test.ancestors().nth(2).expect("target/PROFILE").to_owned();
        let profile = directory.file_name().expect("PROFILE").to_string_lossy().replace("debug", "dev");
        let mut build = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        build.args(["build", "--quiet", "--workspace", "--profile", &profile]).current_dir(root());
        succeed(&mut build);
        directory
    })
}

/// Prints values that no test asserts, whether the test passes or not.
pub fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", text.trim_end());
}

/// Whether `program` can be run. Without it the test is skipped: `cargo xtask test` counts the line that says so.
pub fn has(program: &str) -> bool {
    let there = Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success());
    if !there {
        let _ = writeln!(std::io::stdout(), "\nskipped: {program} is not installed");
    }
    there
}

/// Runs a command in the root; fails the test with its output when it fails.
pub fn succeed(command: &mut Command) -> String {
    let output = run(command);
    let (stdout, stderr) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?}: {}\n{stdout}\n{stderr}", output.status);
    stdout.into_owned()
}

/// Runs a command in the root.
pub fn run(command: &mut Command) -> Output {
    command.current_dir(root()).output().unwrap_or_else(|error| panic!("{command:?}: {error}"))
}

/// A compiler with all warnings as errors: C99 for `.c`, C++17 for all else.
pub fn compiler(source: &str) -> Command {
    let (variable, default, standard) =
        if source.ends_with(".c") { ("CC", "cc", "c99") } else { ("CXX", "c++", "c++17") };
    let mut command = Command::new(std::env::var_os(variable).unwrap_or_else(|| default.into()));
    command.arg(format!("-std={standard}")).args(["-g", "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]);
    command.args(["-Iinclude", "-Iffi/cpp"]);
    command
}

/// Compiles a host and returns the program.
pub fn host(source: &str) -> PathBuf {
    host_with(source, &[])
}

/// Compiles a host with more flags and returns the program.
pub fn host_with(source: &str, flags: &[&str]) -> PathBuf {
    let name = Path::new(source).file_stem().expect("a file").to_string_lossy();
    let test = std::env::current_exe().expect("a test that knows where it is");
    let test = test.file_stem().expect("a file").to_string_lossy().into_owned();
    let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{test}{}", flags.concat()));
    let directory = libraries();
    let mut compile = compiler(source);
    compile.args(flags).arg(source).arg("-o").arg(&program).arg("-L").arg(directory);
    compile.args(["-lenmm", "-lm", "-lpthread"]).arg(format!("-Wl,-rpath,{}", directory.display()));
    succeed(&mut compile);
    program
}
