//! No numeric key of a case is unchecked, no text makes reading panic, and equal cases have equal fingerprints.

use std::path::Path;

use crate::common::random::Random;
use crate::key_reference::{Source, find, number_of, sections};
use crate::support::{CASE, with_geometry};
use enmm::model::Simulation;
use enmm_case::keys::Plain;
use enmm_io::{CaseError, LoadedCase, load_case, parse_case, schema};
use serde_json::Value;

/// Names of the ends of a range in a schema, closed and open.
const ENDS: [[&str; 2]; 2] = [["minimum", "exclusiveMinimum"], ["maximum", "exclusiveMaximum"]];

#[test]
fn every_number_of_the_schema_has_a_limit_at_both_ends() {
    fn check(name: &str, node: &Value) {
        let kinds = node["type"].to_string();
        if kinds.contains("number") || kinds.contains("integer") {
            let has = |ends: [&str; 2]| ends.iter().any(|end| node[end].is_number());
            assert!(ENDS.into_iter().all(has), "{name} has no limit: give its field a rule");
        }
        match node {
            Value::Object(fields) => fields.iter().for_each(|(key, inner)| check(&format!("{name}.{key}"), inner)),
            Value::Array(items) => items.iter().for_each(|inner| check(name, inner)),
            _ => {}
        }
    }
    check("case", &schema());
}

/// Each number of the schema is refused just outside its range, and not for its range just inside, by a case of the key
/// reference.
#[test]
fn ranges_of_the_schema_are_those_that_the_program_checks() {
    let sources = Source::all();
    let mut checked = 0;
    for section in sections() {
        for (key, property, _) in &section.keys {
            let (number, path) = (number_of(property), section.path());
            let is_whole = number["type"].to_string().contains("integer");
            let told = |source: &Source, value: f64| refusal(source, &path, key, value);
            for (ends, words) in ENDS.into_iter().zip([["at least", "greater than"], ["at most", "less than"]]) {
                let [closed, open] = ends.map(|end| number[end].as_f64());
                let Some(limit) = closed.or(open).filter(|limit| !is_whole || limit.abs() < 1e18) else { continue };
                let beyond = |up: bool| match (is_whole, up) {
                    (true, _) => limit + if up { 1.0 } else { -1.0 },
                    (false, true) => limit.next_up(),
                    (false, false) => limit.next_down(),
                };
                let up = ends == ENDS[1];
                let [inside, outside] = if closed.is_some() { [limit, beyond(up)] } else { [beyond(!up), limit] };
                let place = format!("{}.{key} = {outside:e}", path.join("."));
                let refusing = sources.iter().find(|source| told(source, outside).is_some());
                let source = refusing.unwrap_or_else(|| panic!("{place} is not refused"));
                let message = told(source, inside).unwrap_or_default();
                let is_refused = words.iter().any(|words| message.contains(&format!("{words} {} ", Plain(limit))));
                assert!(!is_refused, "{place}, inside: {message}");
                checked += 1;
            }
        }
    }
    assert!(checked > 250, "{checked}");
}

/// Why the program refuses a case with a number in the place of the first one of a key, if it does so at that key.
fn refusal(source: &Source, path: &[&str], key: &str, value: f64) -> Option<String> {
    let mut table = source.table.clone();
    let mut number = find(&mut table, path, key)?;
    while number.is_array() || number.is_table() {
        number = match number {
            toml::Value::Table(named) => named.iter_mut().next()?.1,
            list => list.get_mut(0)?,
        };
    }
    let is_whole = number.is_integer() && value.fract() == 0.0 && value.abs() < 1e18;
    *number = if is_whole { toml::Value::Integer(value as i64) } else { toml::Value::Float(value) };
    let text = toml::to_string(&table).expect("TOML");
    match parse_case(&text, "case.toml", source.path.parent().expect("a folder")) {
        Err(CaseError::Value { key: at, message, .. }) if at.contains(key) => Some(message),
        _ => None,
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

/// A checkpoint goes on, and a store finds its samples, under another title and with other files to write.
#[test]
fn fingerprint_does_not_change_with_what_acts_on_nothing() {
    let loaded = parse_case(CASE, "slope.toml", Path::new("")).unwrap();
    let mut other = loaded.case.clone();
    other.title.push_str(", again");
    other.output.frames = !other.output.frames;
    other.fmu = Some(enmm::model::case::FmuNotes { author: Some("A".to_owned()), ..Default::default() });
    assert_eq!(LoadedCase::of(other, "slope.toml").unwrap().hash, loaded.hash);
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
    let sources = Source::all();
    for (seed, source) in (0..400).zip(sources.iter().cycle()) {
        let text = apply(&source.text, &edits(&mut Random::new(seed)));
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
