//! `enmm sets`: joint sets from a table of dips and dip directions that were measured in the field.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use enmm_field::{Scanline, Table, plane_of};
use enmm_io::files::{read_input, write_atomic};
use enmm_run::{FoundSets, Projection, SetOptions, check_output, sets as find};
use serde_json::json;

use crate::{BAD_INPUT, FAILED, OrFail, Outcome, print_line, tell_line};

/// Examples, below the options.
const EXAMPLES: &str = "\
Example: enmm sets survey.csv --section 120
         enmm sets survey.csv --traverse 35/5 --sets 3 -o net.svg
         enmm sets survey.csv --traverse BH1=0/90 --traverse BH2=210/60 --assigned survey.sets.csv

The table is a CSV file whose heads name dip and dip direction, or dip and strike (dip to its right), or trend and
plunge of the pole; set, quantity, traverse and distance (m) if there are any.";

/// Arguments of `enmm sets`.
#[derive(Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Table of measurements (CSV), as DIPS and FracMan write it.
    #[arg(value_name = "TABLE")]
    table: PathBuf,
    /// Trend and plunge (degrees) of the line along which the joints were measured, which weights them by Terzaghi;
    /// with NAME= for the rows whose column traverse has that name, as often as needed.
    #[arg(long, value_name = "[NAME=]TREND/PLUNGE", value_parser = Scanline::parse)]
    traverse: Vec<Scanline>,
    /// Number of sets; default: the one with the least integrated completed likelihood criterion.
    #[arg(long, value_name = "N", conflicts_with = "named")]
    sets: Option<usize>,
    /// Take the sets that the column set of the table names.
    #[arg(long)]
    named: bool,
    /// Azimuth of the x axis of the section (degrees), clockwise from north: shows how the sets dip in it.
    #[arg(long, value_name = "DEG", value_parser = azimuth)]
    section: Option<f64>,
    /// SVG file of the net; default: the table with `.sets.svg`.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write the rows with their weights and sets as CSV.
    #[arg(long, value_name = "FILE")]
    assigned: Option<PathBuf>,
    /// Draw by equal angles (Wulff) instead of equal areas (Schmidt).
    #[arg(long)]
    equal_angle: bool,
    /// Print one JSON object instead of lines.
    #[arg(long)]
    json: bool,
}

fn azimuth(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (-360.0..=360.0).contains(&value) => Ok(value),
        _ => Err("write an azimuth of -360 to 360 degrees".to_owned()),
    }
}

/// Finds the sets of a table, draws them and prints the lines of a case.
pub fn sets(arguments: &Arguments) -> Outcome {
    let name = arguments.table.display().to_string();
    let bytes = read_input(&arguments.table).map_err(|error| format!("{name}: {error}")).or_fail(BAD_INPUT)?;
    let text = String::from_utf8(bytes);
    let text = text.map_err(|_| format!("{name}: is no text in UTF-8; save it as CSV in UTF-8")).or_fail(BAD_INPUT)?;
    let table = Table::parse(&name, &text).or_fail(BAD_INPUT)?;
    let projection = if arguments.equal_angle { Projection::EqualAngle } else { Projection::EqualArea };
    let options = SetOptions {
        lines: arguments.traverse.clone(),
        number: arguments.sets,
        named: arguments.named,
        section: arguments.section,
        projection,
    };
    let found = find(&table, &options).map_err(|error| error.to_string()).or_fail(BAD_INPUT)?;
    let picture = arguments.output.clone().unwrap_or_else(|| arguments.table.with_extension("sets.svg"));
    let places = std::iter::once(&picture).chain(&arguments.assigned);
    let unwritten = |error| format!("cannot write the results ({error}): choose other files with -o and --assigned");
    let inputs = std::slice::from_ref(&arguments.table);
    places.clone().try_for_each(|path| check_output(path, inputs)).map_err(unwritten).or_fail(BAD_INPUT)?;
    let net = found.net(name, projection).picture().svg();
    write_atomic(&picture, net.as_bytes()).map_err(unwritten).or_fail(FAILED)?;
    if let Some(path) = &arguments.assigned {
        write_atomic(path, rows(&table, &found).as_bytes()).map_err(unwritten).or_fail(FAILED)?;
    }
    if arguments.json {
        print_line(&record(&found).to_string());
        return Ok(ExitCode::SUCCESS);
    }
    found.notes.iter().for_each(|note| tell_line(&format!("note: {note}")));
    print_line(&lines(&found, &table).join("\n"));
    places.for_each(|path| print_line(&format!("{:<21} {}", "written", path.display())));
    print_line(&format!("\n{}", found.case_lines().join("\n").trim_end()));
    Ok(ExitCode::SUCCESS)
}

/// The sets, as lines of a name and a text.
fn lines(found: &FoundSets, table: &Table) -> Vec<String> {
    let mut lines = vec![format!("{:<21} {}", "planes", table.rows.len())];
    let tried = found.criteria.iter().enumerate();
    let tried: Vec<String> = tried.filter_map(|(k, value)| Some(format!("{} {:.1}", k + 1, (*value)?))).collect();
    if !tried.is_empty() {
        lines.push(format!("{:<21} {}", "criterion by sets", tried.join(", ")));
    }
    for set in &found.sets {
        let [dip, direction] = plane_of(&set.mean.mean);
        let mean = &set.mean;
        let trace = found.trace(set);
        let trace = if trace.is_empty() { trace } else { format!("; {trace}") };
        lines.push(format!(
            "{:<21} {dip:.1}°/{direction:05.1}° ± {:.1}° (95 %), κ {:.1}, half of its poles within {:.1}°, {} \
             planes{trace}",
            set.name,
            mean.cone_deg,
            mean.kappa,
            mean.cone_of(0.5),
            mean.count
        ));
    }
    lines
}

fn record(found: &FoundSets) -> serde_json::Value {
    let set = |set: &enmm_run::FoundSet| {
        let [dip, direction] = plane_of(&set.mean.mean);
        json!({
            "name": set.name, "dip_deg": dip, "dip_direction_deg": direction, "fisher_k": set.mean.kappa,
            "cone_deg": set.mean.cone_deg, "count": set.mean.count, "weight": set.mean.weight, "spacing": set.spacing,
        })
    };
    json!({
        "sets": found.sets.iter().map(set).collect::<Vec<_>>(),
        "criteria": found.criteria,
        "notes": found.notes,
    })
}

/// Rows of the table with their weights and sets.
fn rows(table: &Table, found: &FoundSets) -> String {
    let mut text = "line,dip [deg],dip direction [deg],weight,set\n".to_owned();
    for (k, (row, (_, weight))) in table.rows.iter().zip(&found.poles).enumerate() {
        let [dip, direction] = row.plane();
        let set = found.sets.iter().find(|set| set.members.contains(&k)).map_or("", |set| &set.name);
        let set = if set.contains([',', '"']) { format!("\"{}\"", set.replace('"', "\"\"")) } else { set.to_owned() };
        text.push_str(&format!("{},{dip:.4},{direction:.4},{weight:?},{set}\n", row.line));
    }
    text
}
