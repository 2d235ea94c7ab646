//! Sets the explicit and the implicit method side by side and writes the document and its plots into a directory
//! (default: `docs/`); `--quick` takes small models.
//!
//! Exit status: 2 when a run fails or the document cannot be written.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use enmm_verification::comparison::{self, ratio};
use enmm_verification::{Trouble, plot};

/// Name of the document, and of the plots in the folder of the same name.
const NAME: &str = "explicit_vs_implicit";

fn main() -> ExitCode {
    let (mut directory, mut quick) = (Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs"), false);
    for word in std::env::args_os().skip(1) {
        if word == "--quick" {
            quick = true;
        } else {
            directory = PathBuf::from(word);
        }
    }
    match write(&directory, quick) {
        Ok(path) => {
            say(&format!("wrote {}", path.display()));
            ExitCode::SUCCESS
        }
        Err(Trouble(message)) => {
            say(&format!("error: {message}"));
            ExitCode::from(2)
        }
    }
}

/// Runs the comparison; returns the path of the document, the last section of which is that of `ratio`.
fn write(directory: &Path, quick: bool) -> Result<PathBuf, Trouble> {
    let found = comparison::compare(quick)?;
    let folder = directory.join(NAME);
    std::fs::create_dir_all(&folder)?;
    let mut pictures = Vec::new();
    for (k, drawn) in found.plots.iter().enumerate() {
        let name = plot::file_name("plot", k);
        std::fs::write(folder.join(&name), plot::picture(drawn).svg())?;
        pictures.push(format!("{NAME}/{name}"));
    }
    let path = directory.join(format!("{NAME}.md"));
    let before = std::fs::read_to_string(&path).unwrap_or_default();
    let last = before.split_once(ratio::SECTION).map_or(String::new(), |(_, text)| ratio::SECTION.to_owned() + text);
    std::fs::write(&path, found.markdown(&pictures) + &last)?;
    Ok(path)
}

/// A line for the person who waits; a reader that has gone away ends it quietly.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
