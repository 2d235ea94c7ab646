//! `enmm import`: writes a case for a geometry file, with every layer of a drawing, and says what is left open.

mod draft;
mod layers;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;

use self::draft::Draft;
use crate::new::create_case;
use crate::{BAD_INPUT, OrFail, Outcome, print_line};

/// Arguments of `enmm import`.
#[derive(Args)]
#[command(after_help = "Example: enmm import map.dxf -o slope.toml")]
pub struct Arguments {
    /// Drawing (ASCII DXF), or a file of GeoJSON, JSON, WKT or CSV.
    drawing: PathBuf,
    /// Case file to write, which must not be there yet; default: the name of the drawing with `.toml`, here.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Writes example values for rock, joints and bolts, each marked as such, instead of leaving them open.
    #[arg(long)]
    examples: bool,
}

/// Reads the layers of a drawing, or the laws of another file, and writes a case that maps all of them.
pub fn import(arguments: &Arguments) -> Outcome {
    let Arguments { drawing, output, examples } = arguments;
    let name = Path::new(drawing.file_stem().unwrap_or_default()).with_extension("toml");
    let case = output.clone().unwrap_or(name);
    // Arcs count by their corners here; the case says how close they are drawn.
    let survey = enmm_io::survey_geometry(drawing, f64::INFINITY).or_fail(BAD_INPUT)?;
    let draft = Draft::new(&survey, *examples);
    create_case(&case, &draft.case(&reference(drawing, &case)))?;
    print_line(&draft.report(&case));
    Ok(ExitCode::SUCCESS)
}

/// The drawing as the case names it: relative to its folder where the drawing lies within, else whole.
fn reference(drawing: &Path, case: &Path) -> String {
    let folder = case.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let whole = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let (drawing, folder) = (whole(drawing), whole(folder));
    drawing.strip_prefix(&folder).unwrap_or(&drawing).display().to_string()
}
