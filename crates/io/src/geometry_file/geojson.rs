//! GeoJSON: lines are joint traces, whose property `law` may name a joint law; the first polygon is the outline, its
//! inner rings are holes, further polygons are islands. Coordinates are metres.

use std::collections::BTreeMap;

use serde_json::Value;

use super::json_text::{Document, shown};
use super::{Geometry, Located, Trace};
use crate::case_error::CaseError;
use enmm::model::case::key::Key;

/// The types of objects that hold geometry.
const CONTAINERS: [&str; 3] = ["FeatureCollection", "Feature", "GeometryCollection"];
/// The types of geometry.
const SHAPES: [&str; 6] = ["LineString", "MultiLineString", "Polygon", "MultiPolygon", "Point", "MultiPoint"];

/// Returns whether a JSON value has a type of GeoJSON.
pub fn is_geojson(value: &Value) -> bool {
    CONTAINERS.contains(&type_of(value)) || SHAPES.contains(&type_of(value))
}

fn type_of(value: &Value) -> &str {
    value.get("type").and_then(Value::as_str).unwrap_or_default()
}

/// Reads the format.
///
/// # Errors
/// The first thing that cannot be used.
pub fn parse(document: Document) -> Result<Geometry, CaseError> {
    let mut reader = Reader { document: &document, geometry: Geometry::default(), high: 0, unused: BTreeMap::new() };
    reader.object(&Key::root(), &document.value, &None)?;
    let Reader { mut geometry, high, unused, .. } = reader;
    geometry.warnings.extend(unused.iter().map(|(name, count)| format!("{count} {name} not used: no line or polygon")));
    if high > 0 {
        geometry.warnings.push(format!("the third coordinate of {high} points is not used"));
    }
    geometry.lines = document.lines;
    Ok(geometry)
}

/// A joint law with its key.
type Law = Option<(String, String)>;

/// Reader with the geometry found so far.
struct Reader<'a> {
    document: &'a Document<'a>,
    geometry: Geometry,
    high: usize,
    unused: BTreeMap<String, usize>,
}

impl Reader<'_> {
    fn object(&mut self, key: &Key, value: &Value, law: &Law) -> Result<(), CaseError> {
        match type_of(value) {
            "FeatureCollection" => self.list(key, value, "features", law),
            "GeometryCollection" => self.list(key, value, "geometries", law),
            "Feature" => {
                let law = self.law(key, value)?;
                match value.get("geometry") {
                    None | Some(Value::Null) => self.skip("Feature without geometry"),
                    Some(geometry) => self.object(&key.field("geometry"), geometry, &law),
                }
            }
            kind @ ("Point" | "MultiPoint") => self.skip(kind),
            kind if SHAPES.contains(&kind) => self.shape(key, value, kind, law),
            _ => {
                // An object at the root that has another type may be any file, such as a key to an account.
                let is_ours = *key != Key::root();
                let unknown = |kind: &Value| if is_ours { shown(kind) } else { "none of ours".to_string() };
                let found = value.get("type").map_or("missing".to_string(), unknown);
                let known = CONTAINERS.iter().chain(&SHAPES).copied().collect::<Vec<_>>().join(", ");
                self.document.fail(&key.field("type"), format!("is {found}, must be one of {known}; correct it"))
            }
        }
    }

    fn skip(&mut self, what: &str) -> Result<(), CaseError> {
        *self.unused.entry(what.to_string()).or_default() += 1;
        Ok(())
    }

    fn list(&mut self, key: &Key, value: &Value, name: &str, law: &Law) -> Result<(), CaseError> {
        let key = key.field(name);
        let objects = self.document.elements(&key, value.get(name).unwrap_or(&Value::Null))?;
        objects.iter().try_for_each(|(key, value)| self.object(key, value, law))
    }

    fn law(&self, key: &Key, feature: &Value) -> Result<Law, CaseError> {
        let key = key.field("properties").field("law");
        match feature.get("properties").and_then(|properties| properties.get("law")) {
            None | Some(Value::Null) => Ok(None),
            Some(Value::String(law)) => Ok(Some((law.clone(), key.to_string()))),
            Some(other) => self
                .document
                .fail(&key, format!("is {}, must be a string; write the name of a joint law", shown(other))),
        }
    }

    fn shape(&mut self, key: &Key, value: &Value, kind: &str, law: &Law) -> Result<(), CaseError> {
        let key = key.field("coordinates");
        let coordinates = value.get("coordinates").unwrap_or(&Value::Null);
        let parts = match kind {
            "MultiLineString" | "MultiPolygon" => self.document.elements(&key, coordinates)?,
            _ => vec![(key, coordinates)],
        };
        for (key, part) in &parts {
            if kind.ends_with("LineString") {
                let points = self.points(key, part)?;
                self.geometry.traces.push(Trace { points, law: law.clone() });
            } else {
                self.polygon(key, part)?;
            }
        }
        Ok(())
    }

    fn polygon(&mut self, key: &Key, value: &Value) -> Result<(), CaseError> {
        let rings = self.document.elements(key, value)?;
        if rings.is_empty() {
            return self.document.fail(key, "has no rings, a polygon needs at least 1; add one or remove the polygon");
        }
        for (i, (key, ring)) in rings.iter().enumerate() {
            let (mut points, key) = self.points(key, ring)?;
            if points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            if i > 0 {
                self.geometry.holes.push((points, key));
            } else if self.geometry.outline.is_none() {
                self.geometry.outline = Some((points, key));
            } else {
                self.geometry.islands.push((points, key));
            }
        }
        Ok(())
    }

    fn points(&mut self, key: &Key, value: &Value) -> Result<Located, CaseError> {
        let (points, high) = self.document.points(key, value)?;
        self.high += high;
        Ok((points, key.to_string()))
    }
}
