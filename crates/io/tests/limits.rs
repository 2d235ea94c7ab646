//! No numeric key of a case is unchecked, no text makes reading panic, and equal cases have equal fingerprints.

use std::collections::BTreeSet;
use std::path::Path;

use crate::common::random::Random;
use crate::support::{CASE, with_geometry};
use enmm::model::{Case, Simulation};
use enmm_io::{load_case, parse_case, schema};
use serde_json::Value;

/// Calls `visit` with the dotted names of every number of a value, list indices left out and names of rocks and laws
/// replaced.
fn visit_numbers(value: &mut Value, name: &str, visit: &mut dyn FnMut(&str, &mut Value)) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| visit_numbers(item, name, visit)),
        Value::Object(fields) => {
            let named = matches!(name, ".rock" | ".joint_law");
            for (field, item) in fields {
                visit_numbers(item, &format!("{name}.{}", if named { "NAME" } else { field }), visit);
            }
        }
        Value::Number(_) => visit(name, value),
        _ => {}
    }
}

/// Collects the dotted names of every key of type `number` in a schema.
fn numbers_of_schema(root: &Value, node: &Value, name: &str, found: &mut BTreeSet<String>) {
    let reference = node.get("$ref").and_then(Value::as_str).map(|path| root.pointer(&path[1..]).unwrap());
    for inner in reference.into_iter().chain(node.get("items")) {
        numbers_of_schema(root, inner, name, found);
    }
    if let Some(inner) = node.get("additionalProperties") {
        numbers_of_schema(root, inner, &format!("{name}.NAME"), found);
    }
    for inner in node.get("anyOf").and_then(Value::as_array).into_iter().flatten() {
        numbers_of_schema(root, inner, name, found);
    }
    for (field, inner) in node.get("properties").and_then(Value::as_object).into_iter().flatten() {
        numbers_of_schema(root, inner, &format!("{name}.{field}"), found);
    }
    let kind = node.get("type");
    let is_number = |kind: &Value| kind == "number";
    if kind.is_some_and(|kind| is_number(kind) || kind.as_array().is_some_and(|kinds| kinds.iter().any(is_number))) {
        found.insert(name.to_string());
    }
}

/// A law of the kind that the valid case does not have.
const ROUGH: &str = r#"
[joint_law.bandis]
kind = "barton_bandis"
friction_deg = 28.0
normal_stiffness = 1e10
jrc = 10.0
jcs = 1e8
closure_max = 1e-4
"#;

/// A case as users write it, with every numeric key that reading turns into others.
const SHORT: &str = r#"
title = "Bolts, cuts and sets in few words"
domain = { outline = [[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [0.0, 10.0]], joint_law = "clean", curve_tolerance = 0.1 }
transform = { scale = 0.001, shift = [1.0, 2.0] }
mesh = { size = 1.0 }
section = { azimuth_deg = 90.0 }
in_situ = { k0 = 0.6, density = 2600.0 }

[[joint_set]]
angle_deg = 40.0
angle_sd_deg = 2.0
spacing = 3.0
trace_length = 4.0
persistence = 0.8
origin = [1.0, 2.0]

[[joint_set]]
dip_deg = 60.0
dip_direction_deg = 100.0
angle_distribution = "fisher"
fisher_k = 200.0
spacing = 4.0

[[tessellation]]
shape = "trigon"
size = 2.0
region = [[12.0, 1.0], [18.0, 1.0], [18.0, 4.0]]
law = "weak"

[[cut]]
points = [[0.0, 5.0], [20.0, 5.0]]

[[law_region]]
region = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0]]
to = "weak"

[[bolt_pattern]]
line = [[0.5, 2.0], [0.5, 8.0]]
distance = 2.0
length = 5.0
angle_deg = -10.0
anchorage = "grouted"
young = 2e11
area = 5e-4
spacing = 2.0
yield_force = 2e5
rupture_strain = 0.1
pretension = 1e4
free_length = 0.2

[rock.granite]
density = 2650.0
young = 5e10
poisson = 0.25

[joint_law.clean]
friction_deg = 35.0

[joint_law.weak]
friction_deg = 20.0

[[stage]]
name = "settle"
kind = "static"
duration_max = 10.0

[[random]]
key = "joint_law.clean.friction_deg"
distribution = "normal"
mean = 35.0
sd = 3.0
low = 20.0
high = 50.0

[[random]]
key = "joint_law.weak.friction_deg"
distribution = "triangular"
least = 15.0
mode = 20.0
most = 25.0

[[random_correlation]]
keys = ["joint_law.clean.friction_deg", "joint_law.weak.friction_deg"]
value = 0.5

[ensemble]
limit = 1.0
interval = 0.1
"#;

/// How files of records are read: keys of which nothing is left when they have been.
const READINGS: [&str; 2] = [
    "[[base_motion]]\nrecord = { dt = 0.01 }\n",
    "[[quiet]]\nedge = [[0.0, 0.0], [20.0, 0.0]]\nrecord = { dt = 0.01 }\n",
];

/// Cases whose records are not yet read.
fn unread_as_json() -> [Value; 2] {
    READINGS.map(|reading| toml::from_str(&format!("{SHORT}{reading}")).expect("TOML"))
}

/// The case in few words, as it is written.
fn short_as_json() -> Value {
    toml::from_str(SHORT).expect("TOML")
}

/// The valid case, and the same with the other of keys that exclude each other.
fn cases_as_json() -> [Value; 2] {
    let own = CASE.replacen("size = 1.0\n", "size = 1.0\nleast_block = 1e-4\n", 1);
    let own =
        own.replacen("snap_tolerance = 1e-6\n", "snap_tolerance = 1e-6\nextend_ends = 0.01\nnear_ends = 0.1\n", 1);
    let own = own.replacen("damping = 0.05\n", "damping = 0.05\nwater = { level = 1.0 }\n", 1);
    let drained = own.replacen("water = { level = 1.0 }", "water = { table = [[0.0, 1.0], [10.0, 0.5]] }", 1);
    let other = drained.replacen("level = 1.5", "table = [[0.0, 2.0], [10.0, 1.5]]", 1) + ROUGH;
    [own, other].map(|text| serde_json::to_value(parse_case(&text, "slope.toml", Path::new("")).unwrap().case).unwrap())
}

#[test]
fn every_number_of_the_schema_has_a_limit_at_both_ends() {
    let mut names = BTreeSet::new();
    for mut json in cases_as_json() {
        visit_numbers(&mut json, "", &mut |name, _| names.extend([name.to_string()]));
    }
    for mut json in [vec![short_as_json()], unread_as_json().to_vec()].concat() {
        visit_numbers(&mut json, "", &mut |name, _| names.extend([name.to_string()]));
    }
    let mut expected = BTreeSet::new();
    let schema = schema();
    numbers_of_schema(&schema, &schema, "", &mut expected);
    let absent: Vec<_> = expected.difference(&names).collect();
    assert!(absent.is_empty(), "the case of this test must hold every numeric key, {absent:?} are absent");

    let mut plain = BTreeSet::new();
    for mut original in cases_as_json() {
        refuses_extremes(&original, &|_| true);
        visit_numbers(&mut original, "", &mut |name, _| plain.extend([name.to_string()]));
    }
    // Other keys of the short case are seen first by what lays bolts and cuts in the rock.
    refuses_extremes(&short_as_json(), &|name| !plain.contains(name));
    unread_as_json().iter().for_each(|json| refuses_extremes(json, &|name| name.ends_with("record.dt")));
}

/// Reads a case as files are read: turns short words into plain data and checks them. Keys are those that were written.
fn read(mut case: Case) -> Result<(), String> {
    let found = case.expand().map_err(|error| error.key)?;
    let written = |key: String| {
        let origin = found.origins.iter().find(|(made, _)| key.starts_with(made.as_str()));
        origin.map_or(key.clone(), |(made, origin)| key.replacen(made.as_str(), origin, 1))
    };
    case.validate().map_err(|error| written(error.key))
}

/// Every number of a case, of those that are `wanted` by name, is refused when it is far out of range.
fn refuses_extremes(original: &Value, wanted: &dyn Fn(&str) -> bool) {
    let mut count = 0;
    visit_numbers(&mut original.clone(), "", &mut |_, _| count += 1);
    for (nth, extreme) in (0..count).flat_map(|nth| [(nth, 1e30), (nth, -1e30)]) {
        let (mut json, mut at, mut changed) = (original.clone(), 0, None);
        visit_numbers(&mut json, "", &mut |name, value| {
            if at == nth && value.is_f64() {
                *value = Value::from(extreme);
                changed = Some(name.to_string());
            }
            at += 1;
        });
        let Some(name) = changed.filter(|name| wanted(name)) else { continue };
        let case: Case = serde_json::from_value(json).unwrap();
        let key = read(case).err().unwrap_or_else(|| panic!("{name} may be {extreme:e}"));
        let last = name.rsplit('.').next().unwrap();
        assert!(key.contains(last), "{name} = {extreme:e} is reported at {key}");
    }
}

#[test]
fn schema_has_a_title_and_describes_every_key() {
    fn check(name: &str, node: &Value) {
        for (key, inner) in node.get("properties").and_then(Value::as_object).into_iter().flatten() {
            assert!(inner["description"].is_string(), "{name}.{key} has no description");
        }
    }
    let schema = schema();
    assert_eq!(schema["title"], "Case");
    check("case", &schema);
    schema["$defs"].as_object().unwrap().iter().for_each(|(name, node)| check(name, node));
}

#[test]
fn case_written_and_read_again_is_the_same_case() {
    let first = parse_case(CASE, "slope.toml", Path::new("")).unwrap();
    let text = toml::to_string(&first.case).unwrap();
    let second = parse_case(&text, "again.toml", Path::new("elsewhere")).unwrap();
    assert_eq!(first.case, second.case);
    assert_eq!(first.hash, second.hash);
    assert_eq!(first.hash.len(), 16);
}

#[test]
fn fingerprint_changes_with_any_value() {
    let hash = |text: &str| parse_case(text, "slope.toml", Path::new("")).unwrap().hash;
    assert_ne!(hash(CASE), hash(&CASE.replacen("density = 2650", "density = 2651", 1)));
    assert_ne!(hash(CASE), hash(&CASE.replacen("clean", "Clean", 100)));
}

/// Found by `cargo xtask fuzz --part cases --seed 7 --from 5850`: the kinetic energy of the first step was no number.
#[test]
fn rock_too_light_for_numbers_is_refused_and_the_lightest_and_softest_moves() {
    let loaded = load_case(&crate::common::root().join("examples/cases/block_on_incline.toml")).unwrap();
    let with = |density: f64, young: f64| {
        let mut case = loaded.case.clone();
        case.rocks.values_mut().for_each(|rock| (rock.density, rock.young) = (density, young));
        Simulation::new(case)
    };
    for (density, young, place) in [(1e-300, 1e10, "density"), (2650.0, 1e-300, "young")] {
        assert!(with(density, young).expect_err("refused").key.ends_with(place));
    }
    for (density, young) in [(1e-3, 1.0), (1e-3, 1e15), (1e6, 1.0), (1e6, 1e15)] {
        let mut model = with(density, young).unwrap();
        let Ok(report) = model.advance(true) else { continue };
        assert!(report.ledger.kinetic.is_finite(), "{density} kg/m3, {young} Pa");
    }
}

#[test]
fn deep_nesting_is_an_error() {
    let deep = format!("[domain]\noutline = {}", "[".repeat(100_000));
    assert!(parse_case(&deep, "deep.toml", Path::new("")).is_err());
    for open in ["[", "{\"outline\":"] {
        assert!(with_geometry("g.json", &open.repeat(100_000)).is_err());
    }
}

/// Pieces that edits put into a text beside random letters.
const PIECES: [&str; 26] = [
    "[",
    "]",
    "{",
    "}",
    "=",
    "\"",
    "nan",
    "NaN",
    "-Infinity",
    "1e999",
    "\n0\nLINE\n",
    "é",
    "[[",
    "]]",
    ".",
    ",",
    "true",
    "null",
    "-",
    "\\",
    "'''",
    "#",
    "\n10\n",
    "\u{0}",
    "\n0\nSECTION\n2\nENTITIES\n",
    "POLYLINE",
];

/// An edit: where (as a share of the text), how many bytes go, what comes instead.
fn edits(random: &mut Random) -> Vec<(f64, usize, String)> {
    let letter = |random: &mut Random| {
        char::from(b"\n".iter().copied().chain(b' '..=b'~').nth(random.below(96) as usize).unwrap())
    };
    let count = 1 + random.below(5);
    let edit = |_| {
        let piece = match random.below(2) {
            0 => (0..random.below(7)).map(|_| letter(random)).collect(),
            _ => PIECES[random.below(PIECES.len() as u32) as usize].to_owned(),
        };
        (random.unit(), random.below(40) as usize, piece)
    };
    (0..count).map(edit).collect()
}

fn apply(text: &str, edits: &[(f64, usize, String)]) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    for (share, length, piece) in edits {
        let start = ((letters.len() as f64) * share) as usize;
        let end = (start + length).min(letters.len());
        letters.splice(start..end, piece.chars());
    }
    letters.into_iter().collect()
}

fn is_one_line(message: &str) -> bool {
    !message.is_empty() && !message.contains('\n')
}

const JSON: &str = r#"{"name": "g", "outline": [[0, 0], [9, 0], [9.5, 9]],
 "holes": [[[1, 1], [2, 1], [2, 2]]], "joints": [[[0, 0], [1, 1]], [[0, 0], [1e0, "Infinity"]]]}"#;
const GEOJSON: &str = r#"{"type": "FeatureCollection", "features": [
 {"type": "Feature", "properties": {"law": "clean"}, "geometry": {"type": "LineString",
  "coordinates": [[0, 0], [1, 1]]}},
 {"type": "Feature", "properties": null, "geometry": {"type": "Polygon",
  "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]]]}}]}"#;
const DXF: &str = "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nclean\n10\n0.0\n20\n1.0\n11\n5.0\n21\n6.0\n0\nLWPOLYLINE\n\
                   8\nOUTLINE\n                   70\n1\n10\n0\n20\n0\n10\n9\n20\n0\n10\n9\n20\n9\n0\nPOLYLINE\n70\n1\n\
                   0\nVERTEX\n10\n1\n20\n1\n0\nVERTEX\n10\n2\n20\n1\n0\nSEQEND\n0\nENDSEC\n0\nEOF\n";

#[test]
fn mutated_case_never_panics() {
    for seed in 0..400 {
        let text = apply(CASE, &edits(&mut Random::new(seed)));
        if let Err(error) = parse_case(&text, "slope.toml", Path::new("/nowhere")) {
            assert!(is_one_line(&error.to_string()), "seed {seed}: {error}");
        }
    }
}

#[test]
fn mutated_geometry_never_panics() {
    for seed in 0..400 {
        let edits = edits(&mut Random::new(seed));
        for (name, text) in [("g.json", JSON), ("g.geojson", GEOJSON), ("g.dxf", DXF)] {
            if let Err(error) = with_geometry(name, &apply(text, &edits)) {
                assert!(is_one_line(&error), "seed {seed}: {error}");
            }
        }
    }
}
