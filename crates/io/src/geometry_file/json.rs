//! The plain JSON format: `{"outline": [[x, y], …], "holes": […], "islands": […], "joints": [[[x, y], …], …]}` in
//! metres. Other keys are remarks of whoever made the file.

use serde_json::Value;

use super::json_text::Document;
use super::{Geometry, Located, Trace};
use crate::case_error::CaseError;
use enmm::model::case::key::{Key, edit_distance, list};

/// Keys that are read.
const KEYS: [&str; 4] = ["outline", "holes", "islands", "joints"];

/// Reads the format.
///
/// # Errors
/// The first thing that cannot be used.
pub fn parse(document: Document) -> Result<Geometry, CaseError> {
    let root = Key::root();
    let Some(object) = document.value.as_object() else {
        return document.fail(&root, "the file is no object; write `{\"outline\": [[x, y], …]}`".to_owned());
    };
    if !object.keys().any(|key| KEYS.contains(&key.as_str())) {
        return document.fail(&root, format!("the file has none of the keys {}; add one", list(KEYS)));
    }
    let loops = |name: &str| -> Result<Vec<Located>, CaseError> {
        let key = root.field(name);
        let Some(value) = object.get(name) else { return Ok(Vec::new()) };
        document.elements(&key, value)?.iter().map(|(key, value)| points(&document, key, value)).collect()
    };
    let outline = object.get("outline").map(|value| points(&document, &root.field("outline"), value)).transpose()?;
    let (holes, islands) = (loops("holes")?, loops("islands")?);
    let traces = loops("joints")?.into_iter().map(|points| Trace { points, law: None }).collect();
    let warnings = object.keys().filter_map(|key| misspelled(key)).collect();
    Ok(Geometry { outline, holes, islands, traces, warnings, lines: document.lines, ..Geometry::default() })
}

fn points(document: &Document, key: &Key, value: &Value) -> Result<Located, CaseError> {
    let (points, high) = document.points(key, value)?;
    if high > 0 {
        return document.fail(key, format!("{high} points have more than 2 coordinates; write `[x, y]`"));
    }
    Ok((points, key.to_string()))
}

/// Returns a warning if a key that is not read looks like one that is.
fn misspelled(key: &str) -> Option<String> {
    let near = KEYS.into_iter().find(|known| *known != key && edit_distance(key, known) <= 2)?;
    Some(format!("key {key:?} is not read; rename it if you mean `{near}`"))
}
