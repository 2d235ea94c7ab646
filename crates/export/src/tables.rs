//! Tables of a folder of results: its CSV files, and the lists and single values of its records (JSON).

use std::fs;
use std::path::{Path, PathBuf};

use enmm_io::files::read_result;
use serde_json::Value;

use crate::error::ExportError;
use crate::records;
use crate::table::{Cell, Table};

/// Folders of the results of commands within that of a run.
const FOLDERS: [&str; 6] = ["", "run", "fos", "bound", "sample", "sweep"];
/// Largest table or record that is read (bytes).
const FILE_MAX: u64 = 256 << 20;

/// All tables of a folder of results, and of the folders `run`, `fos`, `bound`, `sample` and `sweep` in it.
///
/// # Errors
/// The folder is not there or has no table; or a file that cannot be read, with its path.
pub fn tables(directory: &Path) -> Result<Vec<Table>, ExportError> {
    if !directory.is_dir() {
        return Err(ExportError::NoFolder(directory.to_owned()));
    }
    let mut tables = Vec::new();
    for below in FOLDERS {
        let folder = directory.join(below);
        if below.is_empty() || folder.is_dir() && !folder.is_symlink() {
            folder_tables(&folder, below, &mut tables)?;
        }
    }
    if tables.is_empty() {
        let message = format!(
            "holds neither CSV nor JSON files of results; run the case first, as by `enmm run CASE -o {}`",
            directory.display()
        );
        return Err(ExportError::Nothing { path: directory.to_owned(), message });
    }
    Ok(tables)
}

/// Tables of one folder, in the order of the names of their files.
fn folder_tables(folder: &Path, below: &str, tables: &mut Vec<Table>) -> Result<(), ExportError> {
    let unreadable = |error: std::io::Error| ExportError::unreadable(folder, error);
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        names.extend(entry.file_name().into_string().ok().filter(|_| entry.path().is_file()));
    }
    names.sort();
    for name in names {
        let path = folder.join(&name);
        let shown = if below.is_empty() || name.starts_with(below) { name.clone() } else { format!("{below}/{name}") };
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("csv") => tables.push(csv_table(path, shown.trim_end_matches(".csv").to_owned())?),
            Some("json") => tables.extend(records::tables(&path, &shown, &json(&path)?)),
            _ => {}
        }
    }
    Ok(())
}

fn json(path: &Path) -> Result<Value, ExportError> {
    let unreadable = |message: String| ExportError::unreadable(path, message);
    let bytes = read_result(path, FILE_MAX).map_err(|error| unreadable(error.to_string()))?;
    serde_json::from_slice(&bytes).map_err(|error| unreadable(error.to_string()))
}

fn csv_table(source: PathBuf, name: String) -> Result<Table, ExportError> {
    let bytes = read_result(&source, FILE_MAX).map_err(|error| ExportError::unreadable(&source, error))?;
    let mut reader = csv::Reader::from_reader(&bytes[..]);
    let unreadable = |error: csv::Error| ExportError::unreadable(&source, error);
    let columns = reader.headers().map_err(unreadable)?.iter().map(str::to_owned).collect();
    let row = |record: csv::StringRecord| record.iter().map(cell).collect();
    let rows = reader.records().map(|record| record.map(row)).collect::<Result<_, _>>().map_err(unreadable)?;
    Ok(Table { name, source, columns, rows })
}

/// A cell of a CSV file: a number where the text is a finite one.
fn cell(text: &str) -> Cell {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    match number {
        _ if text.is_empty() => Cell::Empty,
        Some(number) => Cell::Number(number),
        None => Cell::Text(text.to_owned()),
    }
}
