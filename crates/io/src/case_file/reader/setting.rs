//! Values that the command line sets: `joint_law.plane.friction_deg=30` on top of what the case file gives.

use std::collections::BTreeMap;

use serde_json::Value;
use toml::de::{DeTable, DeValue};

use super::Reader;
use super::expected::{Expected, Schema, example};
use crate::case_error::CaseError;
use crate::lines::{LineMap, LineStarts};
use enmm::model::case::key::{Key, list, nearest};

/// How a setting is written.
const FORM: &str = "write KEY=VALUE, as in joint_law.plane.friction_deg=30 or joint_set[0].seed=7";

/// One part of a key.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    Name(String),
    Index(usize),
}

/// Puts settings into the values of a case, in their order; returns each with its key.
///
/// # Errors
/// The first one that is no key and value, whose key the case does not have, or whose value is of another type.
pub fn put_all(
    case: &mut Value,
    schema: Schema,
    settings: &[impl AsRef<str>],
) -> Result<BTreeMap<String, String>, CaseError> {
    let mut keys = BTreeMap::new();
    for setting in settings.iter().map(AsRef::as_ref) {
        let failed = |message: String| CaseError::Setting { setting: setting.to_owned(), message };
        let (steps, text) = parse(setting).map_err(failed)?;
        let key = steps.iter().fold(Key::root(), |key, step| match step {
            Step::Name(name) => key.field(name),
            Step::Index(index) => key.index(*index),
        });
        if let Some(first) = keys.insert(key.to_string(), setting.to_owned()) {
            return Err(failed(format!("{key}: is set to {first:?} already; keep one of them")));
        }
        put(case, schema, &steps, &Key::root(), text).map_err(failed)?;
    }
    Ok(keys)
}

/// Parts of the key, and the text of the value.
fn parse(setting: &str) -> Result<(Vec<Step>, &str), String> {
    let mut steps = Vec::new();
    let mut rest = setting.trim_start();
    loop {
        rest = rest.trim_start();
        if let Some(value) = rest.strip_prefix('=').filter(|_| !steps.is_empty()) {
            return Ok((steps, value.trim()));
        }
        let (step, after) = step(rest, steps.is_empty()).ok_or_else(|| format!("is no key and value; {FORM}"))?;
        steps.push(step);
        rest = after;
    }
}

/// The first part of a key, and what follows it.
fn step(text: &str, is_first: bool) -> Option<(Step, &str)> {
    if let Some(rest) = text.strip_prefix('[') {
        let (index, rest) = rest.split_once(']')?;
        return Some((Step::Index(index.trim().parse().ok()?), rest));
    }
    let text = if is_first { text } else { text.strip_prefix('.')? };
    if let Some(rest) = text.strip_prefix('"') {
        let (name, rest) = rest.split_once('"')?;
        return Some((Step::Name(name.to_owned()), rest));
    }
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    let end = text.find(|c| !bare(c)).unwrap_or(text.len());
    (end > 0).then(|| (Step::Name(text[..end].to_owned()), &text[end..]))
}

/// Puts the value of `text` at `steps` below `key`.
fn put(target: &mut Value, schema: Schema, steps: &[Step], key: &Key, text: &str) -> Result<(), String> {
    let Some((first, rest)) = steps.split_first() else {
        *target = value_of(text, schema, key)?;
        return Ok(());
    };
    match (first, schema.expected()) {
        (Step::Name(name), Expected::Table(fields)) => {
            let child = key.field(name);
            if let Value::Null = target {
                *target = Value::Object(Default::default());
            }
            let Value::Object(table) = target else { return Err(format!("{key}: is no table")) };
            let names = || table.keys().map(String::as_str);
            if fields.are_free() && !table.contains_key(name) {
                let near = nearest(name, names()).map_or_else(String::new, |near| format!(", did you mean {near:?}"));
                return Err(format!("{child}: the case has no {name:?} there{near}; it has: {}", list(names())));
            }
            let Some(inner) = fields.get(name) else {
                let near = nearest(name, fields.names()).unwrap_or_default();
                let known = list(fields.names());
                return Err(format!("{child}: unknown key {name:?}, did you mean `{near}`? Known keys: {known}"));
            };
            if !rest.is_empty() && table.get(name).is_none_or(Value::is_null) {
                opened(inner, &child)?;
            }
            put(table.entry(name).or_insert(Value::Null), inner, rest, &child, text)
        }
        (Step::Index(index), Expected::Array { items, .. }) => {
            let count = target.as_array().map_or(0, Vec::len);
            match target.get_mut(*index) {
                Some(inner) => put(inner, items, rest, &key.index(*index), text),
                None => Err(format!("{}: the case has {count} of `{key}`, counted from 0", key.index(*index))),
            }
        }
        (Step::Name(name), Expected::Array { .. }) => {
            Err(format!("{key}: is a list; write `{key}[0].{name}` for its first, counted from 0"))
        }
        (Step::Name(_) | Step::Index(_), expected) => Err(format!("{key}: is {expected}, which has no parts")),
    }
}

/// Refuses to begin a table that would lack keys.
fn opened(schema: Schema, key: &Key) -> Result<(), String> {
    let lacks = match schema.expected() {
        Expected::Table(fields) => fields.required().next().is_some(),
        Expected::Array { .. } => true,
        _ => false,
    };
    if lacks {
        Err(format!("{key}: the case has none; add {} to the case file", example(key, &schema)))
    } else {
        Ok(())
    }
}

/// The value of a text: as TOML has it, else the text as a string, which thus needs no quotes.
fn value_of(text: &str, schema: Schema, key: &Key) -> Result<Value, String> {
    let document = format!("value = {text}");
    let parsed = DeTable::parse(&document);
    let single = parsed.as_ref().ok().filter(|table| table.get_ref().len() == 1);
    let value = single.and_then(|table| table.get_ref().get("value")).map(toml::Spanned::get_ref);
    let wants_text = matches!(schema.expected(), Expected::Text | Expected::Choice(_));
    let plain = DeValue::String(text.into());
    let value = match value {
        Some(value) if !wants_text || matches!(value, DeValue::String(_)) => value,
        _ => &plain,
    };
    let mut reader = Reader { file: "", starts: LineStarts::new(&document), lines: LineMap::default() };
    reader.value(value, &schema, key).map_err(|error| match error {
        CaseError::Value { key, message, .. } => format!("{key}: {message}"),
        other => other.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_those_of_messages() {
        let name = |name: &str| Step::Name(name.to_owned());
        for (text, steps, value) in [
            ("mesh.size=0.5", vec![name("mesh"), name("size")], "0.5"),
            ("joint_set[2].seed = 7", vec![name("joint_set"), Step::Index(2), name("seed")], "7"),
            ("rock.\"old = grey\".young=5e9", vec![name("rock"), name("old = grey"), name("young")], "5e9"),
            (
                "fix[0].edge[1][0]=3",
                vec![name("fix"), Step::Index(0), name("edge"), Step::Index(1), Step::Index(0)],
                "3",
            ),
        ] {
            assert_eq!(parse(text).unwrap(), (steps, value));
        }
        for text in ["", "mesh", "=3", "mesh..size=3", "a[x]=1", "mesh size=1"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
