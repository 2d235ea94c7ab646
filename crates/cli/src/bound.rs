//! `enmm bound`: limit analysis of a case, a second opinion on its factor of safety.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use enmm_report::PAGE;
use enmm_run::{BoundFailure, Folder, bound_record, write_bound_page};
use enmm_stability::limit_analysis::{Bound, Collapse};

use crate::case::CaseArguments;
use crate::run::directory_for;
use crate::{BAD_INPUT, FAILED, fail, listed, print_line};

/// Arguments of `enmm bound`.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// Directory for report.html; default: NAME/bound, where NAME is that of the case file.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Finds the bounds of a case, prints them and writes their page.
pub fn bound(arguments: &Arguments) -> ExitCode {
    let Arguments { case, output, json } = arguments;
    let json = *json;
    let directory = output.clone().unwrap_or_else(|| directory_for(&case.path, "bound"));
    let loaded = case.load().map_err(BoundFailure::from);
    let found = loaded.and_then(|loaded| {
        let held = Folder::open(&directory, loaded.source.inputs()).map_err(BoundFailure::Directory)?;
        enmm_run::bound(&loaded).map(|bound| (loaded, held, bound))
    });
    match found {
        Ok((loaded, _held, bound)) => {
            print_line(&if json { bound_record(&bound).to_string() } else { text(&bound) });
            if let Err(error) = write_bound_page(&directory, &loaded, &bound) {
                return fail(&format!("cannot write the page ({error}): choose another directory with -o"), FAILED);
            }
            if !json {
                print_line(&format!("{:<21} {}", "page to open", directory.join(PAGE).display()));
            }
        }
        Err(error) => {
            if json {
                print_line(&serde_json::json!({ "error": error.to_string() }).to_string());
            }
            let status =
                if matches!(error, BoundFailure::Case(_) | BoundFailure::Directory(_)) { BAD_INPUT } else { FAILED };
            return fail(&error, status);
        }
    }
    ExitCode::SUCCESS
}

fn text(bound: &Bound) -> String {
    let level = if bound.least == bound.level_tops.factor {
        "upper bound for contacts that let level tops pass".to_owned()
    } else {
        format!(
            "an upper bound of a factor of at least {:.4}: some choices at crossings were not tried",
            bound.least.value()
        )
    };
    let rows = [
        ("associated", &bound.associated, "exact where joints dilate by their friction angle".to_owned()),
        ("level tops pass", &bound.level_tops, level),
        ("every corner catches", &bound.catching, "factor if no crossing lets a block pass".to_owned()),
    ];
    let row = |(name, collapse, meaning): (&str, &Collapse, String)| {
        format!("{name:<21} {:<14} {meaning}", collapse.factor.to_string())
    };
    let mut lines: Vec<String> = rows.into_iter().map(row).collect();
    lines.push(format!("{:<21} {}", "mechanism", mechanism(bound)));
    lines.push(format!(
        "{:<21} {} blocks, {} free; {} interfaces, {} points, {} pairs of facing corners; {} linear programs",
        "model", bound.blocks[0], bound.blocks[1], bound.interfaces, bound.points, bound.corners, bound.programs
    ));
    lines.extend(bound.notes.iter().map(|note| format!("note: {note}")));
    lines.extend(bound.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.join("\n")
}

/// The blocks that move when level tops pass, fastest first.
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
    format!("{} {blocks}, {mass:.4e} kg/m: {names}", moving.len())
}
