//! Writes the licences of all crates in the libraries, and the list of these crates, for `src/pack.rs`.
#![forbid(unsafe_code)]

mod parts;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use parts::Parts;

/// Files of the repository from which the lists follow.
const SOURCES: [&str; 3] = ["Cargo.lock", "LICENSE-MIT", "LICENSE-APACHE"];

fn main() -> io::Result<()> {
    let mut cargo = io::stdout();
    let root = Path::new(&variable("CARGO_MANIFEST_DIR")).join("../..");
    writeln!(cargo, "cargo::rerun-if-changed=build.rs\ncargo::rerun-if-changed=parts")?;
    let sources = SOURCES.map(|name| root.join(name));
    let has_repository = sources.iter().all(|path| path.is_file());
    let made = if has_repository {
        sources.iter().try_for_each(|path| writeln!(cargo, "cargo::rerun-if-changed={}", path.display()))?;
        parts::of(Some(&root))
    } else {
        writeln!(cargo, "cargo::warning=FMUs of this build do not list crates: it is not made in the repository")?;
        parts::of(None)
    };
    match made {
        Ok(parts) => write(&parts),
        Err(message) => writeln!(cargo, "cargo::error={}", message.replace('\n', " ")),
    }
}

fn variable(name: &str) -> PathBuf {
    env::var_os(name).unwrap_or_default().into()
}

fn write(parts: &Parts) -> io::Result<()> {
    let folder = variable("OUT_DIR");
    fs::write(folder.join(parts::LICENSES), &parts.licenses)?;
    fs::write(folder.join(parts::LIST), &parts.list)
}
