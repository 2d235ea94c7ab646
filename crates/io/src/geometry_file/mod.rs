//! Readers of geometry: outline, loops and joint traces from JSON, GeoJSON, DXF, WKT and CSV files. They check
//! structure and types; numbers, counts of points and references are checked in the merged case like those of the
//! case file.

mod affine;
mod csv;
pub mod dxf;
mod geojson;
mod json;
mod json_text;
mod wkt;

use std::collections::BTreeMap;
use std::path::Path;

use super::case_error::CaseError;
use super::lines::LineMap;
use affine::Affine;
use enmm::model::Case;
use enmm::model::case::{Invalid, PointList};

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
    /// `.geojson`.
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
            Some("geojson") => Ok(Self::GeoJson),
            Some("dxf") => Ok(Self::Dxf),
            Some("wkt") => Ok(Self::Wkt),
            Some("csv") => Ok(Self::Csv),
            _ => Err("the extension is none of .json, .geojson, .dxf, .wkt, .csv; convert the file".to_string()),
        }
    }
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
    let mut geometry = match format {
        Format::Wkt => wkt::parse(file, text)?,
        Format::Csv => csv::parse(file, text)?,
        _ => {
            let document = json_text::Document::parse(file, text)?;
            if format == Format::GeoJson || geojson::is_geojson(&document.value) {
                geojson::parse(document)?
            } else {
                json::parse(document)?
            }
        }
    };
    if case.transform.is_some() {
        geometry.map(&Affine::of_case(case.transform.as_ref(), 1.0));
    }
    Ok(geometry)
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

impl Geometry {
    /// Maps all points.
    fn map(&mut self, map: &Affine) {
        let loops = self.outline.iter_mut().chain(&mut self.holes).chain(&mut self.islands);
        let lists = loops.map(|(points, _)| points).chain(self.traces.iter_mut().map(|trace| &mut trace.points.0));
        lists.flatten().for_each(|point| *point = map.point(*point));
    }
}
