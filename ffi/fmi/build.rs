//! Writes the licences of all crates in the libraries, and the list of these crates, for `src/pack.rs`.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use enmm_parts::Parts;

/// Files of the repository from which the lists follow.
const SOURCES: [&str; 3] = ["Cargo.lock", "LICENSE-MIT", "LICENSE-APACHE"];

fn main() -> io::Result<()> {
    let mut cargo = io::stdout();
    let root = Path::new(&variable("CARGO_MANIFEST_DIR")).join("../..");
    writeln!(cargo, "cargo::rerun-if-changed=build.rs")?;
    let sources = SOURCES.map(|name| root.join(name));
    let has_repository = sources.iter().all(|path| path.is_file());
    let parts = if has_repository {
        sources.iter().try_for_each(|path| writeln!(cargo, "cargo::rerun-if-changed={}", path.display()))?;
        enmm_parts::of_repository(&root)
    } else {
        writeln!(cargo, "cargo::warning=FMUs of this build do not list crates: it is not made in the repository")?;
        enmm_parts::unlisted()
    };
    match parts {
        Ok(parts) => write(&parts),
        Err(message) => writeln!(cargo, "cargo::error={}", message.replace('\n', " ")),
    }
}

fn variable(name: &str) -> PathBuf {
    env::var_os(name).unwrap_or_default().into()
}

fn write(parts: &Parts) -> io::Result<()> {
    let folder = variable("OUT_DIR");
    fs::write(folder.join(enmm_parts::LICENSES), &parts.licenses)?;
    fs::write(folder.join(enmm_parts::LIST), &parts.list)
}
