//! `enmm bound`: limit analysis of a case, a second opinion on its factor of safety.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use enmm_io::LoadedCase;
use enmm_report::PAGE;
use enmm_run::{BoundFailure, Folder, bound_record, bracket_record, write_bound, write_bound_page, write_bracket_page};
use enmm_stability::limit_analysis::continuum::{Bracket, TRIANGLES};
use enmm_stability::limit_analysis::{Bound, DUCTILE, Factor, Row, Way};
use enmm_stability::up_to_stage;
use serde_json::Value;

use crate::case::CaseArguments;
use crate::run::{check_folder, directory_for, results_folder};
use crate::{BAD_INPUT, FAILED, Failure, OrFail, Outcome, fail, listed, print_line, told};

/// Arguments of `enmm bound`.
#[derive(Args)]
#[command(after_help = "Example: enmm bound slope.toml --json")]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// Directory for bound.json and report.html; default: NAME/bound, where NAME is that of the case file.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Look at the slope after this static stage; default: after the last.
    #[arg(long, value_name = "NAME")]
    stage: Option<String>,
    /// Replace results of another case in the directory.
    #[arg(long)]
    force: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Most triangles of a mesh, where rock yields.
    #[arg(long, value_name = "N", default_value_t = TRIANGLES, value_parser = triangles)]
    triangles: usize,
}

fn triangles(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if count >= LEAST => Ok(count),
        _ => Err(format!("give a whole number of at least {LEAST}")),
    }
}

/// Fewest triangles that one can ask for.
const LEAST: usize = 30;

/// Limit analysis of rigid blocks, or of rock that yields.
enum Found {
    Blocks(Box<Bound>),
    Rock(Bracket),
}

impl Found {
    fn of(loaded: &LoadedCase, triangles: usize) -> Result<Self, BoundFailure> {
        match loaded.case.yields() {
            true => enmm_run::bracket(loaded, triangles).map(Self::Rock),
            false => enmm_run::bound(loaded).map(|bound| Self::Blocks(Box::new(bound))),
        }
    }

    fn record(&self) -> Value {
        match self {
            Self::Blocks(bound) => bound_record(bound),
            Self::Rock(bracket) => bracket_record(bracket),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Blocks(bound) => text(bound),
            Self::Rock(bracket) => bracket_text(bracket),
        }
    }

    fn write_page(&self, directory: &Path, loaded: &LoadedCase) -> std::io::Result<()> {
        match self {
            Self::Blocks(bound) => write_bound_page(directory, loaded, bound),
            Self::Rock(bracket) => write_bracket_page(directory, loaded, bracket),
        }
    }
}

/// Finds the bounds of a case, prints them and writes their page.
pub fn bound(arguments: &Arguments) -> Outcome {
    find(arguments).map_err(|failure| failure.json(arguments.json))
}

fn find(arguments: &Arguments) -> Outcome {
    let json = arguments.json;
    let default = directory_for(&arguments.case.path, "bound");
    let directory = results_folder(arguments.output.as_ref(), default, arguments.force)?;
    let mut loaded = arguments.case.load().or_fail(BAD_INPUT)?;
    let (_held, found) = look(arguments, &mut loaded, &directory).map_err(|error| match error {
        BoundFailure::Case(_) => Failure::new(error, BAD_INPUT).on(&loaded),
        BoundFailure::Unsolved(_) => Failure::new(error, FAILED).on(&loaded),
        _ => Failure::new(error, BAD_INPUT),
    })?;
    print_line(&if json { found.record().to_string() } else { found.text() });
    let written = write_bound(&directory, &loaded, arguments.stage.as_deref(), &found.record());
    if let Err(error) = written.and_then(|()| found.write_page(&directory, &loaded)) {
        return Ok(fail(&format!("cannot write results ({error}): choose another directory with -o"), FAILED));
    }
    if !json {
        print_line(&format!("{:<21} {}", "page to open", directory.join(PAGE).display()));
    }
    Ok(ExitCode::SUCCESS)
}

/// Cuts the case after the stage that is looked at; the folder for its results, and its bounds.
fn look(arguments: &Arguments, loaded: &mut LoadedCase, directory: &Path) -> Result<(Folder, Found), BoundFailure> {
    loaded.case = up_to_stage(&loaded.case, arguments.stage.as_deref()).map_err(BoundFailure::Options)?;
    check_folder(directory, loaded, arguments.force).map_err(BoundFailure::Owned)?;
    let held = Folder::open(directory, loaded.source.inputs()).map_err(BoundFailure::Directory)?;
    let found = Found::of(loaded, arguments.triangles)?;
    Ok((held, found))
}

fn bracket_text(bracket: &Bracket) -> String {
    let row = |name: &str, factor: Factor, meaning: &str| format!("{name:<21} {:<14} {meaning}", factor.to_string());
    let [area, mass] = bracket.moving().fold([0.0; 2], |[area, mass], m| [area + m.area, mass + m.mass]);
    let mut lines = vec![
        row("lower bound", bracket.lower, "stresses in equilibrium, nowhere beyond the strength: nothing collapses"),
        row("upper bound", bracket.upper, "a mechanism of rock that dilates by its friction angle"),
        format!("{:<21} {area:.2} m², {mass:.4e} kg/m with more than a tenth of the greatest speed", "mechanism"),
        format!(
            "{:<21} {} and {} triangles; {} conic programs",
            "model", bracket.triangles[0], bracket.triangles[1], bracket.programs
        ),
    ];
    lines.extend(told::lines(&bracket.warnings, bracket.notes.len()));
    lines.join("\n")
}

fn text(bound: &Bound) -> String {
    let row = |row: Row| format!("{:<21} {:<14} {}", row.name, row.collapse.factor.to_string(), row.meaning);
    let mut lines: Vec<String> = bound.rows().into_iter().map(row).collect();
    lines.push(format!("{:<21} {}", "mechanism", mechanism(bound)));
    lines.push(format!(
        "{:<21} {} blocks, {} free; {} interfaces, {} points, {} pairs of facing corners; {} linear programs",
        "model", bound.blocks[0], bound.blocks[1], bound.interfaces, bound.points, bound.corners, bound.programs
    ));
    if let Some(pressed) = bound.joint_water {
        lines.push(format!("{:<21} presses with {pressed:.4e} N/m", "water in joints"));
    }
    let (own, of_build): (Vec<&String>, Vec<&String>) = bound.notes.iter().partition(|note| *note == DUCTILE);
    lines.extend(told::lines(&bound.warnings, of_build.len()));
    lines.extend(own.into_iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}

/// The way in which the slope fails when level tops pass, and the blocks that move, fastest first.
fn mechanism(bound: &Bound) -> String {
    let moving = &bound.level_tops.mechanism;
    if moving.is_empty() {
        return "none".to_owned();
    }
    let names = listed(moving.iter().map(|b| {
        format!(
            "{} at ({:.2}, {:.2}) m by ({:.2}, {:.2})",
            b.block, b.position.x, b.position.y, b.velocity.x, b.velocity.y
        )
    }));
    let mass: f64 = moving.iter().map(|b| b.mass).sum();
    let blocks = if moving.len() == 1 { "block" } else { "blocks" };
    let way = bound.level_tops.way.map(Way::words).unwrap_or_default();
    format!("{way}\n{:<21} {} {blocks}, {mass:.4e} kg/m: {names}", "", moving.len())
}
