//! Builds for an older C library of Linux by zig, which knows the functions of each version; it comes from PyPI.

use std::env;
use std::path::PathBuf;
use std::process::Command;

use crate::repository::{self, Repository};
use crate::venv::{self, Packages};

/// The subcommand of cargo, and zig.
const TOOLS: [&str; 2] = ["cargo-zigbuild==0.24.1", "ziglang==0.17.1"];

/// The command `build` or `rustc` of cargo for a target with this version of the C library.
pub fn cargo(repository: &Repository, command: &str, triple: &str, glibc: &str) -> Result<Command, String> {
    let tools = tools(repository)?;
    let mut cargo = repository.to_ship(tools.join("bin").join("cargo-zigbuild"), &[command]);
    cargo.args(["--target", &format!("{triple}.{glibc}")]);
    let before = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths([tools.join("bin")].into_iter().chain(env::split_paths(&before)));
    cargo.env("PATH", path.map_err(|error| format!("PATH: {error}"))?);
    cargo.env("CARGO_ZIGBUILD_ZIG_PATH", tools.join("ziglang").join("zig"));
    Ok(cargo)
}

/// The folder of the tools in the target folder, where pip installs them when they are missing.
fn tools(repository: &Repository) -> Result<PathBuf, String> {
    let place = repository.target.join("zig-tools");
    if !place.join("bin").join("cargo-zigbuild").is_file() {
        let mut pip = venv::command(repository, Packages::Usual)?;
        pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--target"]).arg(&place);
        repository::run(pip.args(TOOLS))?;
    }
    Ok(place)
}
