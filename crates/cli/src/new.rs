//! `enmm new`: writes a commented case to begin with.

use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};

use crate::{BAD_INPUT, fail, print_line};

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
    fn name(self) -> &'static str {
        match self {
            Self::Slope => "slope",
            Self::Topple => "topple",
            Self::Pit => "pit",
            Self::Coupled => "coupled",
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Slope => include_str!("../templates/slope.toml"),
            Self::Topple => include_str!("../templates/topple.toml"),
            Self::Pit => include_str!("../templates/pit.toml"),
            Self::Coupled => include_str!("../templates/coupled.toml"),
        }
    }
}

/// Writes a case, and the schema beside it if there is none yet.
pub fn new(arguments: &Arguments) -> ExitCode {
    let path = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.toml", arguments.kind.name())));
    let written = path.file_name().unwrap_or_default().to_string_lossy();
    let text = arguments.kind.text().replace(&format!("{}.toml", arguments.kind.name()), &written);
    if let Err(error) = create(&path, &text) {
        let reason =
            if error.kind() == ErrorKind::AlreadyExists { "it is there already".into() } else { error.to_string() };
        return fail(&format!("cannot write {} ({reason}): choose another file with -o", path.display()), BAD_INPUT);
    }
    if let Err(message) = schema_beside(&path) {
        return fail(&message, BAD_INPUT);
    }
    print_line(&format!("{0}: change it, then: enmm check {0}, enmm run {0}", path.display()));
    ExitCode::SUCCESS
}

/// Writes the schema beside a case if there is none yet.
///
/// # Errors
/// The system refuses it.
pub fn schema_beside(case: &Path) -> Result<(), String> {
    let schema = case.with_file_name(SCHEMA);
    match create(&schema, &format!("{:#}\n", enmm_io::schema())) {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => {
            Err(format!("cannot write {} ({error}): choose another folder", schema.display()))
        }
        _ => Ok(()),
    }
}

/// Writes a file that is not there yet.
///
/// # Errors
/// The file is there already, or the system refuses it.
pub fn create(path: &Path, text: &str) -> std::io::Result<()> {
    let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
    file.write_all(text.as_bytes())
}
