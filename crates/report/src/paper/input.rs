//! Input: section, rock, joints, water, loads, bolts, stages.

use serde_json::Value;

use super::number::{Digits, Number, length, plain, prefixed, steel_area};
use super::parts::{chapter, entries, figure, part, text};
use super::records::Records;
use super::table::{Cell, facts, table};

use Digits::Typed;

/// The chapters of input; empty where no record has it.
pub fn input_chapter(records: &Records) -> String {
    let Some(record) = records.with_input() else { return String::new() };
    let input = &record.json["input"];
    let model = records.run.as_ref().map_or(String::new(), |run| {
        figure(run, "model", "Section with rock, joints, supports, loads, water and bolts; the bar gives the scale.")
    });
    let section = facts(&[
        ("Azimuth of the x axis", plain(&input["section"]["azimuth_deg"], "°", Typed).into()),
        ("Gravity, vertical", plain(&input["gravity"]["y"], "m/s²", Typed).into()),
        ("Gravity, horizontal", nonzero(&input["gravity"]["x"], |value| plain(value, "m/s²", Typed))),
    ]);
    let section = format!(
        "{model}{section}<p>Lengths in metres, y upwards; tension is positive; forces are per metre of \
                           slope unless a bar is named.</p>\n"
    );
    chapter("Section", &section)
        + &chapter("Rock and joints", &[rocks(input), laws(input), sets(input), joints(input)].concat())
        + &chapter(
            "Stress, water and loads",
            &[in_situ(input), water(input), drawdowns(input), loads(input), motions(input)].concat(),
        )
        + &chapter("Bolts as designed", &bolts(input))
        + &chapter("Stages as planned", &stages(input))
}

/// A number that is not 0.
fn nonzero(value: &Value, number: impl Fn(&Value) -> Option<Number>) -> Cell {
    if value.as_f64().is_some_and(|value| value != 0.0) { number(value).into() } else { Cell::Empty }
}

fn stress(value: &Value) -> Option<Number> {
    prefixed(value, "Pa", Typed)
}

/// The entries of a map by name.
fn named(value: &Value) -> impl Iterator<Item = (&String, &Value)> {
    value.as_object().into_iter().flatten()
}

fn rocks(input: &Value) -> String {
    let row = |(name, rock): (&String, &Value)| -> Vec<Cell> {
        vec![
            name.as_str().into(),
            plain(&rock["density"], "kg/m³", Typed).into(),
            stress(&rock["young"]).into(),
            plain(&rock["poisson"], "", Typed).into(),
            plain(&rock["friction_deg"], "°", Typed).into(),
            stress(&rock["cohesion"]).into(),
            stress(&rock["tension"]).into(),
            plain(&rock["dilation_deg"], "°", Typed).into(),
            stress(&rock["hoek_brown"]["sigma_ci"]).into(),
            plain(&rock["hoek_brown"]["mi"], "", Typed).into(),
            plain(&rock["hoek_brown"]["gsi"], "", Typed).into(),
            plain(&rock["hoek_brown"]["d"], "", Typed).into(),
        ]
    };
    let rows: Vec<Vec<Cell>> = named(&input["rocks"]).map(row).collect();
    let head = [
        "Rock",
        "Density",
        "Young's modulus",
        "Poisson's ratio",
        "Friction",
        "Cohesion",
        "Tension",
        "Dilation",
        "Hoek–Brown σci",
        "mi",
        "GSI",
        "D",
    ];
    part("Rock", &table(&head, &rows))
}

fn laws(input: &Value) -> String {
    let row = |(name, law): (&String, &Value)| -> Vec<Cell> {
        let kind = if text(&law["kind"]) == "barton_bandis" { "Barton–Bandis" } else { "Mohr–Coulomb" };
        vec![
            name.as_str().into(),
            kind.into(),
            plain(&law["friction_deg"], "°", Typed).into(),
            stress(&law["cohesion"]).into(),
            stress(&law["tension"]).into(),
            plain(&law["residual_friction_deg"], "°", Typed).into(),
            stress(&law["residual_cohesion"]).into(),
            nonzero(&law["dilation_deg"], |value| plain(value, "°", Typed)),
            plain(&law["jrc"], "", Typed).into(),
            stress(&law["jcs"]).into(),
            prefixed(&law["normal_stiffness"], "Pa/m", Typed).into(),
            prefixed(&law["shear_stiffness"], "Pa/m", Typed).into(),
            plain(&law["tension_energy"], "J/m²", Typed).into(),
            plain(&law["shear_energy"], "J/m²", Typed).into(),
        ]
    };
    let rows: Vec<Vec<Cell>> = named(&input["joint_laws"]).map(row).collect();
    let head = [
        "Joint",
        "Law",
        "Friction",
        "Cohesion",
        "Tension",
        "Residual friction",
        "Residual cohesion",
        "Dilation",
        "JRC",
        "JCS",
        "Normal stiffness",
        "Shear stiffness",
        "Energy of fracture, opening",
        "Energy of fracture, slip",
    ];
    part("Strength of joints", &table(&head, &rows))
}

fn sets(input: &Value) -> String {
    let row = |(k, set): (usize, &Value)| -> Vec<Cell> {
        let name = match text(&set["name"]) {
            "" => format!("joint_set[{k}]"),
            name => name.to_owned(),
        };
        let scatter = if set["angle_sd_deg"].is_null() { &set["dip_sd_deg"] } else { &set["angle_sd_deg"] };
        vec![
            name.into(),
            text_or_none(&set["law"]),
            plain(&set["dip_deg"], "°", Typed).into(),
            text_or_none(&set["dips"]),
            plain(&set["dip_direction_deg"], "°", Typed).into(),
            plain(&set["angle_deg"], "°", Typed).into(),
            nonzero(scatter, |value| plain(value, "°", Typed)),
            length(&set["spacing"], Typed).into(),
            nonzero(&set["spacing_sd"], |value| length(value, Typed)),
            length(&set["trace_length"], Typed).into(),
            plain(&set["persistence"], "", Typed).into(),
            plain(&set["seed"], "", Typed).into(),
        ]
    };
    let rows: Vec<Vec<Cell>> = entries(&input["joint_sets"]).iter().enumerate().map(row).collect();
    let head = [
        "Joint set",
        "Joint",
        "Dip",
        "To the",
        "Dip direction",
        "Angle from x axis",
        "Scatter of angle",
        "Spacing",
        "Scatter of spacing",
        "Trace length",
        "Persistence",
        "Seed",
    ];
    part("Joint sets", &table(&head, &rows))
}

fn joints(input: &Value) -> String {
    let row = |joint: &Value| -> Vec<Cell> {
        let law = if joint["law"].is_null() { "the only law".into() } else { text(&joint["law"]).into() };
        vec![law, plain(&joint["count"], "", Typed).into(), length(&joint["length"], Digits::Three).into()]
    };
    let rows: Vec<Vec<Cell>> = entries(&input["joints"]).iter().map(row).collect();
    part("Joints drawn one by one", &table(&["Joint", "Number", "Total length"], &rows))
}

fn text_or_none(value: &Value) -> Cell {
    value.as_str().map_or(Cell::Empty, Cell::from)
}

fn in_situ(input: &Value) -> String {
    let stress_now = &input["in_situ"];
    let gradient = |k: usize| nonzero(&stress_now["gradient"][k], |value| prefixed(value, "Pa/m", Typed));
    let rows = [
        ("Horizontal over vertical stress", plain(&stress_now["k0"], "", Typed).into()),
        ("Horizontal stress", stress(&stress_now["sxx"]).into()),
        ("Vertical stress", stress(&stress_now["syy"]).into()),
        ("Change of the horizontal stress with height", gradient(0)),
        ("Change of the vertical stress with height", gradient(1)),
        ("Height of reference", length(&stress_now["y_reference"], Typed).into()),
    ];
    part("Stress in the ground", &facts(&rows))
}

fn water(input: &Value) -> String {
    let water = &input["water"];
    let full = match water["joints"].as_bool() {
        Some(true) => "full below the water table".into(),
        Some(false) => "dry".into(),
        None => Cell::Empty,
    };
    let rows = [
        ("Level", length(&water["level"], Typed).into()),
        ("Water table", points(&water["table"])),
        ("Density", plain(&water["density"], "kg/m³", Typed).into()),
        ("Joints", full),
    ];
    part("Water", &facts(&rows))
}

/// Surfaces of the water that stages bring.
fn drawdowns(input: &Value) -> String {
    let row = |stage: &Value| -> Vec<Cell> {
        let water = &stage["water"];
        vec![text(&stage["name"]).into(), length(&water["level"], Typed).into(), points(&water["table"])]
    };
    let stages = entries(&input["stages"]).iter().filter(|stage| stage["water"].is_object());
    let rows: Vec<Vec<Cell>> = stages.map(row).collect();
    part("Water in later stages", &table(&["Stage", "Level", "Water table"], &rows))
}

/// Points as `(x, y)` in metres.
fn points(value: &Value) -> Cell {
    let parts: Vec<(String, Number)> = entries(value)
        .iter()
        .enumerate()
        .flat_map(|(k, point)| {
            let before = if k == 0 { "x " } else { ";  x " };
            let x = plain(&point[0], "", Typed).map(|x| (before.to_owned(), x));
            let y = plain(&point[1], "m", Typed).map(|y| (", y ".to_owned(), y));
            x.into_iter().chain(y)
        })
        .collect();
    if parts.is_empty() { Cell::Empty } else { Cell::Mixed(parts) }
}

fn loads(input: &Value) -> String {
    let row = |load: &Value| -> Vec<Cell> {
        let of = |key: &str, k: usize, unit: &str| nonzero(&load[key][k], |value| prefixed(value, unit, Typed));
        let first = |cells: [Cell; 3]| cells.into_iter().find(|cell| *cell != Cell::Empty).unwrap_or(Cell::Empty);
        let axis = |k: usize| first([of("force", k, "N/m"), of("traction", k, "Pa"), of("acceleration", k, "m/s²")]);
        vec![
            text_or_none(&load["name"]),
            text(&load["kind"]).into(),
            axis(0),
            axis(1),
            nonzero(&load["moment"], |value| prefixed(value, "N·m/m", Typed)),
            stress(&load["pressure"]).into(),
            stress(&load["pressure_end"]).into(),
        ]
    };
    let rows: Vec<Vec<Cell>> = entries(&input["loads"]).iter().map(row).collect();
    let head = ["Load", "Kind", "Horizontal", "Vertical", "Moment", "Pressure", "Pressure at the end"];
    part("Loads", &table(&head, &rows))
}

fn motions(input: &Value) -> String {
    let row = |motion: &Value| -> Vec<Cell> {
        let unit = if text(&motion["kind"]) == "velocity" { "m/s" } else { "m/s²" };
        let axis = if text(&motion["axis"]) == "x" { "horizontal" } else { "vertical" };
        vec![text(&motion["kind"]).into(), axis.into(), plain(&motion["peak"], unit, Digits::Three).into()]
    };
    let rows: Vec<Vec<Cell>> = entries(&input["base_motions"]).iter().map(row).collect();
    part("Motion of the base", &table(&["Quantity", "Direction", "Greatest value"], &rows))
}

/// Name of a bolt, or its number.
pub fn bolt_name(bolt: &Value, k: usize) -> Cell {
    bolt["name"].as_str().map_or_else(|| Cell::from(format!("bolt[{k}]")), Cell::from)
}

fn bolts(input: &Value) -> String {
    let row = |(k, bolt): (usize, &Value)| -> Vec<Cell> {
        let grouted = if text(&bolt["anchorage"]) == "grouted" { "grouted" } else { "at its ends" };
        vec![
            bolt_name(bolt, k),
            plain(&bolt["points"][0][0], "", Digits::Three).into(),
            plain(&bolt["points"][0][1], "", Digits::Three).into(),
            length(&bolt["length"], Digits::Three).into(),
            grouted.into(),
            length(&bolt["spacing"], Typed).into(),
            steel_area(&bolt["area"]).into(),
            nonzero(&bolt["pretension"], |value| prefixed(value, "N", Typed)),
            prefixed(&bolt["yield_force"], "N", Typed).into(),
            text_or_none(&bolt["support"]),
        ]
    };
    let rows: Vec<Vec<Cell>> = entries(&input["bolts"]).iter().enumerate().map(row).collect();
    let head = [
        "Bolt",
        "Head x (m)",
        "Head y (m)",
        "Length",
        "Anchored",
        "Spacing out of plane",
        "Section of a bar",
        "Pretension",
        "Yield force",
        "Support",
    ];
    table(&head, &rows)
}

fn stages(input: &Value) -> String {
    let row = |stage: &Value| -> Vec<Cell> {
        let dynamic = text(&stage["kind"]) == "dynamic";
        let lasts = if dynamic { plain(&stage["duration"], "s", Typed).into() } else { "until the rock rests".into() };
        let installs: Vec<&str> = entries(&stage["install"]).iter().filter_map(Value::as_str).collect();
        let changes = [
            (!entries(&stage["law"]).is_empty(), "strengths change"),
            (!entries(&stage["switch_law"]).is_empty(), "joints take another law"),
            (!entries(&stage["excavate"]).is_empty(), "rock is excavated"),
            (!entries(&stage["fix"]).is_empty(), "supports are added"),
            (!entries(&stage["free"]).is_empty(), "supports are removed"),
        ];
        let mut words: Vec<String> =
            changes.into_iter().filter(|(there, _)| *there).map(|(_, word)| word.to_owned()).collect();
        if !installs.is_empty() {
            words.push(format!("bolts installed: {}", installs.join(", ")));
        }
        let words = if words.is_empty() { Cell::Empty } else { words.join("; ").into() };
        vec![text(&stage["name"]).into(), text(&stage["kind"]).into(), lasts, words]
    };
    let rows: Vec<Vec<Cell>> = entries(&input["stages"]).iter().map(row).collect();
    table(&["Stage", "Kind", "Lasts", "At its start"], &rows)
}
