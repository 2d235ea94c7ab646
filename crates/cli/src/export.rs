//! `enmm export`: results for other programs, as a spreadsheet, a drawing or features of a map.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use enmm_export::{Instant, Scene, drawing, features, tables, workbook};
use enmm_io::files::write_atomic;
use enmm_run::check_output;

use crate::{BAD_INPUT, FAILED, Failure, OrFail, Outcome, print_line, tell_line};

/// Examples, below the options.
const EXAMPLES: &str = "\
Example: enmm export slope --xlsx slope.xlsx
         enmm export slope --dxf slope.dxf --geojson slope.geojson
         enmm export slope --dxf slope.dxf --time 2.5";

/// Arguments of `enmm export`.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Directory of the results of enmm run, fos, bound, sample or sweep.
    #[arg(value_name = "RESULTS")]
    directory: PathBuf,
    /// Write a spreadsheet of all tables, a sheet each, also of those in the directories fos, bound, sample and sweep.
    #[arg(long, value_name = "FILE", required_unless_present_any = ["dxf", "geojson"])]
    xlsx: Option<PathBuf>,
    /// Write a drawing of the deformed slope: blocks by rock, joints by law, bolts, supports, water, displacements.
    #[arg(long, value_name = "FILE")]
    dxf: Option<PathBuf>,
    /// Write blocks and joints with their numbers, bolts, supports and water as GeoJSON.
    #[arg(long, value_name = "FILE")]
    geojson: Option<PathBuf>,
    /// Number of the frame in frames/ that is drawn; default: the last.
    #[arg(long, value_name = "N", conflicts_with = "time")]
    frame: Option<usize>,
    /// Time (s) next to which the frame is that is drawn.
    #[arg(long, value_name = "T")]
    time: Option<f64>,
}

/// Writes the exports that the arguments ask for.
pub fn export(arguments: &Arguments) -> Outcome {
    let Arguments { directory, xlsx, dxf, geojson, frame, time } = arguments;
    for (path, ending) in [(xlsx, "xlsx"), (dxf, "dxf"), (geojson, "geojson")] {
        path.as_deref().map_or(Ok(()), |path| check_place(path, ending))?;
    }
    if dxf.is_none() && geojson.is_none() && (frame.is_some() || time.is_some()) {
        let message = "--frame and --time choose what --dxf and --geojson draw; add one of these";
        return Err(Failure::new(message, BAD_INPUT));
    }
    if let Some(path) = xlsx {
        write_tables(directory, path)?;
    }
    if dxf.is_none() && geojson.is_none() {
        return Ok(ExitCode::SUCCESS);
    }
    let instant = match (frame, time) {
        (Some(number), _) => Instant::Frame(*number),
        (None, Some(time)) => Instant::Time(*time),
        (None, None) => Instant::End,
    };
    let scene = Scene::read(directory, instant).or_fail(BAD_INPUT)?;
    scene.notes.iter().for_each(|note| tell_line(&format!("note: {note}")));
    let (axis, unit, at) = &scene.axis;
    print_line(format!("{axis:<21} {at} {unit}").trim_end());
    if let Some(path) = dxf {
        write("drawing", path, drawing(&scene).as_bytes())?;
    }
    if let Some(path) = geojson {
        write("features", path, features(&scene).as_bytes())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes the spreadsheet of a folder of results.
///
/// # Errors
/// The folder has no tables, or the file cannot be written.
pub fn write_tables(directory: &Path, path: &Path) -> Result<(), Failure> {
    let tables = tables(directory).or_fail(BAD_INPUT)?;
    let bytes = workbook(&tables).or_fail(BAD_INPUT)?;
    write("spreadsheet", path, &bytes)
}

/// Looks at the place of an export, whose ending keeps it apart from all results.
fn check_place(path: &Path, ending: &str) -> Result<(), Failure> {
    let has_ending = path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
    if !has_ending {
        let message = format!("{}: must end with .{ending}; name another file by --{ending}", path.display());
        return Err(Failure::new(message, BAD_INPUT));
    }
    let unwritten = |error| format!("cannot write the export ({error}): name another file by --{ending}");
    check_output(path, &[]).map_err(unwritten).or_fail(BAD_INPUT)
}

fn write(what: &str, path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let unwritten = |error| format!("cannot write the {what} ({error}): name another file");
    write_atomic(path, bytes).map_err(unwritten).or_fail(FAILED)?;
    print_line(&format!("{what:<21} {}", path.display()));
    Ok(())
}
