//! `docs/book/reference.md` is what the schema, the validation and the example cases say of every key of a case; with
//! `ENMM_WRITE_REFERENCE` in the environment (`cargo xtask reference`) this test writes it.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

use enmm_io::{CaseError, parse_case};
use serde_json::Value as Json;
use toml::{Table, Value};

const REFERENCE: &str = "docs/book/reference.md";
/// Folders of the cases that examples are taken from, in this order.
const CASES: [&str; 2] = ["examples/cases", "docs/keys"];
/// Units that stand in brackets behind what they belong to.
const UNITS: [&str; 17] = [
    "m",
    "m²",
    "s",
    "Pa",
    "Pa/m",
    "N",
    "N/m",
    "kg/m³",
    "m/s",
    "m/s²",
    "rad/s",
    "degrees",
    "bytes",
    "N per metre of depth",
    "N·m per metre of depth",
    "N/m per metre",
    "Pa, tension positive",
];
const HEAD: &str = "\
# Key reference

Every key of a case, table by table. `cargo xtask reference` writes this page: the sentences and defaults are those of
[case.schema.json](../case.schema.json), the ranges are what the program says of values outside them, and each example
is the first line with its key in [examples/cases](../../examples/cases) or [docs/keys](../keys), which the tests read.

A table in single brackets is there once, one in double brackets as often as you like; `NAME` stands for a name of your
choice. *Required* keys have no default. A limit that depends on another key is that of the case with the example.
Angles are in degrees, everything else in SI units; tension is positive.
";

/// One table of the case file.
struct Section {
    /// Such as `joint_set[]` or `rock.NAME`.
    path: String,
    description: String,
    keys: Vec<(String, Json, bool)>,
}

/// The schema with what its references name.
struct Schema(Json);

impl Schema {
    /// Type of a property, behind references and behind the choice of none.
    fn resolve<'a>(&'a self, property: &'a Json) -> &'a Json {
        if let Some(name) = property["$ref"].as_str() {
            return self.resolve(&self.0["$defs"][name.rsplit('/').next().expect("a name")]);
        }
        match property["anyOf"].as_array().map(|kinds| kinds.iter().filter(|kind| kind["type"] != "null")) {
            Some(mut kinds)
                if property["anyOf"].as_array().is_some_and(|all| all.iter().any(|k| k["type"] == "null")) =>
            {
                self.resolve(kinds.next().expect("a kind"))
            }
            _ => property,
        }
    }

    /// The table at `path` and those within it, the outer ones first.
    fn sections(&self, path: &str, table: &Json, found: &mut Vec<Section>) {
        let required = table["required"].as_array().cloned().unwrap_or_default();
        let mut keys = Vec::new();
        let mut inner = Vec::new();
        for (key, property) in table["properties"].as_object().expect("properties") {
            let kind = self.resolve(property);
            let place = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            let (item, named) = (self.resolve(&kind["items"]), self.resolve(&kind["additionalProperties"]));
            match [kind, item, named].iter().position(|kind| kind["properties"].is_object()) {
                Some(0) => inner.push((place, kind)),
                Some(1) => inner.push((format!("{place}[]"), item)),
                Some(_) => inner.push((format!("{place}.NAME"), named)),
                None => keys.push((key.clone(), property.clone(), required.contains(&Json::from(key.as_str())))),
            }
        }
        found.push(Section { path: path.to_owned(), description: sentence(table), keys });
        inner.into_iter().for_each(|(place, table)| self.sections(&place, table, found));
    }
}

/// A case that examples are taken from.
struct Source {
    path: PathBuf,
    text: String,
    table: Table,
}

impl Source {
    fn all() -> Vec<Self> {
        let mut sources = Vec::new();
        for folder in CASES {
            let entries = std::fs::read_dir(crate::common::root().join(folder)).expect("a folder");
            let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
            paths.retain(|path| path.extension().is_some_and(|end| end == "toml"));
            paths.sort();
            for path in paths {
                let text = std::fs::read_to_string(&path).expect("a case");
                let table = text.parse().expect("TOML");
                sources.push(Self { path, text, table });
            }
        }
        sources
    }

    /// Why the program refuses the case with `value` at a place, if it does.
    fn refusal(&self, path: &[&str], key: &str, value: &dyn Fn(&mut Value)) -> Option<String> {
        let mut table = self.table.clone();
        value(find(&mut table, path, key)?);
        let text = toml::to_string(&table).expect("TOML");
        match parse_case(&text, "case.toml", self.path.parent().expect("a folder")) {
            Err(CaseError::Value { key: at, message, .. }) if at.contains(key) => Some(message),
            _ => None,
        }
    }

    /// The first line with the key in a table of this path.
    fn example(&self, path: &[&str], key: &str) -> Option<String> {
        find(&mut self.table.clone(), path, key)?;
        let (mut here, inline) = (path.is_empty(), path.len() > 1 && path[0] == "stage[]");
        for line in self.text.lines().filter(|line| !line.starts_with('#')) {
            if line.starts_with('[') {
                let head = line.trim_matches(['[', ']']);
                let parts: Vec<&str> = head.split('.').collect();
                here = parts.len() == path.len().min(if inline { 1 } else { 9 })
                    && parts.iter().zip(path).all(|(a, b)| a == &b.trim_end_matches("[]") || *b == "NAME");
            } else if here
                && inline
                && line.contains(&format!("{key} = "))
                && line.contains(path[1].trim_end_matches("[]"))
            {
                return Some(line.to_owned());
            } else if here && line.starts_with(&format!("{key} = ")) && !line.ends_with('[') {
                return Some(line.split("  #").next().unwrap_or_default().trim_end().to_owned());
            }
        }
        None
    }
}

/// The value of `key` in the first table at a path that has it; `NAME` is any table, `[]` any element.
fn find<'a>(table: &'a mut Table, path: &[&str], key: &str) -> Option<&'a mut Value> {
    let Some((first, rest)) = path.split_first() else { return table.get_mut(key) };
    if *first == "NAME" {
        return table.iter_mut().find_map(|(_, inner)| find(inner.as_table_mut()?, rest, key));
    }
    match table.get_mut(first.trim_end_matches("[]"))? {
        Value::Array(list) => list.iter_mut().find_map(|inner| find(inner.as_table_mut()?, rest, key)),
        inner => find(inner.as_table_mut()?, rest, key),
    }
}

/// Puts `number`, or 0 for a negative one among whole numbers, in the place of the first number of a value.
fn replace(value: &mut Value, number: f64) {
    match value {
        Value::Array(list) => list.first_mut().into_iter().for_each(|first| replace(first, number)),
        Value::Integer(_) if number < 0.0 => *value = Value::Integer(0),
        Value::Float(_) | Value::Integer(_) => *value = Value::Float(number),
        _ => {}
    }
}

/// A description as one line.
fn sentence(property: &Json) -> String {
    let text = property["description"].as_str().unwrap_or_default();
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

/// A text in lines that fit the width of documents.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last_mut().expect("a line");
        if line.is_empty() {
            line.push_str(word);
        } else if line.chars().count() + 1 + word.chars().count() <= 120 {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines.join("\n")
}

/// Which values a key takes: those of its schema, or what the program says of values far outside.
fn range(schema: &Schema, property: &Json, refusals: &[String]) -> String {
    let kind = schema.resolve(property);
    if let Some(kinds) = kind["anyOf"].as_array() {
        return kinds.iter().map(|kind| range(schema, kind, refusals)).collect::<Vec<_>>().join(", ");
    }
    if kind["type"] == "array" && schema.resolve(&kind["items"])["oneOf"].is_array() {
        return format!("a list of {}", range(schema, &kind["items"], refusals));
    }
    if let Some(words) = kind["oneOf"].as_array() {
        let words: Vec<String> =
            words.iter().filter_map(|word| Some(format!("`{}`", word["const"].as_str()?))).collect();
        return words.join(", ");
    }
    let types = &kind["type"];
    let is = |name: &str| types == name || types.as_array().is_some_and(|all| all.contains(&Json::from(name)));
    if is("boolean") {
        return "`true`, `false`".to_owned();
    }
    let limits = refusals.iter().filter_map(|message| message.split_once("must be ")?.1.split([';', ':']).next());
    let limits: Vec<&str> = limits.map(|limit| limit.trim_start_matches("a finite number, ")).collect();
    match limits.iter().find(|limit| limit.contains("and")).or(limits.first()) {
        Some(limit) => limit.replace(&u64::MAX.to_string(), "2⁶⁴ − 1"),
        None if is("string") => "text".to_owned(),
        None => "–".to_owned(),
    }
}

/// The unit of a key: what its sentence has in brackets, or what the program says with a value.
fn unit(sentence: &str, refusals: &[String]) -> String {
    let brackets = sentence.split('(').skip(1).filter_map(|rest| rest.split(')').next());
    let written = brackets.map(|words| words.split([';', ',']).next().unwrap_or_default());
    let said = refusals.iter().filter_map(|message| message.split(',').next()?.rsplit_once(' ').map(|(_, unit)| unit));
    written.chain(said).find(|words| UNITS.contains(words)).unwrap_or("–").to_owned()
}

fn default(property: &Json, sentence: &str, required: bool) -> String {
    if required {
        return "*required*".to_owned();
    }
    match &property["default"] {
        Json::Null => {
            let said = sentence.split_once("efault: ").or_else(|| sentence.split_once("default "));
            said.map_or("none", |(_, rest)| {
                rest.split("; ").next().and_then(|rest| rest.split(". ").next()).unwrap_or(rest)
            })
            .trim_end_matches('.')
            .to_owned()
        }
        Json::Array(list) if list.is_empty() => "none".to_owned(),
        value => format!("`{value}`"),
    }
}

fn heading(path: &str) -> String {
    match path.strip_suffix("[]") {
        _ if path.is_empty() => "At the top of a case".to_owned(),
        Some("stage[].law" | "stage[].switch_law") => format!("`{} = [{{ … }}]` of a stage", &path[8..path.len() - 2]),
        Some(name) => format!("`[[{name}]]`"),
        None => format!("`[{path}]`"),
    }
}

/// The number behind the first of some words, such as 30 in `at most 30; default 0`.
fn number_behind(text: &str, words: &[&str]) -> Option<f64> {
    let behind = words.iter().find_map(|word| Some(text.split_once(word)?.1))?;
    behind.split([' ', ';', ',', ':']).next()?.trim_end_matches('.').parse().ok()
}

/// Least and greatest value that a text names, as `at least 0 and at most 90`, `above 0` or `1 to 100,`.
fn ends(text: &str) -> [Option<f64>; 2] {
    let words: Vec<&str> = text.split(' ').collect();
    let span = words.windows(3).find_map(|three| {
        let high = three[2].strip_suffix([',', ';', ':', '.'])?;
        (three[1] == "to").then_some([three[0].parse().ok()?, high.parse().ok()?])
    });
    match span {
        Some(ends) => ends.map(Some),
        None => [&["at least ", "above ", "greater than "][..], &["at most ", "less than ", "below "]]
            .map(|words| number_behind(text, words)),
    }
}

/// The page, and the keys that no case uses.
fn reference() -> (String, Vec<String>) {
    let schema = Schema(enmm_io::schema());
    let mut sections = Vec::new();
    schema.sections("", &schema.0, &mut sections);
    let sources = Source::all();
    let (mut page, mut missing) = (HEAD.to_owned(), Vec::new());
    for section in &sections {
        let path: Vec<&str> = section.path.split('.').filter(|part| !part.is_empty()).collect();
        write!(page, "\n## {}\n\n{}\n\n", heading(&section.path), wrapped(&section.description)).expect("text");
        page += "| key | meaning | unit | default | range | example |\n|---|---|---|---|---|---|\n";
        for (key, property, required) in &section.keys {
            let Some((source, example)) = sources.iter().find_map(|one| Some((one, one.example(&path, key)?))) else {
                missing.push(format!("{}.{key}", section.path));
                continue;
            };
            let outside = [-1e300, 1e300].map(|number| source.refusal(&path, key, &|value| replace(value, number)));
            let refusals: Vec<String> = outside.into_iter().flatten().collect();
            let meaning = sentence(property);
            let range = range(&schema, property, &refusals);
            let unit = if range == "text" { "–".to_owned() } else { unit(&meaning, &refusals) };
            let cells = [
                format!("`{key}`"),
                meaning.clone(),
                unit,
                default(property, &meaning, *required),
                range,
                format!("`{example}`"),
            ];
            writeln!(page, "| {} |", cells.join(" | ")).expect("text");
        }
    }
    (page, missing)
}

#[test]
fn the_key_reference_is_up_to_date() {
    let (page, missing) = reference();
    assert!(missing.is_empty(), "no case in {CASES:?} has a line `KEY = ` with {missing:?}: add one to docs/keys");
    let path = crate::common::root().join(REFERENCE);
    if std::env::var_os("ENMM_WRITE_REFERENCE").is_some() {
        std::fs::write(&path, &page).expect("a page");
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    let line = page.lines().zip(written.lines()).take_while(|(a, b)| a == b).count() + 1;
    assert!(page == written, "{REFERENCE} is out of date from line {line} on: run `cargo xtask reference` and commit");
}

/// Cases of `docs/keys` are read like any other, and each key of the schema is in one table of the page.
#[test]
fn cases_of_the_key_reference_are_valid() {
    let mut tables = BTreeMap::new();
    for source in Source::all() {
        let read = parse_case(&source.text, "case.toml", source.path.parent().expect("a folder"));
        read.unwrap_or_else(|e| panic!("{}: {e}", source.path.display()));
        source.table.keys().for_each(|key| *tables.entry(key.clone()).or_insert(0) += 1);
    }
    let schema = enmm_io::schema();
    let unused: Vec<&String> =
        schema["properties"].as_object().expect("keys").keys().filter(|key| !tables.contains_key(*key)).collect();
    assert!(unused.is_empty(), "{unused:?}");
}

/// Limits in the sentence of a key, against the limits that the program checks.
#[test]
fn limits_in_the_sentences_of_keys_are_those_of_the_checks() {
    let (page, _) = reference();
    let mut compared = 0;
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split(" | ").collect();
        let (said, checked) = (ends(cells[1]), ends(cells[4]));
        for (said, checked) in said.into_iter().zip(checked) {
            let Some(said) = said else { continue };
            assert_eq!(checked, Some(said), "the sentence of a key and its check differ: {row}");
            compared += 1;
        }
    }
    assert!(compared > 20, "only {compared} limits were found");
}
