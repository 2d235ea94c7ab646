//! Input: section, rock, joints, water, loads, bolts, stages.

use enmm_case::keys::Rule;
use enmm_case::{
    Bolt, Flow, Gravity, HoekBrown, InSitu, JointLaw, JointSet, Load, PlaneOfWeakness, Rock, RockFracture, Section,
    Water,
};
use serde_json::Value;

use super::number::{Digits, Number, length, plain, prefixed, steel_area};
use super::parts::{chapter, entries, figure, part, text};
use super::records::Records;
use super::table::{Cell, facts, table};

use Digits::Typed;

/// Cells with the heads of their columns.
type Row = Vec<(&'static str, Cell)>;

/// The chapters of input; empty where no record has it.
pub fn input_chapter(records: &Records) -> String {
    let Some(record) = records.with_input() else { return String::new() };
    let input = &record.json["input"];
    let model = records.run.as_ref().map_or(String::new(), |run| {
        figure(run, "model", "Section with rock, joints, supports, loads, water and bolts; the bar gives the scale.")
    });
    let section = facts(&[keys(Section::KEYS, &input["section"]), keys(Gravity::KEYS, &input["gravity"])].concat());
    let section = format!(
        "{model}{section}<p>Lengths in metres, y upwards; tension is positive; forces are per metre of \
                           slope unless a bar is named.</p>\n"
    );
    chapter("Section", &section)
        + &chapter("Rock and joints", &[rocks(input), laws(input), sets(input), joints(input)].concat())
        + &chapter(
            "Stress, water and loads",
            &[
                in_situ(input),
                water(input),
                drawdowns(input),
                flow(input),
                heads(input),
                rains(input),
                drains(input),
                loads(input),
                motions(input),
            ]
            .concat(),
        )
        + &chapter("Bolts as designed", &bolts(input))
        + &chapter("Stages as planned", &stages(input))
}

/// The keys of a table that the report shows, in the order of the case.
fn keys(rules: &[Rule], values: &Value) -> Row {
    let shown = rules.iter().filter(|rule| !rule.label.is_empty());
    shown.map(|rule| (rule.label, number(rule, &values[rule.key]))).collect()
}

/// A number of a key as it was typed, in the unit that suits it.
fn number(rule: &Rule, value: &Value) -> Cell {
    if rule.is_none_at_zero && value.as_f64() == Some(0.0) {
        return Cell::Empty;
    }
    match rule.unit.sign {
        "m" => length(value, Typed),
        "m²" => steel_area(value),
        unit @ ("Pa" | "Pa/m" | "N" | "N/m" | "N·m/m") => prefixed(value, unit, Typed),
        unit => plain(value, unit, Typed),
    }
    .into()
}

/// A table of rows that have the same heads.
fn listed(rows: impl Iterator<Item = Row>) -> String {
    let rows: Vec<Row> = rows.collect();
    let heads: Vec<&str> = rows.iter().take(1).flatten().map(|(head, _)| *head).collect();
    let cells: Vec<Vec<Cell>> = rows.into_iter().map(|row| row.into_iter().map(|(_, cell)| cell).collect()).collect();
    table(&heads, &cells)
}

/// The entries of a map by name.
fn named(value: &Value) -> impl Iterator<Item = (&String, &Value)> {
    value.as_object().into_iter().flatten()
}

fn rocks(input: &Value) -> String {
    let row = |(name, rock): (&String, &Value)| {
        let name = vec![("Rock", name.as_str().into())];
        [
            name,
            keys(Rock::KEYS, rock),
            keys(HoekBrown::KEYS, &rock["hoek_brown"]),
            keys(PlaneOfWeakness::KEYS, &rock["plane_of_weakness"]),
            keys(RockFracture::KEYS, &rock["fracture"]),
        ]
        .concat()
    };
    part("Rock", &listed(named(&input["rocks"]).map(row)))
}

fn laws(input: &Value) -> String {
    let row = |(name, law): (&String, &Value)| {
        let kind = if text(&law["kind"]) == "barton_bandis" { "Barton–Bandis" } else { "Mohr–Coulomb" };
        [vec![("Joint", name.as_str().into()), ("Law", kind.into())], keys(JointLaw::KEYS, law)].concat()
    };
    part("Strength of joints", &listed(named(&input["joint_laws"]).map(row)))
}

fn sets(input: &Value) -> String {
    let row = |(k, set): (usize, &Value)| {
        let name = match text(&set["name"]) {
            "" => format!("joint_set[{k}]"),
            name => name.to_owned(),
        };
        let words =
            [("Joint set", name.into()), ("Joint", text_or_none(&set["law"])), ("To the", text_or_none(&set["dips"]))];
        [words.to_vec(), keys(JointSet::KEYS, set)].concat()
    };
    part("Joint sets", &listed(entries(&input["joint_sets"]).iter().enumerate().map(row)))
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
    let stress = &input["in_situ"];
    let gradient = |k: usize| number(&InSitu::rule("gradient").none_at_zero(), &stress["gradient"][k]);
    let gradients = [
        ("Change of the horizontal stress with height", gradient(0)),
        ("Change of the vertical stress with height", gradient(1)),
    ];
    part("Stress in the ground", &facts(&[keys(InSitu::KEYS, stress), gradients.to_vec()].concat()))
}

fn water(input: &Value) -> String {
    let water = &input["water"];
    let full = match water["joints"].as_bool() {
        Some(true) => "full below the water table".into(),
        Some(false) if input["flow"].is_object() => "with the pressure of the flow".into(),
        Some(false) => "dry".into(),
        None => Cell::Empty,
    };
    let others = [("Water table", points(&water["table"])), ("Joints", full)];
    part("Water", &facts(&[keys(Water::KEYS, water), others.to_vec()].concat()))
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

fn flow(input: &Value) -> String {
    part("Flow in joints", &facts(&keys(Flow::KEYS, &input["flow"])))
}

/// Heads at the start and in later stages.
fn heads(input: &Value) -> String {
    let level = |level: &Value| length(level, Typed).into();
    changing(input, ("heads", "level", "heads"), level, ("Heads in joints", ["Head", "Stage", "Level"]))
}

/// Rain at the start and in later stages.
fn rains(input: &Value) -> String {
    let rate = |rate: &Value| plain(rate, "m/s", Typed).into();
    changing(input, ("rains", "rate", "rain"), rate, ("Rain that joints take", ["Rain", "Stage", "Rate"]))
}

/// Drains, and since when they act.
fn drains(input: &Value) -> String {
    let since = |drain: &Value| -> Cell {
        let by = |stage: &&Value| entries(&stage["drain"]).contains(&drain["name"]);
        match drain["active"].as_bool() {
            Some(false) => {
                entries(&input["stages"]).iter().find(by).map_or(Cell::Empty, |stage| text(&stage["name"]).into())
            }
            _ => "start".into(),
        }
    };
    let row = |drain: &Value| -> Vec<Cell> {
        vec![text(&drain["name"]).into(), since(drain), plain(&drain["pump"], "m²/s", Typed).into()]
    };
    let rows: Vec<Vec<Cell>> = entries(&input["drains"]).iter().map(row).collect();
    part("Drains", &table(&["Drain", "Acts from", "Pump"], &rows))
}

/// Named values of one list at the start, under its own key, and those that stages bring.
fn changing(
    input: &Value,
    (list, key, of_stage): (&str, &str, &str),
    cell: impl Fn(&Value) -> Cell,
    (title, columns): (&str, [&str; 3]),
) -> String {
    let row = |name: &str, stage: &str, value: &Value| vec![name.into(), stage.into(), cell(value)];
    let own = entries(&input[list]).iter();
    let mut rows: Vec<Vec<Cell>> = own.map(|entry| row(text(&entry["name"]), "start", &entry[key])).collect();
    for stage in entries(&input["stages"]) {
        rows.extend(named(&stage[of_stage]).map(|(name, value)| row(name, text(&stage["name"]), value)));
    }
    part(title, &table(&columns, &rows))
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
    let row = |load: &Value| {
        let vectors = [Load::rule("force"), Load::rule("traction"), Load::rule("acceleration")];
        let axis = |k: usize| {
            let cells = vectors.iter().map(|rule| number(&rule.none_at_zero(), &load[rule.key][k]));
            cells.into_iter().find(|cell| *cell != Cell::Empty).unwrap_or(Cell::Empty)
        };
        let first = [
            ("Load", text_or_none(&load["name"])),
            ("Kind", text(&load["kind"]).into()),
            ("Horizontal", axis(0)),
            ("Vertical", axis(1)),
        ];
        [first.to_vec(), keys(Load::KEYS, load)].concat()
    };
    part("Loads", &listed(entries(&input["loads"]).iter().map(row)))
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
    let row = |(k, bolt): (usize, &Value)| {
        let grouted = if text(&bolt["anchorage"]) == "grouted" { "grouted" } else { "at its ends" };
        let place = [
            ("Bolt", bolt_name(bolt, k)),
            ("Head x (m)", plain(&bolt["points"][0][0], "", Digits::Three).into()),
            ("Head y (m)", plain(&bolt["points"][0][1], "", Digits::Three).into()),
            ("Length", length(&bolt["length"], Digits::Three).into()),
            ("Anchored", grouted.into()),
        ];
        [place.to_vec(), keys(Bolt::KEYS, bolt), vec![("Support", text_or_none(&bolt["support"]))]].concat()
    };
    listed(entries(&input["bolts"]).iter().enumerate().map(row))
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
