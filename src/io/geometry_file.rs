//! Readers of geometry: outline, loops and joint traces from JSON, GeoJSON and DXF files. They judge structure and
//! types; numbers, counts of points and references are checked in the merged case like those of the case file.

mod dxf;
mod geojson;
mod json;
mod json_text;

use std::path::Path;

use super::case_error::CaseError;
use super::lines::LineMap;
use crate::model::Case;
use crate::model::case::PointList;

/// Points with their key in the file.
pub type Located = (PointList, String);

/// What a geometry file holds.
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
    /// What was not used, with counts.
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

/// Reads a geometry file by its extension: `.json` (a JSON object with `outline` and `joints`, or GeoJSON if it has a
/// GeoJSON `type`), `.geojson`, `.dxf`. The joint laws of `case` are those that DXF layers may name.
///
/// # Errors
/// The format is unknown, or the first thing in the file that cannot be used, with its line.
pub fn parse(path: &Path, text: &str, case: &Case) -> Result<Geometry, CaseError> {
    let file = path.display().to_string();
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("dxf") => dxf::parse(&file, text, case),
        Some("geojson") => geojson::parse(json_text::Document::parse(&file, text)?),
        Some("json") => {
            let document = json_text::Document::parse(&file, text)?;
            if geojson::is_geojson(&document.value) { geojson::parse(document) } else { json::parse(document) }
        }
        _ => {
            let message = "the extension is none of .json, .geojson, .dxf; rename or convert the file".to_string();
            Err(CaseError::Unreadable { file, message })
        }
    }
}
