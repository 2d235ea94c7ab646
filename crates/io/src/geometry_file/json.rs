//! The plain JSON format: `{"outline": [[x, y], …], "holes": […], "islands": […], "joints": [[[x, y], …], …]}`, in
//! metres or the unit that a key `units` names. Keys may be in any letter case, and `traces` is another name of
//! `joints`. Other keys are remarks of whoever made the file, unless they hold points.

use serde_json::Value;

use super::json_text::Document;
use super::names::tidy;
use super::unit::{Declared, is_unit};
use super::upright::Plane;
use super::{Geometry, Located, Trace};
use crate::case_error::CaseError;
use enmm::model::case::key::{Key, edit_distance, list};

/// Keys that are read.
const KEYS: [&str; 4] = ["outline", "holes", "islands", "joints"];
/// Another name of the last one.
const TRACES: &str = "traces";
/// Keys with the unit of the file.
const UNITS: [&str; 2] = ["unit", "units"];

/// Reads the format.
///
/// # Errors
/// The first thing that cannot be used.
pub fn parse(document: Document) -> Result<Geometry, CaseError> {
    let Some(object) = document.value.as_object() else {
        let message = "the file is no object; write `{\"outline\": [[x, y], …]}`";
        return document.fail(&Key::root(), message);
    };
    if !object.keys().any(|key| known(key).is_some()) {
        return document.fail(&Key::root(), format!("the file has none of the keys {}; add one", list(KEYS)));
    }
    let mut geometry = Geometry::default();
    let mut remarks = Vec::new();
    let mut read: Vec<&str> = Vec::new();
    for (name, value) in object {
        let key = Key::root().field(name);
        let Some(known) = known(name) else {
            match remark(name, value) {
                Remark::Refused(message) => return document.fail(&key, message),
                Remark::Misspelled(warning) => geometry.warnings.push(warning),
                Remark::Unit(text) => {
                    let line = document.lines.line(key.as_str());
                    geometry.declared = Some(Declared { text, key: key.to_string(), line });
                }
                Remark::Other => remarks.push(name.as_str()),
            }
            continue;
        };
        if read.contains(&known) {
            return document.fail(&key, format!("is a second key for `{known}`; join both"));
        }
        read.push(known);
        let lines = || -> Result<Vec<Located>, CaseError> {
            document.elements(&key, value)?.iter().map(|(key, value)| points(&document, key, value)).collect()
        };
        match known {
            "outline" => geometry.outline = Some(points(&document, &key, value)?),
            "holes" => geometry.holes = lines()?,
            "islands" => geometry.islands = lines()?,
            _ => geometry.traces = lines()?.into_iter().map(|points| Trace { points, law: None }).collect(),
        }
    }
    if !remarks.is_empty() {
        geometry.notes.push(format!("keys not used: {}", remarks.join(", ")));
    }
    geometry.lines = document.lines;
    Ok(geometry)
}

/// The key that a name stands for.
fn known(name: &str) -> Option<&'static str> {
    let name = tidy(name);
    let name = if name == TRACES { KEYS[3] } else { &name };
    KEYS.into_iter().find(|known| *known == name)
}

fn points(document: &Document, key: &Key, value: &Value) -> Result<Located, CaseError> {
    let (points, high) = document.points(key, value, Plane::Flat)?;
    if high > 0 {
        return document.fail(key, format!("{high} points have more than 2 coordinates; write `[x, y]`"));
    }
    Ok((points, key.to_string()))
}

/// A key that is none of ours.
enum Remark {
    /// It holds points.
    Refused(String),
    /// It looks like one of ours.
    Misspelled(String),
    /// It names the unit.
    Unit(String),
    Other,
}

fn remark(name: &str, value: &Value) -> Remark {
    let is_point = |value: &Value| value.as_array().is_some_and(|pair| pair.len() > 1 && pair[0].is_number());
    let first = |value: &Value| value.as_array().and_then(|list| list.first()).cloned().unwrap_or(Value::Null);
    let inner = first(value);
    if is_point(&inner) || is_point(&first(&inner)) {
        return Remark::Refused(format!("holds points, but the keys are {}; rename or remove it", list(KEYS)));
    }
    let tidy = tidy(name);
    if UNITS.contains(&tidy.as_str())
        && let Some(unit) = value.as_str().filter(|unit| is_unit(unit))
    {
        return Remark::Unit(unit.to_owned());
    }
    let near = KEYS.into_iter().find(|known| edit_distance(&tidy, known) <= 2);
    near.map_or(Remark::Other, |near| {
        Remark::Misspelled(format!("key {name:?} is not read; rename it if you mean `{near}`"))
    })
}
