//! Results of a folder for other programs: all tables as a spreadsheet (XLSX), and the slope at one instant as a
//! drawing (DXF) or as features (GeoJSON).
//!
//! The crate reads the files that commands leave in their folders of results, and knows no model.
#![forbid(unsafe_code)]

mod bytes;
mod dxf;
mod error;
mod faces;
mod film;
mod geojson;
mod records;
mod scene;
mod table;
mod tables;
mod units;
mod vtu;
mod workbook;

pub use dxf::drawing;
pub use error::ExportError;
pub use geojson::features;
pub use scene::{Instant, Scene};
pub use table::{Cell, Table};
pub use tables::tables;
pub use workbook::workbook;
