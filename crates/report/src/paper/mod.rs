//! The report of results on paper: one HTML file that prints on A4 from any browser, and a PDF by a browser.
//!
//! A report is made from what commands left in a folder (`summary.json`, `fos.json`, `bound.json`, `ensemble.json`,
//! `sweep.json` and pictures) and computes nothing: every number of its tables stands in one of these records.

mod earthquake;
mod front;
mod html;
mod input;
mod number;
mod parts;
mod pdf;
mod records;
mod results;
mod sweep;
mod table;

use std::io;
use std::path::{Path, PathBuf};

use enmm_io::files::write_atomic;

pub use html::report_html;
pub use pdf::{Converter, PdfError};
pub use records::{Record, Records, RecordsError};

/// Name of the report in a folder of results.
pub const REPORT: &str = "report_a4.html";
/// Name of its PDF.
pub const REPORT_PDF: &str = "report_a4.pdf";

/// Writes the report of a folder's records into it, whole or not at all; returns its path.
///
/// # Errors
/// Whatever the file system refuses, with the path in the message.
pub fn write_report(directory: &Path, records: &Records) -> io::Result<PathBuf> {
    let path = directory.join(REPORT);
    write_atomic(&path, report_html(records).as_bytes())?;
    Ok(path)
}
