//! Readers of geometry: outline, loops and joint traces from JSON, GeoJSON, DXF, WKT and CSV files. They check
//! structure and types; numbers, counts of points and references are checked in the merged case like those of the
//! case file.

mod csv;
mod dxf;
mod geojson;
mod json;
mod json_text;
mod wkt;

use std::path::Path;

use super::case_error::CaseError;
use super::lines::LineMap;
use enmm::model::Case;
use enmm::model::case::PointList;

/// Points with their key in the file.
pub type Located = (PointList, String);

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

/// Reads the text of a geometry file. The joint laws of `case` are those that DXF layers may name.
///
/// # Errors
/// The first thing in the file that cannot be used, with its line.
pub fn parse(format: Format, file: &str, text: &str, case: &Case) -> Result<Geometry, CaseError> {
    match format {
        Format::Dxf => return dxf::parse(file, text, case),
        Format::Wkt => return wkt::parse(file, text),
        Format::Csv => return csv::parse(file, text),
        Format::Json | Format::GeoJson => {}
    }
    let document = json_text::Document::parse(file, text)?;
    if format == Format::GeoJson || geojson::is_geojson(&document.value) {
        geojson::parse(document)
    } else {
        json::parse(document)
    }
}
