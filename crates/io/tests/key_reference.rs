//! `docs/book/reference.md` is what the schema and the example cases say of every key of a case; with
//! `ENMM_WRITE_REFERENCE` in the environment (`cargo xtask reference`) this test writes it.

use std::fmt::Write;
use std::path::PathBuf;

use enmm_case::keys::Plain;
use enmm_io::parse_case;
use serde_json::Value as Json;
use toml::{Table, Value};

const REFERENCE: &str = "docs/book/reference.md";
/// Folders of the cases that examples are taken from, in this order.
const CASES: [&str; 2] = ["examples/cases", "docs/keys"];
const HEAD: &str = "\
# Key reference

Every key of a case, table by table. `cargo xtask reference` writes this page: sentences, units, defaults and ranges are
those of [case.schema.json](../case.schema.json), and each example is the first line with its key in
[examples/cases](../../examples/cases) or [docs/keys](../keys), which the tests read.

A table in single brackets is there once, one in double brackets as often as you like; `NAME` stands for a name of your
choice. *Required* keys have no default. Other keys may narrow a range: the tensile strength of a rock ends at the apex
of its shear strength, for example. Times of rows are at least 0 and at most 1e9 s. Angles are in degrees, everything
else in SI units; tension is positive.
";

/// One table of the case file.
pub struct Section {
    /// Such as `joint_set[]` or `rock.NAME`.
    path: String,
    description: String,
    /// Keys with their schema, and whether they are required.
    pub keys: Vec<(String, Json, bool)>,
}

impl Section {
    /// The names of the table and of those around it.
    pub fn path(&self) -> Vec<&str> {
        self.path.split('.').filter(|part| !part.is_empty()).collect()
    }
}

/// The schema with what its references name.
struct Schema(Json);

/// All tables of the case file, the outer ones first.
pub fn sections() -> Vec<Section> {
    let schema = Schema(enmm_io::schema());
    let mut sections = Vec::new();
    schema.sections("", &schema.0, &mut sections);
    sections
}

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
pub struct Source {
    /// Its file.
    pub path: PathBuf,
    /// What is written in it.
    pub text: String,
    /// Its keys.
    pub table: Table,
}

impl Source {
    /// All cases of the folders.
    pub fn all() -> Vec<Self> {
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
pub fn find<'a>(table: &'a mut Table, path: &[&str], key: &str) -> Option<&'a mut Value> {
    let Some((first, rest)) = path.split_first() else { return table.get_mut(key) };
    if *first == "NAME" {
        return table.iter_mut().find_map(|(_, inner)| find(inner.as_table_mut()?, rest, key));
    }
    match table.get_mut(first.trim_end_matches("[]"))? {
        Value::Array(list) => list.iter_mut().find_map(|inner| find(inner.as_table_mut()?, rest, key)),
        inner => find(inner.as_table_mut()?, rest, key),
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

/// The number of a key, or of the lists of a key.
pub fn number_of(property: &Json) -> &Json {
    let inner = ["items", "additionalProperties"].into_iter().map(|name| &property[name]);
    inner.filter(|inner| inner.is_object()).map(number_of).next().unwrap_or(property)
}

/// The values that a key takes, as its schema says them.
fn range(schema: &Schema, property: &Json) -> String {
    let kind = schema.resolve(property);
    if let Some(kinds) = kind["anyOf"].as_array() {
        return kinds.iter().map(|kind| range(schema, kind)).collect::<Vec<_>>().join(", ");
    }
    if kind["type"] == "array" && schema.resolve(&kind["items"])["oneOf"].is_array() {
        return format!("a list of {}", range(schema, &kind["items"]));
    }
    if let Some(words) = kind["oneOf"].as_array() {
        let words: Vec<String> =
            words.iter().filter_map(|word| Some(format!("`{}`", word["const"].as_str()?))).collect();
        return words.join(", ");
    }
    let number = number_of(kind);
    let end = |names: [(&str, &str); 2]| {
        names.into_iter().find_map(|(name, words)| Some(format!("{words} {}", Plain(number[name].as_f64()?))))
    };
    let low = end([("minimum", "at least"), ("exclusiveMinimum", "greater than")]);
    let high = end([("maximum", "at most"), ("exclusiveMaximum", "less than")]);
    match (low.zip(high), kind["type"].to_string().contains("boolean")) {
        (Some((low, high)), _) => format!("{low} and {high}").replace(&u64::MAX.to_string(), "2⁶⁴ − 1"),
        (None, true) => "`true`, `false`".to_owned(),
        (None, false) => "text".to_owned(),
    }
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

/// The page, and the keys that no case uses.
fn reference() -> (String, Vec<String>) {
    let schema = Schema(enmm_io::schema());
    let sources = Source::all();
    let (mut page, mut missing) = (HEAD.to_owned(), Vec::new());
    for section in &sections() {
        write!(page, "\n## {}\n\n{}\n\n", heading(&section.path), wrapped(&section.description)).expect("text");
        page += "| key | meaning | unit | default | range | example |\n|---|---|---|---|---|---|\n";
        for (key, property, required) in &section.keys {
            let Some(example) = sources.iter().find_map(|source| source.example(&section.path(), key)) else {
                missing.push(format!("{}.{key}", section.path));
                continue;
            };
            let meaning = sentence(property);
            let cells = [
                format!("`{key}`"),
                meaning.clone(),
                property["unit"].as_str().unwrap_or("–").to_owned(),
                default(property, &meaning, *required),
                range(&schema, property),
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

#[test]
fn cases_of_the_key_reference_are_valid() {
    for source in Source::all() {
        let read = parse_case(&source.text, "case.toml", source.path.parent().expect("a folder"));
        read.unwrap_or_else(|e| panic!("{}: {e}", source.path.display()));
    }
}
