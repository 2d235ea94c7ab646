//! Well-known text: one geometry after the other, each from a line of its own. Lines are joint traces; the outer ring
//! of the first polygon is the outline, that of others an island, and inner rings are holes, as in GeoJSON. Points are
//! counted in warnings. Lines that begin with `#` are comments. `SRID=…;` gives the unit of the coordinates.

use wkt::Wkt;
use wkt::types::{Coord, Polygon};

use super::names::Part;
use super::unit::Declared;
use super::upright::Plane;
use super::{Geometry, Located};
use crate::case_error::{CaseError, shown};
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
    for (k, line) in text.lines().enumerate().map(|(k, line)| (k + 1, line.trim())) {
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
        let added = reader.add(&written, key.clone(), Part::Joint(None));
        added.map_err(|message| CaseError::at(file, first, key.as_str(), message))?;
        (written, count) = (String::new(), count + 1);
    }
    if !written.is_empty() {
        return Err(CaseError::at(file, first, "", "a `(` is not closed before the end of the file; add `)`"));
    }
    if count == 0 {
        return Err(CaseError::at(file, 1, "", format!("the file has no geometry; {FORM}")));
    }
    reader.finish(file)
}

/// Reader with the geometry found so far.
#[derive(Default)]
pub struct Reader {
    /// Geometry found so far, but for the shapes.
    pub geometry: Geometry,
    /// Shapes with their keys and the parts that their lines are.
    shapes: Vec<(Wkt<f64>, Key, Part)>,
    plane: Plane,
    points: usize,
    high: usize,
    /// Polygons with a law, which they do not use.
    lawful: usize,
}

impl Reader {
    /// Adds the geometry of a text, whose lines are such a part.
    ///
    /// # Errors
    /// A message: the text is no geometry.
    pub fn add(&mut self, text: &str, key: Key, part: Part) -> Result<(), String> {
        let text = text.trim().trim_end_matches(';');
        let (srid, text) = match text.split_once(';') {
            Some((srid, rest)) if srid.trim_start().to_ascii_uppercase().starts_with("SRID=") => (Some(srid), rest),
            _ => (None, text),
        };
        // 0 stands for no system.
        let code = srid.map(|srid| srid.trim()["SRID=".len()..].trim()).filter(|code| *code != "0");
        if let Some(code) = code.filter(|_| self.geometry.declared.is_none()) {
            let line = self.geometry.lines.line(key.as_str());
            self.geometry.declared = Some(Declared { text: format!("EPSG:{code}"), key: key.to_string(), line });
        }
        let geometry = text.trim().parse().map_err(|reason: &str| {
            let word = text.trim_start().split(|c: char| !c.is_ascii_alphabetic()).next().unwrap_or_default();
            let begin: String = text.chars().take(40).collect();
            let text = shown(&begin, GEOMETRIES.contains(&word.to_ascii_uppercase().as_str()));
            format!("{text} is no geometry ({reason}); {FORM}")
        })?;
        self.shapes.push((geometry, key, part));
        Ok(())
    }

    fn walk(&mut self, geometry: &Wkt<f64>, key: &Key, part: &Part) -> Result<(), String> {
        match geometry {
            Wkt::LineString(line) => self.line(line.coords(), key, part),
            Wkt::MultiLineString(lines) => {
                lines.line_strings().iter().try_for_each(|line| self.line(line.coords(), key, part))
            }
            Wkt::Polygon(polygon) => self.polygon(polygon, key, part),
            Wkt::MultiPolygon(all) => all.polygons().iter().try_for_each(|polygon| self.polygon(polygon, key, part)),
            Wkt::GeometryCollection(all) => all.geometries().iter().try_for_each(|inner| self.walk(inner, key, part)),
            Wkt::Point(_) | Wkt::MultiPoint(_) => {
                self.points += 1;
                Ok(())
            }
        }
    }

    fn line(&mut self, coords: &[Coord<f64>], key: &Key, part: &Part) -> Result<(), String> {
        let (points, key) = self.located(coords, key);
        self.geometry.put_line(part, points, key)
    }

    fn polygon(&mut self, polygon: &Polygon<f64>, key: &Key, part: &Part) -> Result<(), String> {
        let rings = polygon.rings().iter().map(|ring| self.located(ring.coords(), key)).collect();
        let kind = match part {
            Part::Ring(ring) => Some(*ring),
            Part::Joint(law) => {
                self.lawful += usize::from(law.is_some());
                None
            }
            Part::Lawless(_) => None,
        };
        self.geometry.put_polygon(kind, rings)
    }

    fn located(&mut self, coords: &[Coord<f64>], key: &Key) -> Located {
        self.high += coords.iter().filter(|coord| coord.z.is_some()).count();
        let point = |coord: &Coord<f64>| self.plane.point([coord.x, coord.y, coord.z.unwrap_or_default()]);
        (coords.iter().map(point).collect(), key.to_string())
    }

    /// The geometry, with warnings of parts that were not used.
    ///
    /// # Errors
    /// The shape that is a second outline.
    pub fn finish(mut self, file: &str) -> Result<Geometry, CaseError> {
        let shapes = std::mem::take(&mut self.shapes);
        let mut coords = Vec::new();
        shapes.iter().for_each(|(shape, ..)| collect(shape, &mut coords));
        self.plane = Plane::of(coords);
        for (shape, key, part) in &shapes {
            let walked = self.walk(shape, key, part);
            let line = self.geometry.lines.line(key.as_str());
            walked.map_err(|message| CaseError::at(file, line, key.as_str(), message))?;
        }
        let Self { mut geometry, points, high, plane, lawful, .. } = self;
        if points > 0 {
            geometry.warnings.push(format!("{points} points not used: no line or polygon"));
        }
        if lawful > 0 {
            geometry.warnings.push(format!("laws of {lawful} polygons not used: a polygon is a loop"));
        }
        if high > 0 && plane == Plane::Flat {
            geometry.warnings.push(format!("the third coordinate of {high} points is not used"));
        }
        geometry.notes.extend(plane.note());
        Ok(geometry)
    }
}

/// The points of all lines and polygons, each with its height where it has one.
fn collect(shape: &Wkt<f64>, points: &mut Vec<[Option<f64>; 3]>) {
    let mut line = |coords: &[Coord<f64>]| points.extend(coords.iter().map(|c| [Some(c.x), Some(c.y), c.z]));
    match shape {
        Wkt::LineString(one) => line(one.coords()),
        Wkt::MultiLineString(all) => all.line_strings().iter().for_each(|one| line(one.coords())),
        Wkt::Polygon(one) => one.rings().iter().for_each(|ring| line(ring.coords())),
        Wkt::MultiPolygon(all) => {
            all.polygons().iter().flat_map(Polygon::rings).for_each(|ring| line(ring.coords()));
        }
        Wkt::GeometryCollection(all) => all.geometries().iter().for_each(|inner| collect(inner, points)),
        Wkt::Point(_) | Wkt::MultiPoint(_) => {}
    }
}
