//! GeoJSON: lines are joint traces, whose property `law` (or `joint_law`, or `layer`, in any letter case) may name a
//! joint law, or `outline`, `hole` and `island`; the first polygon is the outline, its inner rings are holes, further
//! polygons are islands. Coordinates are metres, or what the member `crs` of older files says.

use std::collections::BTreeMap;

use serde_json::Value;

use super::json_text::{Document, shown};
use super::names::{Laws, Part, Purpose, Ring};
use super::unit::Declared;
use super::upright::Plane;
use super::{Geometry, Located};
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
pub fn parse(document: Document, laws: &Laws) -> Result<Geometry, CaseError> {
    let mut heights = Vec::new();
    collect(&document.value, &mut heights);
    let mut reader = Reader {
        document: &document,
        laws,
        plane: Plane::of(heights),
        geometry: Geometry::default(),
        high: 0,
        unused: BTreeMap::new(),
        properties: BTreeMap::new(),
    };
    reader.object(&Key::root(), &document.value, &Said::default())?;
    let Reader { mut geometry, high, unused, plane, properties, .. } = reader;
    geometry.warnings.extend(unused.iter().map(|(name, count)| format!("{count} {name} not used: no line or polygon")));
    if !properties.is_empty() {
        let listed: Vec<String> = properties.iter().map(|(name, count)| format!("{name} ({count})")).collect();
        geometry.warnings.push(format!("properties not used: {}", listed.join(", ")));
    }
    if high > 0 && plane == Plane::Flat {
        geometry.warnings.push(format!("the third coordinate of {high} points is not used"));
    }
    geometry.notes.extend(plane.note());
    geometry.declared = declared(&document);
    geometry.lines = document.lines;
    Ok(geometry)
}

/// The points of all lines and polygons, each with its height where it has one.
fn collect(value: &Value, points: &mut Vec<[Option<f64>; 3]>) {
    match value {
        Value::Array(list) if list.first().is_some_and(|first| !first.is_array() && !first.is_object()) => {
            points.push([0, 1, 2].map(|k| list.get(k).and_then(Value::as_f64)));
        }
        Value::Array(list) => list.iter().for_each(|value| collect(value, points)),
        Value::Object(_) if ["Point", "MultiPoint"].contains(&type_of(value)) => {}
        Value::Object(object) => {
            ["features", "geometries", "geometry", "coordinates"]
                .into_iter()
                .filter_map(|name| object.get(name))
                .for_each(|value| collect(value, points));
        }
        _ => {}
    }
}

/// The coordinate reference system that a file names, as before RFC 7946.
fn declared(document: &Document) -> Option<Declared> {
    let key = Key::root().field("crs");
    let properties = document.value.get("crs")?.get("properties")?;
    let text = match (properties.get("name"), properties.get("code")) {
        (Some(Value::String(name)), _) => name.clone(),
        (_, Some(code)) => format!("EPSG:{code}"),
        _ => return None,
    };
    Some(Declared { text, line: document.lines.line(key.as_str()), key: key.to_string() })
}

/// Members of a feature that are read, or that the format has beside them.
const MEMBERS: [&str; 6] = ["type", "geometry", "properties", "id", "bbox", "crs"];

/// Law and layer of a feature, each with its key.
#[derive(Debug, Default)]
struct Said {
    law: Option<(String, String)>,
    layer: Option<(String, String)>,
}

/// Reader with the geometry found so far.
struct Reader<'a> {
    document: &'a Document<'a>,
    laws: &'a Laws<'a>,
    plane: Plane,
    geometry: Geometry,
    high: usize,
    unused: BTreeMap<String, usize>,
    /// Properties that are not read, by name.
    properties: BTreeMap<String, usize>,
}

impl Reader<'_> {
    fn object(&mut self, key: &Key, value: &Value, said: &Said) -> Result<(), CaseError> {
        match type_of(value) {
            "FeatureCollection" => self.list(key, value, "features", said),
            "GeometryCollection" => self.list(key, value, "geometries", said),
            "Feature" => match value.get("geometry") {
                None | Some(Value::Null) => self.skip("Feature without geometry"),
                Some(geometry) => {
                    let said = self.said(key, value)?;
                    self.object(&key.field("geometry"), geometry, &said)
                }
            },
            kind @ ("Point" | "MultiPoint") => self.skip(kind),
            kind if SHAPES.contains(&kind) => self.shape(key, value, kind, said),
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

    fn list(&mut self, key: &Key, value: &Value, name: &str, said: &Said) -> Result<(), CaseError> {
        let key = key.field(name);
        let objects = self.document.elements(&key, value.get(name).unwrap_or(&Value::Null))?;
        objects.iter().try_for_each(|(key, value)| self.object(key, value, said))
    }

    /// Law and role of a feature by its properties; those that are not read are counted.
    fn said(&mut self, key: &Key, feature: &Value) -> Result<Said, CaseError> {
        let mut said = Said::default();
        let members = feature.as_object().into_iter().flatten();
        for (name, _) in members.filter(|(name, value)| !MEMBERS.contains(&name.as_str()) && !value.is_null()) {
            *self.properties.entry(format!("{name:?} beside \"properties\"")).or_default() += 1;
        }
        let key = key.field("properties");
        let properties = feature.get("properties").and_then(Value::as_object).into_iter().flatten();
        for (name, value) in properties.filter(|(_, value)| !value.is_null()) {
            let key = key.field(name);
            match (Purpose::named(name), value) {
                (Some(Purpose::Law), _) if said.law.is_some() => {
                    return self.document.fail(&key, "is a second name of the joint law; remove one of both");
                }
                (Some(_), Value::String(name)) if name.trim().is_empty() => {}
                (Some(Purpose::Law), Value::String(law)) => said.law = Some((law.clone(), key.to_string())),
                (Some(Purpose::Law), other) => {
                    let message = format!("is {}, must be a string; write the name of a joint law", shown(other));
                    return self.document.fail(&key, message);
                }
                (Some(Purpose::Layer), Value::String(layer)) if said.layer.is_none() => {
                    said.layer = Some((layer.clone(), key.to_string()));
                }
                _ => *self.properties.entry(name.clone()).or_default() += 1,
            }
        }
        Ok(said)
    }

    fn shape(&mut self, key: &Key, value: &Value, kind: &str, said: &Said) -> Result<(), CaseError> {
        let key = key.field("coordinates");
        let coordinates = value.get("coordinates").unwrap_or(&Value::Null);
        let parts = match kind {
            "MultiLineString" | "MultiPolygon" => self.document.elements(&key, coordinates)?,
            _ => vec![(key, coordinates)],
        };
        for (key, part) in &parts {
            if kind.ends_with("LineString") {
                let (points, at) = self.points(key, part)?;
                let part = Part::of(said.law.clone(), said.layer.clone(), self.laws);
                let put = self.geometry.put_line(&part, points, at);
                put.or_else(|message| self.document.fail(key, message))?;
            } else {
                self.polygon(key, part, said)?;
            }
        }
        Ok(())
    }

    fn polygon(&mut self, key: &Key, value: &Value, said: &Said) -> Result<(), CaseError> {
        let rings = self.document.elements(key, value)?;
        if rings.is_empty() {
            return self.document.fail(key, "has no rings, a polygon needs at least 1; add one or remove the polygon");
        }
        let rings = rings.iter().map(|(key, ring)| self.points(key, ring)).collect::<Result<Vec<Located>, _>>()?;
        let name = said.law.as_ref().or(said.layer.as_ref()).map(|(name, _)| name.as_str());
        let kind = name.and_then(Ring::named);
        if said.law.is_some() && kind.is_none() {
            *self.properties.entry("law of a polygon".to_owned()).or_default() += 1;
        }
        self.geometry.put_polygon(kind, rings).or_else(|message| self.document.fail(key, message))
    }

    fn points(&mut self, key: &Key, value: &Value) -> Result<Located, CaseError> {
        let (points, high) = self.document.points(key, value, self.plane)?;
        self.high += high;
        Ok((points, key.to_string()))
    }
}
