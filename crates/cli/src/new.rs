//! `enmm new`: writes a commented case to begin with.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};

use crate::{BAD_INPUT, Failure, OrFail, Outcome, print_line};

/// Name of the schema that the cases name, so that editors explain and complete keys.
const SCHEMA: &str = "case.schema.json";

/// Arguments of `enmm new`.
#[derive(Args)]
pub struct Arguments {
    /// Kind of the case.
    kind: Kind,
    /// File to write, which must not be there yet; default: the kind with `.toml`, here.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    /// A bench slope with a fault, two joint sets, water and bolts.
    Slope,
    /// Columns that may overturn.
    Topple,
    /// A pit dug in benches under in-situ stress.
    Pit,
    /// A slope with ports for other models, to be packed as an FMU.
    Coupled,
}

impl Kind {
    /// Name of its case, and the case.
    fn template(self) -> (&'static str, &'static str) {
        match self {
            Self::Slope => ("slope.toml", include_str!("../templates/slope.toml")),
            Self::Topple => ("topple.toml", include_str!("../templates/topple.toml")),
            Self::Pit => ("pit.toml", include_str!("../templates/pit.toml")),
            Self::Coupled => ("coupled.toml", include_str!("../templates/coupled.toml")),
        }
    }
}

/// Writes a case, and the schema beside it if there is none yet.
pub fn new(arguments: &Arguments) -> Outcome {
    let (name, text) = arguments.kind.template();
    let path = arguments.output.clone().unwrap_or_else(|| PathBuf::from(name));
    let text = text.replace(name, &path.file_name().unwrap_or_default().to_string_lossy());
    create_case(&path, &text)?;
    print_line(&format!("{0}: change it, then: enmm check {0}, enmm run {0}", path.display()));
    Ok(ExitCode::SUCCESS)
}

/// Writes a case that is not there yet, and the schema beside it if there is none.
///
/// # Errors
/// The file is there already, or the system refuses it.
pub fn create_case(path: &Path, text: &str) -> Result<(), Failure> {
    let is_there = |error: &std::io::Error| error.kind() == ErrorKind::AlreadyExists;
    create(path, text)
        .map_err(|error| if is_there(&error) { "it is there already".to_owned() } else { error.to_string() })
        .map_err(|reason| format!("cannot write {} ({reason}): choose another file with -o", path.display()))
        .or_fail(BAD_INPUT)?;
    let schema = path.with_file_name(SCHEMA);
    create(&schema, &format!("{:#}\n", enmm_io::schema()))
        .or_else(|error| if is_there(&error) { Ok(()) } else { Err(error) })
        .map_err(|error| format!("cannot write {} ({error}): choose another folder", schema.display()))
        .or_fail(BAD_INPUT)
}

/// Writes a file that is not there yet.
fn create(path: &Path, text: &str) -> std::io::Result<()> {
    let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
    file.write_all(text.as_bytes())
}
