//! Sets the cost of explicit and implicit steps on a continuum side by side and writes the last section of
//! `docs/explicit_vs_implicit.md`; `--quick` takes the small model alone and only prints.
//!
//! Exit status: 2 when a run fails or the document cannot be written.

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use enmm_verification::{Trouble, comparison::ratio};

fn main() -> ExitCode {
    match write(std::env::args().any(|word| word == "--quick")) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Trouble(message)) => {
            let _ = writeln!(std::io::stderr(), "error: {message}");
            ExitCode::from(2)
        }
    }
}

fn write(quick: bool) -> Result<(), Trouble> {
    let text = ratio::markdown(&ratio::ratios(quick)?);
    let _ = write!(std::io::stdout(), "{text}");
    if !quick {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/explicit_vs_implicit.md");
        let document = std::fs::read_to_string(&path)?;
        let others = document.split(ratio::SECTION).next().unwrap_or_default();
        std::fs::write(path, others.to_owned() + &text)?;
    }
    Ok(())
}
