//! `enmm check`: builds a model and reports on it.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use enmm::model::case::keys::rounded;
use enmm::model::{FlowSurvey, Simulation};
use enmm_io::LoadedCase;
use enmm_io::numbers::three_digits;
use enmm_run::check::{BridgeRecord, Check};
use enmm_run::drainage::{LawDrainage, SetConductivity};
use enmm_run::rock_mass::RockMass;
use enmm_run::{Folder, Observer};

use crate::case::CaseArguments;
use crate::progress::Screen;
use crate::run::check_folder;
use crate::{BAD_INPUT, FAILED, Failure, OrFail, Outcome, print_line};

/// Arguments of `enmm check`.
#[derive(Args)]
#[command(after_help = "Example: enmm check slope.toml -o slope")]
pub struct Arguments {
    #[command(flatten)]
    case: CaseArguments,
    /// Directory to draw the model into, as model.png.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Draw into a directory with results of another case.
    #[arg(long)]
    force: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Builds the model of a case, prints what it is, and draws it into a directory if there is one.
pub fn check(arguments: &Arguments) -> Outcome {
    show(arguments).map_err(|failure| failure.json(arguments.json))
}

fn show(arguments: &Arguments) -> Outcome {
    let directory = arguments.output.as_deref();
    let loaded = arguments.case.load().or_fail(BAD_INPUT)?;
    let mut screen = Screen::new(arguments.json);
    let looked = look(arguments, &loaded, &mut screen);
    drop(screen);
    let (simulation, _held, found) = looked.map_err(|message| Failure::new(message, BAD_INPUT).on(&loaded))?;
    if let Some(directory) = directory {
        enmm_run::draw_checked(&simulation, directory).map_err(undrawn).or_fail(FAILED)?;
    }
    if arguments.json {
        print_line(&serde_json::to_string(&found).unwrap_or_else(|error| format!("{{\"error\": \"{error}\"}}")));
    } else {
        let picture = |directory: &Path| format!("\n{:<21} {}", "picture", directory.join("model.png").display());
        print_line(&(table(&found) + &directory.map_or(String::new(), picture)));
    }
    Ok(ExitCode::SUCCESS)
}

fn undrawn(error: std::io::Error) -> String {
    format!("cannot draw the model ({error}): choose another directory with -o")
}

/// The model of a case, the folder for its picture, and the report.
fn look(
    arguments: &Arguments,
    loaded: &LoadedCase,
    screen: &mut Screen,
) -> Result<(Simulation, Option<Folder>, Check), String> {
    let directory = arguments.output.as_deref();
    if let Some(directory) = directory {
        check_folder(directory, loaded, arguments.force).map_err(|error| error.to_string())?;
    }
    let held = directory.map(|directory| Folder::open(directory, loaded.source.inputs()));
    let held = held.transpose().map_err(undrawn)?;
    let invalid =
        |invalid: enmm::model::case::Invalid| loaded.source.locate(&invalid.key, &invalid.message).to_string();
    let build = enmm_implicit::build(loaded.case.clone(), &mut |stage| screen.build(stage));
    let mut simulation = build.map_err(invalid)?;
    simulation.validate_stages().map_err(invalid)?;
    let found = enmm_run::check(&simulation, &loaded.warnings);
    Ok((simulation, held, found))
}

/// Memory while the model runs, and what of it is the model, its state (held twice) and the buffers of a step.
fn memory(found: &Check) -> String {
    let megabytes = |bytes: f64| format!("{:.1}", bytes / 1e6);
    let of = |heap: &str| found.memory.iter().filter(|part| part.heap == heap).map(|part| part.bytes as f64).sum();
    let [model, state, buffers] = ["model", "state", "buffers"].map(of).map(megabytes);
    let all = megabytes(found.memory_bytes as f64);
    format!("{all}: model {model}, state 2 × {state}, buffers {buffers}")
}

/// Within which distances ends of joints are joined to a line, and listed.
fn ends(found: &Check) -> String {
    let distance = |value: f64| three_digits(value).unwrap_or_else(|small| format!("{small:.2e}"));
    format!("joined to a line within {} m, listed within {} m", distance(found.extend_ends), distance(found.near_ends))
}

/// A rock mass by Hoek–Brown, and its equivalent strength.
fn rock_mass(mass: &RockMass) -> String {
    let RockMass { rock, mb, s, a, height, .. } = mass;
    let [compression, tension, minor, cohesion] =
        [mass.compression, mass.tension, mass.minor_max, mass.cohesion].map(|stress| 1e-3 * stress);
    format!(
        "rock.{rock}: Hoek–Brown mb {mb:.4}, s {s:.4e}, a {a:.4}; uniaxial strength {compression:.4} kPa, tensile \
         strength {tension:.4} kPa; equivalent c {cohesion:.4} kPa, φ {:.3}° for σ₃ up to {minor:.4} kPa (slope of \
         {height:.6} m)",
        mass.friction_deg
    )
}

/// Rock bridges that fit on a screen.
const BRIDGES: usize = 20;

/// Rock bridges, a line each.
fn bridges(found: &[BridgeRecord]) -> Vec<String> {
    let tell = |bridge: &BridgeRecord| {
        let BridgeRecord { place: [x, y], length, characteristic_length, bending, breaks, because, .. } = bridge;
        let rock = if *characteristic_length > 0.0 {
            format!("characteristic length {characteristic_length:.4} m, bending strength {bending:.3} σt")
        } else {
            "brittle, bending strength σt".to_owned()
        };
        let because = because.map_or_else(String::new, |because| format!(": {because}"));
        format!("rock bridge of {length:.4} m at ({x:.4}, {y:.4}) m: {rock}; breaks {breaks}{because}")
    };
    let more = found.len().saturating_sub(BRIDGES);
    let more = (more > 0).then(|| format!("and {more} rock bridges more: --json has all"));
    found.iter().take(BRIDGES).map(tell).chain(more).collect()
}

/// The net of joints in which water flows.
fn flow(survey: &FlowSurvey) -> String {
    let FlowSurvey { nodes, pieces, heads, outcrops, dead_ends, length, isolated, transmissivity: [least, most] } =
        *survey;
    format!(
        "flow in {pieces} pieces of joint, {length:.3} m, between {nodes} nodes: {heads} with a head, {outcrops} open \
         to the air, {dead_ends} dead ends; {isolated:.3} m isolated and dry; transmissivity {least:.3e} to {most:.3e} \
         m²/s"
    )
}

/// Conductivity of the rock mass along the joints of a set.
fn conductivity(SetConductivity { set, aperture, spacing, conductivity }: &SetConductivity) -> String {
    format!(
        "{set}: conductivity {conductivity:.3e} m/s along its joints, of {} mm every {} m",
        rounded(1e3 * aperture),
        rounded(*spacing)
    )
}

/// Time in which the joints of a law drain, and what it says of steady flow.
fn drainage(LawDrainage { law, aperture, height, time }: &LawDrainage) -> String {
    let unit = [("days", 86400.0), ("h", 3600.0), ("min", 60.0)].into_iter().find(|(_, size)| time >= size);
    let (unit, size) = unit.unwrap_or(("s", 1.0));
    format!(
        "joint_law.{law}: a joint of {} mm drains over {} m in {:.3} {unit}; steady flow is enough where \
         levels, heads and rain change more slowly",
        rounded(1e3 * aperture),
        rounded(*height),
        time / size
    )
}

fn table(found: &Check) -> String {
    let range = |values: &[f64]| match values {
        [first, .., last] => format!("{first:.6} to {last:.6}"),
        [only] => format!("{only:.6}"),
        [] => "none".to_owned(),
    };
    let stars: Vec<String> =
        found.stars_by_cover_count.iter().map(|(covers, stars)| format!("{stars} with {covers}")).collect();
    let rows = [
        ("blocks", found.blocks.to_string()),
        ("block areas (m²)", range(&found.block_areas)),
        ("total area (m²)", format!("{:.6}", found.total_area)),
        ("elements", found.elements.to_string()),
        ("physical covers", found.physical_covers.to_string()),
        ("stars by covers", stars.join(", ")),
        ("cover masses (kg/m)", range(&found.cover_masses)),
        ("vertices", found.vertices.to_string()),
        ("boundary edges", found.boundary_edges.to_string()),
        ("initial contacts", found.initial_contacts.to_string()),
        ("critical dt (s)", format!("{:.4e}", found.critical_dt)),
        ("friction delay (ms)", format!("{:.2} in dynamic stages", 1e3 * found.friction_delay)),
        (
            "joint stiffness (Pa/m)",
            found.default_stiffness.map_or("given".to_owned(), |k| format!("{k:.3e} by default")),
        ),
        ("small covers treated", found.small_covers_treated.to_string()),
        ("tiny blocks", found.tiny_blocks.to_string()),
        ("merged vertices", found.merged_vertices.to_string()),
        ("ignored joints", found.ignored_joints.to_string()),
        ("ends of joints", ends(found)),
        ("memory (MB)", memory(found)),
    ];
    let drawing = found.drawing.iter().map(|drawing| ("drawing", drawing.clone()));
    let rows = drawing.chain(rows).map(|(name, value)| format!("{name:<22} {value}"));
    let mut lines: Vec<String> = rows.collect();
    lines.extend(found.rock_masses.iter().map(rock_mass));
    lines.extend(found.records.iter().map(|motion| format!("record {}", motion.text())));
    lines.extend(bridges(&found.bridges));
    lines.extend(found.flow.iter().map(flow));
    lines.extend(found.conductivities.iter().map(conductivity));
    lines.extend(found.drain_times.iter().map(drainage));
    lines.extend(found.warnings.iter().map(|warning| format!("warning: {warning}")));
    lines.extend(found.notes.iter().map(|note| format!("note: {note}")));
    lines.join("\n")
}
