//! Readers of geometry: outline, loops and joint traces from JSON, GeoJSON, DXF, WKT and CSV files. They check
//! structure and types; numbers, counts of points and references are checked in the merged case like those of the
//! case file.

mod affine;
mod csv;
pub mod dxf;
mod epsg;
mod geojson;
mod json;
mod json_text;
mod names;
pub mod survey;
mod unit;
mod upright;
mod wkt;

use std::collections::BTreeMap;
use std::path::Path;

use super::case_error::{CaseError, read_drawing, read_text};
use super::lines::LineMap;
use affine::Affine;
use enmm::model::Case;
use enmm::model::case::{Invalid, PointList};
use names::{Laws, Part, Ring};
use unit::{Declared, Unit};

/// Points with their key in the file.
pub type Located = (PointList, String);

/// Head and far end of a bolt with its key in the file.
pub type LocatedBar = ([[f64; 2]; 2], String);

/// Content of a geometry file.
#[derive(Debug, Default)]
pub struct Geometry {
    /// Outer loop of the rock.
    pub outline: Option<Located>,
    /// Loops cut out of the outline.
    pub holes: Vec<Located>,
    /// Loops of rock inside holes or beside the outline.
    pub islands: Vec<Located>,
    /// Joint traces.
    pub traces: Vec<Trace>,
    /// Water table.
    pub water: Option<Located>,
    /// Bolts by the name of their `[[bolt]]`.
    pub bolts: BTreeMap<String, Vec<LocatedBar>>,
    /// Unit of the file and what is made of it.
    pub unit: String,
    /// Unit by the head of the file, if it is no drawing.
    declared: Option<Declared>,
    /// Traces without a law of their own, by layer.
    lawless: BTreeMap<String, usize>,
    /// Notes of what was converted or not used, with counts.
    pub notes: Vec<String>,
    /// Warnings of parts that were not used, with counts.
    pub warnings: Vec<String>,
    /// Lines of the keys of the file.
    pub lines: LineMap,
}

/// A joint trace of a geometry file.
#[derive(Debug)]
pub struct Trace {
    /// Points with their key in the file.
    pub points: Located,
    /// Joint law with its key in the file, if the trace names one.
    pub law: Option<(String, String)>,
}

/// Why a geometry file cannot be used.
#[derive(Debug)]
pub enum Fault {
    /// Something in the file.
    File(CaseError),
    /// A key of the case that does not fit the file.
    Case(Invalid),
}

impl From<CaseError> for Fault {
    fn from(error: CaseError) -> Self {
        Self::File(error)
    }
}

impl From<Invalid> for Fault {
    fn from(invalid: Invalid) -> Self {
        Self::Case(invalid)
    }
}

/// Formats of geometry files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// `.json`: an object with `outline` and `joints`, or GeoJSON if it has a GeoJSON `type`.
    Json,
    /// `.geojson`; `.geojsonl`, `.geojsons` and `.ndjson`, one feature a line.
    GeoJson,
    /// `.dxf`.
    Dxf,
    /// `.wkt`: well-known text.
    Wkt,
    /// `.csv`: traces by rows.
    Csv,
}

impl Format {
    /// Returns the format that an extension stands for, in any letter case.
    ///
    /// # Errors
    /// A message without the file's name: the extension is unknown.
    pub fn of(path: &Path) -> Result<Self, String> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("json") => Ok(Self::Json),
            Some("geojson" | "geojsonl" | "geojsons" | "ndjson") => Ok(Self::GeoJson),
            Some("dxf") => Ok(Self::Dxf),
            Some("wkt") => Ok(Self::Wkt),
            Some("csv") => Ok(Self::Csv),
            _ => Err("the extension is none of .json, .geojson, .dxf, .wkt, .csv; convert the file".to_string()),
        }
    }
}

/// The text of a geometry file.
///
/// # Errors
/// A message without the file's name: the file cannot be opened, is too large, or is no text that is read.
pub fn text(format: Format, path: &Path) -> Result<String, String> {
    if format == Format::Dxf { read_drawing(path) } else { read_text(path) }
}

/// Reads the text of a geometry file into metres of the section, by `layers`, `transform` and laws of `case`.
///
/// # Errors
/// The first thing in the file that cannot be used, with its line, or in the case that does not fit it.
pub fn parse(format: Format, file: &str, text: &str, case: &Case) -> Result<Geometry, Fault> {
    if format == Format::Dxf {
        return dxf::parse(file, text, case);
    }
    only_for_drawings(case)?;
    let mut geometry = read(format, file, text, &Laws::Of(case))?;
    let unit = Unit::of(geometry.declared.as_ref(), case.transform.as_ref().and_then(|map| map.scale), file)?;
    geometry.notes.extend(unit.note);
    geometry.unit = unit.text;
    if case.transform.is_some() || unit.metres != 1.0 {
        geometry.map(&Affine::of_case(case.transform.as_ref(), unit.metres));
    }
    Ok(geometry)
}

/// Reads a file that is no drawing, in its own unit.
fn read(format: Format, file: &str, text: &str, laws: &Laws) -> Result<Geometry, CaseError> {
    let mut geometry = match format {
        Format::Wkt => wkt::parse(file, text)?,
        Format::Csv => csv::parse(file, text, laws)?,
        _ => {
            let document = json_text::Document::parse(file, text)?;
            if format == Format::GeoJson || geojson::is_geojson(&document.value) {
                geojson::parse(document, laws)?
            } else {
                json::parse(document)?
            }
        }
    };
    geometry.warnings.extend(std::mem::take(&mut geometry.lawless).iter().map(|(layer, count)| lawless(layer, *count)));
    Ok(geometry)
}

/// A warning of traces on a layer without a law.
fn lawless(layer: &str, count: usize) -> String {
    format!("{count} traces on layer {layer:?}, which is no joint law, take the default law")
}

/// Refuses keys that only a DXF drawing uses.
fn only_for_drawings(case: &Case) -> Result<(), Invalid> {
    let keys = [
        ("layers", !case.layers.is_empty(), "name laws in the file"),
        ("domain.curve_tolerance", case.domain.curve_tolerance.is_some(), "the file has no curves"),
    ];
    match keys.into_iter().find(|(_, given, _)| *given) {
        Some((key, _, reason)) => {
            let message = format!("acts on a .dxf file alone; remove it ({reason})");
            Err(Invalid { key: key.to_string(), message })
        }
        None => Ok(()),
    }
}

/// Where to put a second outline of a file that is no drawing.
const REMEDY: &str = "write `island`";

impl Geometry {
    /// Adds a line: a joint trace, or a loop.
    ///
    /// # Errors
    /// A message: it is a second outline.
    fn put_line(&mut self, part: &Part, mut points: PointList, key: String) -> Result<(), String> {
        let law = match part {
            Part::Ring(ring) => {
                if points.len() > 1 && points.first() == points.last() {
                    points.pop();
                }
                return self.put_ring(*ring, (points, key), REMEDY);
            }
            Part::Joint(law) => law.clone(),
            Part::Lawless(layer) => {
                *self.lawless.entry(layer.clone()).or_default() += 1;
                None
            }
        };
        self.traces.push(Trace { points: (points, key), law });
        Ok(())
    }

    /// Adds a loop; `remedy` says where to put a second outline.
    ///
    /// # Errors
    /// A message: it is a second outline.
    fn put_ring(&mut self, ring: Ring, located: Located, remedy: &str) -> Result<(), String> {
        match ring {
            Ring::Outline if self.outline.is_some() => {
                return Err(format!("is a second outline, there can be 1; {remedy}"));
            }
            Ring::Outline => self.outline = Some(located),
            Ring::Hole => self.holes.push(located),
            Ring::Island => self.islands.push(located),
        }
        Ok(())
    }

    /// Adds the rings of a polygon, each closed by its first point: a loop of this kind or, without one, the outline
    /// if there is none yet, else an island; all but the first are holes.
    ///
    /// # Errors
    /// A message: it is a second outline.
    fn put_polygon(&mut self, kind: Option<Ring>, rings: Vec<Located>) -> Result<(), String> {
        for (k, (mut points, key)) in rings.into_iter().enumerate() {
            if points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
            let next = if self.outline.is_none() { Ring::Outline } else { Ring::Island };
            let ring = if k > 0 { Ring::Hole } else { kind.unwrap_or(next) };
            self.put_ring(ring, (points, key), REMEDY)?;
        }
        Ok(())
    }

    /// Maps all points.
    fn map(&mut self, map: &Affine) {
        let loops = self.outline.iter_mut().chain(&mut self.holes).chain(&mut self.islands);
        let lists = loops.map(|(points, _)| points).chain(self.traces.iter_mut().map(|trace| &mut trace.points.0));
        lists.flatten().for_each(|point| *point = map.point(*point));
    }
}
