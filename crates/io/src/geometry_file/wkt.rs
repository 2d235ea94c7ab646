//! Well-known text: one geometry after the other, each from a line of its own. Lines are joint traces; the outer ring
//! of the first polygon is the outline, that of others an island, and inner rings are holes, as in GeoJSON. Points are
//! counted in warnings. Lines that begin with `#` are comments.

use wkt::Wkt;
use wkt::types::{Coord, Polygon};

use super::{Geometry, Trace};
use crate::case_error::{CaseError, shown};
use enmm::model::case::PointList;
use enmm::model::case::key::Key;

/// How a geometry is written.
const FORM: &str = "write `LINESTRING (0 0, 4 3)`";
/// First words of geometries and of what users take for one: a message shows the text behind no other.
const GEOMETRIES: [&str; 9] = [
    "GEOMETRYCOLLECTION",
    "LINE",
    "LINEARRING",
    "LINESTRING",
    "MULTILINESTRING",
    "MULTIPOINT",
    "MULTIPOLYGON",
    "POINT",
    "POLYGON",
];

/// Reads the format.
///
/// # Errors
/// The first geometry that cannot be used.
pub fn parse(file: &str, text: &str) -> Result<Geometry, CaseError> {
    let mut reader = Reader::default();
    let (mut written, mut first) = (String::new(), 0);
    let mut count = 0;
    for (k, line) in text.trim_start_matches('\u{feff}').lines().enumerate().map(|(k, line)| (k + 1, line.trim())) {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if written.is_empty() {
            first = k;
        }
        written.push_str(line);
        written.push(' ');
        let depth = |c: char| written.matches(c).count();
        if depth('(') > depth(')') {
            continue;
        }
        let key = Key::root().field("geometry").index(count);
        reader.geometry.lines.insert(&key, first);
        reader.add(&written, &key, &None).map_err(|message| CaseError::at(file, first, key.as_str(), message))?;
        (written, count) = (String::new(), count + 1);
    }
    if !written.is_empty() {
        return Err(CaseError::at(file, first, "", "a `(` is not closed before the end of the file; add `)`"));
    }
    if count == 0 {
        return Err(CaseError::at(file, 1, "", format!("the file has no geometry; {FORM}")));
    }
    Ok(reader.finish())
}

/// Reader with the geometry found so far.
#[derive(Default)]
pub struct Reader {
    /// Geometry found so far.
    pub geometry: Geometry,
    points: usize,
    high: usize,
}

impl Reader {
    /// Adds the geometry of a text; a trace gets `law` with its key.
    ///
    /// # Errors
    /// A message: the text is no geometry.
    pub fn add(&mut self, text: &str, key: &Key, law: &Option<(String, String)>) -> Result<(), String> {
        let text = text.trim().trim_end_matches(';');
        let text = match text.split_once(';') {
            Some((srid, rest)) if srid.trim_start().to_ascii_uppercase().starts_with("SRID=") => rest,
            _ => text,
        };
        let geometry = text.trim().parse().map_err(|reason: &str| {
            let word = text.trim_start().split(|c: char| !c.is_ascii_alphabetic()).next().unwrap_or_default();
            let begin: String = text.chars().take(40).collect();
            let text = shown(&begin, GEOMETRIES.contains(&word.to_ascii_uppercase().as_str()));
            format!("{text} is no geometry ({reason}); {FORM}")
        })?;
        self.walk(&geometry, key, law);
        Ok(())
    }

    fn walk(&mut self, geometry: &Wkt<f64>, key: &Key, law: &Option<(String, String)>) {
        match geometry {
            Wkt::LineString(line) => self.trace(line.coords(), key, law),
            Wkt::MultiLineString(lines) => {
                lines.line_strings().iter().for_each(|line| self.trace(line.coords(), key, law))
            }
            Wkt::Polygon(polygon) => self.polygon(polygon, key),
            Wkt::MultiPolygon(polygons) => polygons.polygons().iter().for_each(|polygon| self.polygon(polygon, key)),
            Wkt::GeometryCollection(all) => all.geometries().iter().for_each(|inner| self.walk(inner, key, law)),
            Wkt::Point(_) | Wkt::MultiPoint(_) => self.points += 1,
        }
    }

    fn trace(&mut self, coords: &[Coord<f64>], key: &Key, law: &Option<(String, String)>) {
        let points = (self.list(coords), key.to_string());
        self.geometry.traces.push(Trace { points, law: law.clone() });
    }

    fn polygon(&mut self, polygon: &Polygon<f64>, key: &Key) {
        for (i, ring) in polygon.rings().iter().enumerate() {
            let mut points = self.list(ring.coords());
            if points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            let located = (points, key.to_string());
            if i > 0 {
                self.geometry.holes.push(located);
            } else if self.geometry.outline.is_none() {
                self.geometry.outline = Some(located);
            } else {
                self.geometry.islands.push(located);
            }
        }
    }

    fn list(&mut self, coords: &[Coord<f64>]) -> PointList {
        self.high += coords.iter().filter(|coord| coord.z.is_some()).count();
        coords.iter().map(|coord| [coord.x, coord.y]).collect()
    }

    /// The geometry, with warnings of parts that were not used.
    pub fn finish(self) -> Geometry {
        let Self { mut geometry, points, high } = self;
        if points > 0 {
            geometry.warnings.push(format!("{points} points not used: no line or polygon"));
        }
        if high > 0 {
            geometry.warnings.push(format!("the third coordinate of {high} points is not used"));
        }
        geometry
    }
}
