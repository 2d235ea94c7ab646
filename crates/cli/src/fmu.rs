//! `enmm fmu`: packs a case as a co-simulation FMU.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use enmm_fmi::pack::{PackError, Packed, pack};
use enmm_fmi::platform::Library;
use enmm_fmi::{library, table};
use enmm_io::files::{read_input, write_atomic};

use crate::case::CaseArguments;
use crate::{BAD_INPUT, FAILED, Failure, OrFail, Outcome, print_line, tell_line};

/// Arguments of `enmm fmu`.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// File to write; default: the name of the case file with `.fmu`, here.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Version of the standard.
    #[arg(long, value_enum, default_value = "3")]
    fmi: Version,
    /// Library of another platform to pack as well, such as win64=enmm.dll; may be repeated. Names are those of
    /// FMI 2 or FMI 3; a library for this platform replaces the one beside the program.
    #[arg(long, value_name = "PLATFORM=PATH")]
    library: Vec<String>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Version {
    #[value(name = "2")]
    Two,
    #[value(name = "3")]
    Three,
}

/// Packs a case and reports what was written. Nothing is written unless all of it is.
pub fn fmu(arguments: &Arguments) -> Outcome {
    let version = match arguments.fmi {
        Version::Two => table::Version::Two,
        Version::Three => table::Version::Three,
    };
    let output = arguments.output.clone().unwrap_or_else(|| default_output(&arguments.case.path));
    let packed = packed(arguments, version, &output)?;
    packed.warnings.iter().for_each(|warning| tell_line(&format!("warning: {warning}")));
    let folder = output.parent().unwrap_or(Path::new(""));
    let made = if folder.as_os_str().is_empty() { Ok(()) } else { std::fs::create_dir_all(folder) };
    made.and_then(|()| write_atomic(&output, &packed.bytes)).map_err(unwritten).or_fail(BAD_INPUT)?;
    let Packed { bytes, variables, blocks, .. } = packed;
    let number = if version == table::Version::Two { "2.0" } else { "3.0" };
    let many = if blocks == 1 { "" } else { "s" };
    let (place, size) = (output.display(), bytes.len() as f64 / 1e6);
    print_line(&format!("{place}: FMI {number}, {size:.1} MB, {variables} variables, {blocks} block{many}"));
    Ok(ExitCode::SUCCESS)
}

fn unwritten(error: std::io::Error) -> String {
    format!("cannot write the FMU ({error}): choose another file with -o")
}

/// The name of the case file with another extension, in the current directory.
fn default_output(case: &Path) -> PathBuf {
    let mut name = case.file_stem().unwrap_or_default().to_owned();
    name.push(".fmu");
    PathBuf::from(name)
}

fn packed(arguments: &Arguments, version: table::Version, output: &Path) -> Result<Packed, Failure> {
    let case = arguments.case.path.as_path();
    let loaded = arguments.case.load().or_fail(BAD_INPUT)?;
    let mut inputs = loaded.source.inputs().to_vec();
    let mut libraries = Vec::new();
    for given in &arguments.library {
        let (path, library) = other(given, version)?;
        inputs.push(path);
        libraries.push(library);
    }
    if libraries.iter().all(|library| library.folder != library::platform(version)) {
        let (path, library) = own(version)?;
        inputs.push(path);
        libraries.push(library);
    }
    enmm_run::check_output(output, &inputs).map_err(unwritten).or_fail(BAD_INPUT)?;
    let name = case.file_name().unwrap_or_default().to_string_lossy();
    pack(&loaded, &name, version, &libraries).map_err(|error| {
        let status = if matches!(error, PackError::Part(..)) { FAILED } else { BAD_INPUT };
        Failure::new(error, status)
    })
}

/// The library beside this program.
fn own(version: table::Version) -> Result<(PathBuf, Library), Failure> {
    let program = std::env::current_exe();
    let program = program.map_err(|error| format!("cannot find this program ({error})")).or_fail(FAILED)?;
    let path = library::find(&program).or_fail(BAD_INPUT)?;
    let unreadable = |error| format!("{}: cannot read the library ({error})", path.display());
    let bytes = read_input(&path).map_err(unreadable).or_fail(BAD_INPUT)?;
    Ok((path, Library::of_this_system(version, bytes)))
}

/// A library that was given as `PLATFORM=PATH`.
fn other(given: &str, version: table::Version) -> Result<(PathBuf, Library), Failure> {
    let wrong = |reason: String| Failure::new(format!("--library {given}: {reason}"), BAD_INPUT);
    let (platform, path) = given
        .split_once('=')
        .ok_or_else(|| wrong("has no `=`: give PLATFORM=PATH, such as win64=enmm.dll".to_owned()))?;
    let path = PathBuf::from(path);
    let bytes = read_input(&path).map_err(|error| wrong(format!("cannot read the library ({error})")))?;
    let library = Library::of(platform, version, bytes).map_err(|error| wrong(error.to_string()))?;
    Ok((path, library))
}
